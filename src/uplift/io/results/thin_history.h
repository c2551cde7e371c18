#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace uplift {

/// At most about `most` of the points of a history y over x: the least and the largest of each bucket, so that no peak is lost.
void thin_history(std::vector<double>& x, std::vector<double>& y, std::size_t most);
/// Likewise, appended to other vectors. What is not finite is left out.
void thin_history(std::span<const double> x, std::span<const double> y, std::size_t most, std::vector<double>& thin_x,
                  std::vector<double>& thin_y);

}  // namespace uplift
