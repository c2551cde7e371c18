#include <algorithm>
#include <array>
#include <cmath>

#include "uplift/base/text.h"
#include "uplift/motion/formats/record_format.h"

// The files of K-NET and KiK-net (NIED, Japan): 17 lines with a label in 18 characters, then counts, eight per row.
//   Sampling Freq(Hz) 100Hz / Duration Time(s)  300 / Dir.              N-S / Scale Factor      3920(gal)/6182761 / Max. Acc. (gal) 328.844
// The counts have an arbitrary zero; "Max. Acc." is that of the values without their mean.
namespace uplift {
namespace {

constexpr int knet_head_lines = 17;

struct KnetEntry {
  std::string value;
  int line = 0;
};

KnetEntry find_knet(const RecordText& text, std::string_view label) {
  for (int i = 1; i <= std::min(knet_head_lines + 3, text.count()); ++i)
    if (upper(trim(text.line(i))).starts_with(upper(label))) return {std::string(text_after(text.line(i), label)), i};
  return {};
}

double knet_number(const RecordText& text, const KnetEntry& entry, const std::string& wanted) {
  const LeadingNumber value = leading_number(entry.value);
  if (value.length == 0 || value.out_of_range || !(value.value > 0))
    throw InputError(text.where(entry.line), "", wanted, in_quotes(entry.value));
  return value.value;
}

/// "3920(gal)/6182761": gal per count.
void read_scale(const RecordText& text, RecordDraft& draft) {
  const KnetEntry scale = find_knet(text, "Scale Factor");
  const std::string& word = scale.value;
  const std::size_t open = word.find('('), close = word.find(')'), slash = word.find('/');
  const std::optional<double> full = whole_number(std::string_view(word).substr(0, open));
  const std::optional<double> counts = slash == word.npos ? std::nullopt : whole_number(std::string_view(word).substr(slash + 1));
  if (!full || !counts || open == word.npos || close == word.npos || close < open || slash < close || !(*full / *counts > 0) ||
      !std::isfinite(*full / *counts))
    throw InputError(text.where(scale.line), "", "a scale factor such as 3920(gal)/6182761", in_quotes(word));
  draft.scale = *full / *counts;
  draft.unit = word.substr(open + 1, close - open - 1);
  draft.unit_line = scale.line;
}

/// "N-S", or of KiK-net "1" to "6": N-S, E-W, U-D in the borehole, then at the surface.
void read_direction(const RecordText& text, RecordDraft& draft) {
  constexpr std::array directions{"N-S", "E-W", "U-D"};
  draft.component = find_knet(text, "Dir.").value;
  if (draft.component.size() == 1 && draft.component[0] >= '1' && draft.component[0] <= '6') {
    const int number = draft.component[0] - '1';
    draft.component = std::string(directions[static_cast<std::size_t>(number % 3)]) + (number < 3 ? " borehole" : " surface");
  }
  draft.azimuth = azimuth_of(draft.component.substr(0, 3));
}

bool is_knet(const RecordText& text) {
  return find_knet(text, "Scale Factor").line > 0 && find_knet(text, "Sampling Freq").line > 0;
}

std::vector<Motion> read_knet(const RecordText& text, const RecordOptions& options) {
  RecordDraft draft;
  draft.arbitrary_zero = true;
  draft.per_row = 8;
  const KnetEntry frequency = find_knet(text, "Sampling Freq(Hz)"), duration = find_knet(text, "Duration Time(s)"),
                  peak = find_knet(text, "Max. Acc. (gal)");
  const double hertz = knet_number(text, frequency, "a sampling frequency > 0 Hz");
  draft.step = {1 / hertz, frequency.line};
  if (duration.line > 0) draft.count = {std::round(knet_number(text, duration, "a duration > 0 s") * hertz), duration.line};
  if (const std::optional<double> value = whole_number(peak.value)) draft.peak = {*value, peak.line};
  draft.peak_signed = false;
  draft.station = find_knet(text, "Station Code").value;
  draft.event = find_knet(text, "Origin Time").value;
  if (const std::string magnitude = find_knet(text, "Mag.").value; !magnitude.empty()) draft.event += ", magnitude " + magnitude;
  read_scale(text, draft);
  read_direction(text, draft);
  const KnetEntry memo = find_knet(text, "Memo.");
  for (int i = (memo.line > 0 ? memo.line : knet_head_lines) + 1; i <= text.count(); ++i) add_numbers(text, i, draft.samples);
  return {finished(text, options, std::move(draft))};
}

}  // namespace

const RecordFormat& entry_record_knet() {
  static const RecordFormat entry{{.name = "knet",
                                   .summary = "K-NET and KiK-net: counts with a scale factor, their mean taken off",
                                   .equations = "a(t) = scale factor (count - mean of the counts)",
                                   .source = "National Research Institute for Earth Science and Disaster Resilience: K-NET ASCII format",
                                   .params = {}},
                                  is_knet,
                                  read_knet};
  return entry;
}

}  // namespace uplift
