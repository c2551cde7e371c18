#pragma once

namespace uplift {

/// Instants of a ledger whose values differ by less than this share tie: round-off does not say which one is larger.
inline constexpr double tie_of_peaks = 1e-9;

/// Keeps the largest value (not negative) and the time at which it was met; of instants that tie the first one.
inline void note_largest(double value, double time, double& largest, double& time_of) {
  if (value > (1 + tie_of_peaks) * largest) largest = value, time_of = time;
}

}  // namespace uplift
