#include "uplift/motion/processing/processing.h"

#include <array>
#include <vector>

namespace uplift {

#define PROCESS(name) const Entry<Processing>& entry_process_##name();
#include "uplift/parts.def"

std::span<const Entry<Processing>* const> process_catalog() {
  static const std::array entries{
#define PROCESS(name) &entry_process_##name(),
#include "uplift/parts.def"
  };
  return entries;
}

std::span<const PartInfo* const> motion_processes() {
  static const std::vector<const PartInfo*> infos(process_catalog().begin(), process_catalog().end());
  return infos;
}

}  // namespace uplift
