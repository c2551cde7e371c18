#pragma once

#include <cstddef>

namespace uplift {

/// Numbers of nodes, cells and blocks are `int` (-1: none); standard containers want their own type.
inline std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace uplift
