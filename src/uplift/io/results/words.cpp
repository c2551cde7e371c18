#include "uplift/io/results/words.h"

namespace uplift {

std::vector<std::string_view> run_status_words() {
  using enum RunStatus;
  return {to_string(completed), to_string(overturned), to_string(separated), to_string(failed), to_string(interrupted)};
}

void write_peak(ResultWriter& out, const Peak& peak, std::string_view unit) {
  out.number("value", peak.value, unit.empty() ? "as stated in unit" : unit, "value of largest magnitude, with its sign");
  out.number("time", peak.time, "s", "time at which it is reached");
  if (unit.empty())
    out.text("unit", peak.unit, "unit of the value");
  else
    out.unit(peak.unit.empty() ? unit : std::string_view(peak.unit));
}

void write_peak(ResultWriter& out, std::string_view key, const Peak& peak, std::string_view unit, std::string_view meaning) {
  out.object(key, meaning, [&] { write_peak(out, peak, unit); });
}

void write_intervals(ResultWriter& out, std::string_view key, const std::vector<Interval>& intervals, std::string_view meaning) {
  out.list(key, meaning, intervals, [&](const Interval& interval) {
    out.number("from", interval.from, "s", "beginning");
    out.number("to", interval.to, "s", "end");
    out.unit("s");
  });
}

}  // namespace uplift
