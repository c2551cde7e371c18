#include <array>
#include <vector>

#include "uplift/model/function.h"

namespace uplift {

#define FUNCTION(name) const Entry<TimeFunction>& entry_function_##name();
#include "uplift/parts.def"

std::span<const Entry<TimeFunction>* const> function_catalog() {
  static const std::array entries{
#define FUNCTION(name) &entry_function_##name(),
#include "uplift/parts.def"
  };
  return entries;
}

std::span<const PartInfo* const> time_functions() {
  static const std::vector<const PartInfo*> infos(function_catalog().begin(), function_catalog().end());
  return infos;
}

}  // namespace uplift
