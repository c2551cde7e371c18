#pragma once
#include <string_view>
#include <vector>

#include "uplift/base/catalog.h"
#include "uplift/elements/element.h"

namespace uplift {

/// The nodes that the table of an element names under `nodes`.
struct ElementSite {
  Space space;
  std::vector<int> nodes;
  std::vector<Vec3> positions;  // m
};

/// An element that stands on named nodes: a table [[name]] of the case file with the keys `params`, one of which is `nodes`.
struct ElementEntry : Entry<Element, ElementSite> {
  std::string_view symbol = "spring";  // between its nodes in the drawing of the model: "spring" or "dashpot"
};
std::span<const ElementEntry* const> element_catalog();
std::span<const PartInfo* const> element_kinds();

/// Two numbers in plane models, three in space; InputError otherwise.
Place vector_of(const Values& table, std::string_view key, Space space);

}  // namespace uplift
