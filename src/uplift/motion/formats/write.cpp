#include "uplift/motion/formats/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>

#include "uplift/base/text.h"

namespace uplift {
namespace {

/// On one line, and without what separates cells or encloses units.
std::string cell_of(std::string_view text) {
  std::string cell;
  for (const char c : text)
    cell += static_cast<unsigned char>(c) < 0x20 || std::string_view(",;\"'[]()").find(c) != std::string_view::npos ? ' ' : c;
  return std::string(trim(cell));
}

std::string comment_of(std::string_view text) {
  std::string line;
  // "=" and ":" would be read as "step = ..."
  for (const char c : text) line += static_cast<unsigned char>(c) < 0x20 || c == '=' || c == ':' ? ' ' : c;
  return line;
}

}  // namespace

std::string motion_csv(std::span<const Motion> motions) {
  assert(!motions.empty());
  const double step = motions.front().step;
  std::size_t rows = 0;
  std::string head = "time [s]", out = fmt::format("# ground motion; step = {} s\n", shortest(step));
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const Motion& motion = motions[i];
    assert(motion.step == step);
    rows = std::max(rows, motion.values.size());
    const std::string name = cell_of(motion.name);
    head += fmt::format(",{} [{}]", name.empty() ? fmt::format("motion {}", i + 1) : name, unit_of(motion.kind));
    for (const std::string& text : {motion.format, motion.file, motion.sha256, motion.event, motion.station, motion.component})
      if (!text.empty()) out += fmt::format("# {}, {}\n", i + 1, comment_of(text));
    for (const std::vector<std::string>* steps : {&motion.repairs, &motion.processing})
      for (const std::string& text : *steps) out += fmt::format("# {}, {}\n", i + 1, comment_of(text));
  }
  out += head + "\n";
  for (std::size_t row = 0; row < rows; ++row) {
    fmt::format_to(std::back_inserter(out), "{}", step * static_cast<double>(row));
    for (const Motion& motion : motions)
      if (row < motion.values.size())
        fmt::format_to(std::back_inserter(out), ",{}", motion.values[row]);
      else
        out += ',';
    out += '\n';
  }
  return out;
}

}  // namespace uplift
