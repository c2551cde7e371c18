#include <algorithm>

#include "uplift/base/text.h"
#include "uplift/motion/formats/record_format.h"

// The format of the Consortium of Organizations for Strong-Motion Observation Systems (V1, V2), any number of channels one after the other:
//   Corrected acceleration    (Format v01.20 with 13 text lines)
//   100 Integer-header values follow on  10 lines, Format= (10I8)
//   100 Real-header values follow on  20 lines, Format= (5F15.6)
//     6 Comment line(s) follow, each starting with a "|":
//   42000 acceleration pts, approx  210 secs, units=cm/sec2(04),Format=(1E15.6)
// Integer 54: azimuth [degrees], beyond 360 something else. Real 62: step [ms]; real 34: step of the recorder [s]; real 64: signed peak.
namespace uplift {
namespace {

bool begins_channel(std::string_view line) {
  const std::string capital = upper(line);
  return capital.find("(FORMAT V") != capital.npos && capital.find("TEXT LINES") != capital.npos;
}

/// The next line from `from` on with this text in capitals that is no comment.
int find_line(const RecordText& text, int from, std::string_view words, const std::string& wanted) {
  for (int i = from; i <= text.count(); ++i)
    if (!trim(text.line(i)).starts_with("|") && upper(text.line(i)).find(words) != std::string::npos) return i;
  throw InputError(text.where(from), "", wanted, "the end of the file");
}

/// "100 Real-header values follow on  20 lines, Format= (5F15.6)" and those lines; `at` is moved behind them.
std::vector<double> cosmos_header(const RecordText& text, int& at, std::string_view words, const std::string& wanted) {
  const int line = find_line(text, at, words, "a line \"" + wanted + " follow on ... lines\"");
  const std::optional<double> count = number_after(text.line(line), 0);
  if (!count || *count < 1 || *count > 10000)
    throw InputError(text.where(line), "", "the number of " + wanted, in_quotes(trim(text.line(line))));
  Samples samples;
  at = add_block(text, line + 1, *count, row_form(text.line(line)).width, samples);
  if (static_cast<double>(samples.values.size()) < *count) throw InputError(text.where(at), "", wanted, "the end of the file");
  return samples.values;
}

double value(const std::vector<double>& header, std::size_t number) {
  constexpr double unknown = -999;
  return number <= header.size() ? header[number - 1] : unknown;
}

void read_cosmos_texts(const RecordText& text, int first, int last, RecordDraft& draft) {
  draft.event = trim(text.line(first + 1));
  if (const std::string_view event = text_after(draft.event, "Record of"); !event.empty()) draft.event = std::string(event);
  for (int i = first; i < last; ++i) {
    const std::string_view line = text.line(i);
    if (const std::string_view station = text_after(line, "Code:"); upper(line).starts_with("STATN")) draft.station = station;
    if (!upper(line).starts_with("STA CHA")) continue;
    // "Sta Chan  1:  90 Deg (Rcrdr Chan  3) Location: roof", "Sta Chan  HNE  90 deg  Location: 00"
    const std::size_t begin = line.find_first_not_of("nN", 7);
    const std::string_view channel = line.substr(std::min(begin, line.size()));
    const std::string_view named = channel.substr(0, std::min(channel.find("(Rcrdr"), channel.find("Location")));
    const std::size_t colon = named.rfind(':');
    draft.component = trim(colon == named.npos ? named : named.substr(colon + 1));
  }
}

RecordDraft read_channel(const RecordText& text, int& at) {
  RecordDraft draft;
  const int first = at;
  const std::vector<double> integers = cosmos_header(text, at, "INTEGER-HEADER", "integer-header values");
  read_cosmos_texts(text, first, at, draft);
  const int reals_line = at;
  const std::vector<double> reals = cosmos_header(text, at, "REAL-HEADER", "real-header values");
  const int line = find_line(text, at, "UNITS=", "a line \"... acceleration pts, ... units=...\"");
  const std::string head = upper(text.line(line));
  const RowForm form = row_form(head.substr(std::min(head.find("FORMAT"), head.size())));

  if (const double azimuth = value(integers, 54); azimuth > 0 && azimuth <= 360) draft.azimuth = azimuth_of(shortest(azimuth));
  const double step = value(reals, 62) > 0 ? value(reals, 62) / 1000 : value(reals, 34);
  draft.step = {step, reals_line};
  if (value(reals, 64) != -999) draft.peak = {value(reals, 64), reals_line};
  const std::optional<double> count = number_after(head, 0);
  if (!count) throw InputError(text.where(line), "", "the number of points", in_quotes(trim(text.line(line))));
  draft.count = {*count, line};
  if (head.find("ACCEL") != head.npos) draft.kind = MotionKind::acceleration;
  if (head.find("VELOC") != head.npos) draft.kind = MotionKind::velocity;
  if (head.find("DISPL") != head.npos) draft.kind = MotionKind::displacement;
  const std::string_view units = text_after(head, "UNITS=");
  draft.unit = trim(units.substr(0, units.find_first_of("(,")));
  draft.unit_line = line;
  draft.per_row = std::max<std::size_t>(form.numbers, 1);
  at = add_block(text, line + 1, *count, form.width, draft.samples);
  return draft;
}

bool is_cosmos(const RecordText& text) {
  return begins_channel(text.line(1));
}

std::vector<Motion> read_cosmos(const RecordText& text, const RecordOptions& options) {
  std::vector<Motion> motions;
  for (int i = 1; i <= text.count();) {
    if (!begins_channel(text.line(i))) {
      ++i;
      continue;
    }
    RecordDraft draft = read_channel(text, i);
    motions.push_back(finished(text, options, std::move(draft)));
  }
  if (motions.empty())
    throw InputError(text.where(1), "", "a first line with \"(Format v01.20 with 13 text lines)\"", in_quotes(trim(text.line(1))));
  return motions;
}

}  // namespace

const RecordFormat& entry_record_cosmos() {
  static const RecordFormat entry{
      {.name = "cosmos",
       .summary = "COSMOS V1 and V2, one channel or several",
       .equations =
           "step: real-header value 62 [ms]; azimuth: integer-header value 54; unit and number of points: the line before the values",
       .source = "COSMOS Strong Motion Data Format, version 1.20 (2001)",
       .params = {}},
      is_cosmos,
      read_cosmos};
  return entry;
}

}  // namespace uplift
