#include "uplift/contact/lagrange/failures.h"

#include <fmt/format.h>

namespace uplift {

namespace {

/// "point 3 of 'footing'" for a row.
std::string point_name(const ContactModel& model, std::ptrdiff_t row) {
  for (const Block& block : model.blocks)
    if (row >= block.first && row < block.first + block.rows())
      return fmt::format("point {} of '{}'", (row - block.first) % block.batch.points + 1, block.name);
  return fmt::format("row {}", row);
}

}  // namespace

std::string kernel_failure(const ContactModel& model, const KernelReply& reply, std::ptrdiff_t first) {
  if (reply.end == KernelEnd::inconsistent)
    return fmt::format("contradictory constraints: no motion of the structure opens {}", point_name(model, first + reply.worst));
  if (reply.end == KernelEnd::not_finite) return "the openings are not finite";
  return fmt::format("the active set did not settle in {} iterations, the dual method included", reply.iterations);
}

std::string point_names(const ContactModel& model, const std::vector<std::ptrdiff_t>& rows, std::size_t most) {
  std::string text;
  for (std::size_t k = 0; k < rows.size() && k < most; ++k) text += (k > 0 ? ", " : "") + point_name(model, rows[k]);
  if (rows.size() > most) text += fmt::format(" and {} more", rows.size() - most);
  return text;
}

}  // namespace uplift
