#include "uplift/io/results/thin_history.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace uplift {

void thin_history(std::span<const double> x, std::span<const double> y, std::size_t most, std::vector<double>& thin_x,
                  std::vector<double>& thin_y) {
  const auto finite = [&](std::size_t i) { return std::isfinite(x[i]) && std::isfinite(y[i]); };
  std::size_t count = y.size();
  while (count > 0 && !finite(count - 1)) --count;
  const std::size_t buckets = count <= most || most < 4 ? count : most / 2;
  thin_x.reserve(2 * buckets);
  thin_y.reserve(2 * buckets);
  const auto keep = [&](std::size_t i) {
    thin_x.push_back(x[i]);
    thin_y.push_back(y[i]);
  };
  for (std::size_t b = 0; b < buckets; ++b) {
    std::size_t first = b * count / buckets;
    const std::size_t last = (b + 1) * count / buckets;
    while (first < last && !finite(first)) ++first;
    if (first == last) continue;
    std::size_t least = first, largest = first;
    for (std::size_t i = first; i < last; ++i) {
      if (y[i] < y[least] && finite(i)) least = i;
      if (y[i] > y[largest] && finite(i)) largest = i;
    }
    keep(std::min(least, largest));
    if (least != largest) keep(std::max(least, largest));
  }
}

void thin_history(std::vector<double>& x, std::vector<double>& y, std::size_t most) {
  std::vector<double> thin_x, thin_y;
  thin_history(x, y, most, thin_x, thin_y);
  x = std::move(thin_x);
  y = std::move(thin_y);
}

}  // namespace uplift
