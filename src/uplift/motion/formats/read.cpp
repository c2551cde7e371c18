#include "uplift/motion/formats/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/motion/formats/record_format.h"

namespace uplift {

#define RECORD(name) const RecordFormat& entry_record_##name();
#include "uplift/parts.def"

std::span<const RecordFormat* const> record_catalog() {
  static const std::array entries{
#define RECORD(name) &entry_record_##name(),
#include "uplift/parts.def"
  };
  return entries;
}

std::span<const PartInfo* const> record_formats() {
  static const std::vector<const PartInfo*> infos(record_catalog().begin(), record_catalog().end());
  return infos;
}

namespace {

const RecordFormat& format_of(const RecordText& text, const RecordOptions& options) {
  if (options.format.empty()) {
    const auto found = std::ranges::find_if(record_catalog(), [&](const RecordFormat* each) { return each->recognises(text); });
    return found == record_catalog().end() ? *record_catalog().back() : **found;
  }
  std::vector<std::string> names;
  for (const RecordFormat* each : record_catalog()) {
    if (each->name == options.format) return *each;
    names.emplace_back(each->name);
  }
  throw InputError({}, "format", listed(names), in_quotes(options.format), nearest_name(options.format, names));
}

}  // namespace

std::vector<Motion> read_motions_from(std::string_view content, const std::string& file, const RecordOptions& options) {
  const RecordText text(content, file);
  if (std::ranges::all_of(content, [](char c) { return trim({&c, 1}).empty(); }))
    throw InputError({file, 0}, "", "a record of ground motion", "an empty file");
  const RecordFormat& format = format_of(text, options);
  std::vector<Motion> motions = format.read(text, options);
  const std::string hash = sha256(content), stem = std::filesystem::path(file).stem().string();
  for (Motion& motion : motions) {
    motion.file = file;
    motion.sha256 = hash;
    motion.format = format.name;
    if (motion.name.empty()) motion.name = motions.size() > 1 && !motion.component.empty() ? stem + " " + motion.component : stem;
  }
  return motions;
}

std::vector<Motion> read_motions(const std::string& path, const RecordOptions& options) {
  constexpr double most = 100;  // MB: nine hours of three components at 200 Hz
  return read_motions_from(read_file(path, most), path, options);
}

}  // namespace uplift
