#include <array>

#include "uplift/contact/method.h"

namespace uplift {

#define METHOD(name) const Entry<ContactMethod>& entry_method_##name();
#include "uplift/parts.def"

std::span<const Entry<ContactMethod>* const> method_catalog() {
  static const std::array entries{
#define METHOD(name) &entry_method_##name(),
#include "uplift/parts.def"
  };
  return entries;
}

std::span<const PartInfo* const> contact_methods() {
  static const std::vector<const PartInfo*> infos(method_catalog().begin(), method_catalog().end());
  return infos;
}

std::string_view standard_method(bool constraints) {
  return constraints ? "lagrange" : "newton";
}

std::string_view other_exact_method(std::string_view method) {
  const auto catalog = method_catalog();
  for (auto entry = catalog.rbegin(); entry != catalog.rend(); ++entry) {
    const std::string_view name = (*entry)->name;
    const Values standard = check_part(Raw{std::string(name), {}, "method"}, contact_methods());
    if (name != method && (*entry)->make(standard)->constrains()) return name;
  }
  return {};
}

}  // namespace uplift
