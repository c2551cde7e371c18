#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/base/error.h"

namespace uplift {

/// What the values of a motion are: m/s2, m/s or m.
enum class MotionKind { acceleration, velocity, displacement };
std::string_view to_string(MotionKind);
std::string_view unit_of(MotionKind);

/// One component of a ground motion: values at equal steps from t = 0, in SI, and everything that a reviewer asks of where it comes from.
/// Nothing in it ever becomes NaN or infinite.
struct Motion {
  MotionKind kind = MotionKind::acceleration;
  double step = 0;             // s, > 0
  std::vector<double> values;  // SI, two at least

  std::string name;                       // short, for legends and tables
  std::string file, sha256;               // as given; empty for generated motions
  std::string format;                     // name of the reader, or of the generator
  std::string event, station, component;  // as the file states them; empty when it does not
  std::optional<double> azimuth;          // rad, clockwise from north, of a horizontal component
  std::string unit;                       // of the numbers in the file ("g", "cm/s2")
  double factor = 1;                      // from the file's numbers to SI
  std::vector<std::string> repairs;       // what was mended when it was read, one sentence each
  std::vector<std::string> processing;    // every step since, in order, with its numbers
  double duration() const { return values.size() < 2 ? 0 : step * static_cast<double>(values.size() - 1); }
};

/// Largest magnitude and its index (the first one).
struct MotionPeak {
  double value = 0;  // signed
  double time = 0;   // s
};
MotionPeak peak_of(const Motion&);

/// True when every value is finite and at most 1e6 in SI: a thousand times beyond what is recorded.
bool has_possible_values(const Motion&);
/// Throws InputError, with this place, when a generated or processed motion has other values.
void check_values(const Motion&, const Where& where, const std::string& path);

}  // namespace uplift
