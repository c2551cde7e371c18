#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>

#include "uplift/base/declare.h"

namespace uplift {

/// A part that can be chosen by name and made from its checked parameters, and from what it belongs to (the material of a solid, the nodes
/// of an element). One line in `parts.def` puts it into its catalog.
template <class Part, class... Context>
struct Entry : PartInfo {
  std::function<std::unique_ptr<const Part>(const Context&..., const Values&)> make;
};

/// Makes the part that the checked values name. Values come from check_part with the same catalog, so the name exists.
template <class Part, class... Context>
std::unique_ptr<const Part> make_part(std::span<const Entry<Part, Context...>* const> catalog, const Values& values,
                                      const std::type_identity_t<Context>&... context) {
  for (const Entry<Part, Context...>* entry : catalog)
    if (entry->name == values.type()) return entry->make(context..., values);
  return nullptr;
}

}  // namespace uplift
