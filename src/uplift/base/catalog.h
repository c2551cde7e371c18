#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "uplift/base/declare.h"

namespace uplift {

/// A part that can be chosen by name and made from its checked parameters. One line in `parts.def` puts it into its catalog.
template <class Part>
struct Entry : PartInfo {
  std::function<std::unique_ptr<const Part>(const Values&)> make;
};

/// Makes the part that the checked values name. Values come from check_part with the same catalog, so the name exists.
template <class Part>
std::unique_ptr<const Part> make_part(std::span<const Entry<Part>* const> catalog, const Values& values) {
  for (const Entry<Part>* entry : catalog)
    if (entry->name == values.type()) return entry->make(values);
  return nullptr;
}

}  // namespace uplift
