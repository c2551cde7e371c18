#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "uplift/base/catalog.h"
#include "uplift/elements/element.h"

namespace uplift {

/// The nodes that one element connects.
struct ElementSite {
  Space space;
  std::vector<int> nodes;
  std::vector<Vec3> positions;  // m
  std::string line = {};        // along the lines of a group: which one, for messages
};

/// A kind of element: a table [[name]] of the case file with the keys `params`. It stands on the nodes that it names under `nodes`, or
/// along lines: between two `nodes` or on the lines of a `group` of the mesh, with the keys `name` and `elements` (of each straight
/// stretch).
struct ElementEntry : Entry<Element, ElementSite> {
  std::string_view symbol = "spring";  // between its nodes in the drawing of the model: "spring" or "dashpot"; along lines it is the line
  bool along_lines = false;            // the element then has two nodes, an axis, section forces
};
std::span<const ElementEntry* const> element_catalog();
std::span<const PartInfo* const> element_kinds();
/// The tables of a case whose elements stand along lines: [[beam]] and what else there is.
std::vector<const Values*> tables_along_lines(const Values& root);

/// Two numbers in plane models, three in space; InputError otherwise.
Place vector_of(const Values& table, std::string_view key, Space space);

}  // namespace uplift
