#include "uplift/elements/element_entry.h"

#include <fmt/format.h>

#include <array>

namespace uplift {

Place vector_of(const Values& table, std::string_view key, Space space) {
  const std::vector<double>& numbers = table.numbers(key);
  if (static_cast<int>(numbers.size()) != space.dimension)
    fail(table, key, space.dimension == 2 ? "two numbers [x, y] in a plane model" : "three numbers [x, y, z] in a model in space",
         fmt::format("{}", numbers.size()));
  return {numbers[0], numbers[1], space.dimension == 3 ? numbers[2] : 0};
}

// The elements of parts.def. One is found because it is listed there, not because its object file registers itself.
#define ELEMENT(name) const ElementEntry& entry_element_##name();
#include "uplift/parts.def"

std::span<const ElementEntry* const> element_catalog() {
  static const std::array elements{
#define ELEMENT(name) &entry_element_##name(),
#include "uplift/parts.def"
  };
  return elements;
}

std::span<const PartInfo* const> element_kinds() {
  static const std::array elements{
#define ELEMENT(name) static_cast<const PartInfo*>(&entry_element_##name()),
#include "uplift/parts.def"
  };
  return elements;
}

std::vector<const ElementEntry*> elements_at(ElementPlace place) {
  std::vector<const ElementEntry*> found;
  for (const ElementEntry* entry : element_catalog())
    if (entry->place == place) found.push_back(entry);
  return found;
}

}  // namespace uplift
