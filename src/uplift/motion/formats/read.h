#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/motion/motion.h"

namespace uplift {

/// What a user may have to say of a record because the file does not.
struct RecordOptions {
  std::string format = {};          // name of the reader; empty: chosen by content
  std::string unit = {};            // of the numbers ("g", "cm/s2", "m/s"); empty: as the file states, and an error when it does not
  std::optional<double> step = {};  // s; for files without times
  std::string column = {};          // of tables: name or number from 1; empty: all with a unit in the head, or the first after the time
};

/// Reads one file of recorded motion: all its components. The format is found by content. Throws InputError with file and line; of an
/// option, with its name ("unit") instead. What was repaired, or looks odd, stands in Motion::repairs.
std::vector<Motion> read_motions(const std::string& path, const RecordOptions& options = {});
/// The same from text; `file` names it in errors.
std::vector<Motion> read_motions_from(std::string_view text, const std::string& file, const RecordOptions& options = {});

}  // namespace uplift
