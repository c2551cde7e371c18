#pragma once
#include <memory>
#include <vector>

#include "uplift/model/matrix_home.h"
#include "uplift/model/model.h"

// The order of the free unknowns: that of the full ones, or, where their matrices are distributed, those of one process after another.
namespace uplift {

/// The new number of each free unknown when every process has its part of the model. Together stay the unknowns of a node, of nodes that
/// ties, followers or a rigid body connect, and of an interface; if that has more than half of what one process has, those that its points
/// connect, as far as that goes. Within a part the order stays. `firsts` gets the first number of each process, then that of unknowns.
std::vector<int> numbers_by_parts(const Model& model, const std::vector<std::unique_ptr<const Element>>& elements, const MatrixHome& home,
                                  std::vector<int>& firsts);

/// The new number of each free unknown in the order of the full ones; empty: it has this number.
std::vector<int> numbers_by_nodes(const Model& model);

/// Gives the free unknowns of a model new numbers, but not in its matrices.
void renumber(const std::vector<int>& number, Model& model);
/// A vector on them; one of another size stays as it is.
void renumber(const std::vector<int>& number, Vector& vector);
/// Back to the numbers before.
std::vector<int> inverse(const std::vector<int>& number);

}  // namespace uplift
