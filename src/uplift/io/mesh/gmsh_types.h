#pragma once
#include <span>
#include <string>

#include "uplift/mesh/cells.h"

namespace uplift {

/// A type of element of Gmsh that has a counterpart here.
struct GmshType {
  int number;  // in the file
  Cell cell;
  std::span<const int> from;  // node k here is Gmsh's node from[k]; empty: the same order
};

/// The type with this number; none when there is no counterpart.
const GmshType* gmsh_type(int number);

/// For messages: "a 5-node pyramid (type 7)".
std::string gmsh_type_name(int number);

}  // namespace uplift
