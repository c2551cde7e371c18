#pragma once
#include <memory>
#include <vector>

#include "uplift/math/symmetric_sum.h"
#include "uplift/model/model.h"

namespace uplift {

/// Classes of elements that are equal but for their place: solids on whole cells of one shape and size, to the round-off of coordinates, of
/// one material, whose unknowns are free ones each or held. Classes of fewer than `least_equal` elements are left out.
struct EqualElements {
  std::vector<std::vector<int>> classes;  // numbers of the elements, ascending
  std::vector<EqualCells> cells;          // of each class: where its elements are in the matrices of free unknowns
  std::vector<char> among;                // of each element, whether it is in a class
};
inline constexpr int least_equal = 16;

/// `expansion`: T^T.
EqualElements find_equal_elements(Space space, const std::vector<Node>& nodes, const std::vector<std::unique_ptr<const Element>>& elements,
                                  const Sparse& expansion);

}  // namespace uplift
