#include "uplift/run/result.h"

#include <fmt/format.h>

namespace uplift {

std::string_view to_string(RunStatus status) {
  switch (status) {
    case RunStatus::completed:
      return "completed";
    case RunStatus::overturned:
      return "overturned";
    case RunStatus::separated:
      return "separated";
    case RunStatus::failed:
      return "failed";
    case RunStatus::interrupted:
      return "interrupted";
  }
  return "";
}

std::string RunResult::created_percent() const {
  return energy_scale > 0 ? fmt::format("{:.3g} %", 100 * energy_created / energy_scale) : "0 %";
}

}  // namespace uplift
