#include <algorithm>
#include <cmath>

#include "uplift/base/text.h"
#include "uplift/motion/formats/record_format.h"

// The SMC format of the U.S. Geological Survey: 11 lines of text, 48 integers (8I10), 50 reals (5E15.7), comments that begin with "|",
// values (8F10 or 8E10.4E1) in cm and s.
//   2 CORRECTED ACCELEROGRAM
//   station = San Francisco, 575 Market   component=    225
// Integer 14: azimuth [degrees], 16: lines of comments, 17: number of values, -32768: unknown.
// Real 2: samples per second, 30 and 32: largest and smallest value, 1.7e38: unknown.
namespace uplift {
namespace {

constexpr int text_lines = 11, integer_lines = 6, real_lines = 10;
constexpr double unknown_integer = -32768, unknown_real = 1e38;

bool is_smc(const RecordText& text) {
  const std::string first = upper(trim(text.line(1)));
  if (first.size() < 3 || first[0] < '0' || first[0] > '6' || first[1] != ' ') return false;
  const std::string_view type = trim(std::string_view(first).substr(2));
  const bool known = std::ranges::any_of(std::initializer_list<std::string_view>{"UNCORRECTED ACC", "CORRECTED ACC", "VELOCITY",
                                                                                 "DISPLACEMENT", "UNKNOWN", "RESPONSE SPECTRA"},
                                         [&](std::string_view word) { return type.starts_with(word); });
  return known && number_after(text.line(text_lines + 1), 0).has_value();
}

std::vector<double> smc_header(const RecordText& text, int first, int lines, std::size_t numbers, std::size_t width) {
  Samples samples;
  for (int i = first; i < first + lines; ++i) {
    const std::size_t before = samples.values.size();
    add_numbers(text, i, samples, width);
    if (samples.values.size() != before + numbers)
      throw InputError(text.where(i), "", std::to_string(numbers) + " numbers of the head", std::to_string(samples.values.size() - before));
  }
  return samples.values;
}

void read_kind(const RecordText& text, RecordDraft& draft) {
  const std::string type = upper(trim(text.line(1)));
  draft.unit_line = 1;
  draft.kind = MotionKind::acceleration;
  draft.unit = "cm/s2";
  if (type.find("VELOCITY") != type.npos) draft.kind = MotionKind::velocity, draft.unit = "cm/s";
  if (type.find("DISPLACEMENT") != type.npos) draft.kind = MotionKind::displacement, draft.unit = "cm";
  if (type.find("SPECTRA") != type.npos) throw InputError(text.where(1), "", "a time history", in_quotes(trim(text.line(1))));
}

void read_smc_texts(const RecordText& text, RecordDraft& draft) {
  const std::string_view event = trim(text.line(4));
  // behind year, month, day and time of the day
  const std::size_t name = event.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz");
  draft.event = trim(name == event.npos ? event : event.substr(name));
  for (int i = 2; i <= text_lines; ++i) {
    const std::string_view line = text.line(i);
    const std::size_t component = upper(line).find("COMPONENT");
    if (const std::string_view station = text_after(line.substr(0, component), "station"); !station.empty() && draft.station.empty())
      draft.station = station;
    if (component != std::string::npos && draft.component.empty()) draft.component = text_after(line, "component");
  }
}

std::vector<Motion> read_smc(const RecordText& text, const RecordOptions& options) {
  RecordDraft draft;
  read_kind(text, draft);
  read_smc_texts(text, draft);
  const std::vector<double> integers = smc_header(text, text_lines + 1, integer_lines, 8, 10);
  const int reals_line = text_lines + integer_lines + 1;
  const std::vector<double> reals = smc_header(text, reals_line, real_lines, 5, 15);
  if (integers[13] >= 0 && integers[13] <= 360) draft.azimuth = azimuth_of(shortest(integers[13]));
  if (std::abs(reals[1]) >= unknown_real && !options.step)
    throw InputError(text.where(reals_line), "", "samples per second in the second real of the head",
                     "none (a digitised film with uneven times is not read)");
  if (std::abs(reals[1]) < unknown_real) draft.step = {reals[1] == 0 ? 0 : 1 / reals[1], reals_line};
  if (integers[16] != unknown_integer) draft.count = {integers[16], text_lines + 3};
  if (std::abs(reals[29]) < unknown_real && std::abs(reals[31]) < unknown_real)
    draft.peak = {std::abs(reals[29]) >= std::abs(reals[31]) ? reals[29] : reals[31], reals_line + 5};
  draft.per_row = 8;
  int first = reals_line + real_lines;
  while (first <= text.count() && trim(text.line(first)).starts_with("|")) ++first;
  add_block(text, first, draft.count ? draft.count->value + 16 : 1e18, 10, draft.samples);
  return {finished(text, options, std::move(draft))};
}

}  // namespace

const RecordFormat& entry_record_smc() {
  static const RecordFormat entry{
      {.name = "smc",
       .summary = "SMC of the U.S. Geological Survey: accelerations, velocities or displacements at equal steps",
       .equations = "step = 1 / (samples per second, second real of the head); values in cm and s",
       .source = "Seekins et al. 1992, USGS Open-File Report: Digitized strong-motion accelerograms (CD-ROM)",
       .params = {}},
      is_smc,
      read_smc};
  return entry;
}

}  // namespace uplift
