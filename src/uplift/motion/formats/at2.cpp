#include <fmt/format.h>

#include "uplift/base/text.h"
#include "uplift/motion/formats/record_format.h"

// The files of the Pacific Earthquake Engineering Research Center: four lines, then five numbers per row.
//   PEER NGA STRONG MOTION DATABASE RECORD            (PEER STRONG MOTION DATABASE RECORD. PROCESSING BY ..., and others)
//   Imperial Valley-06, 10/15/1979, El Centro Array #6, 230       (old: IMPERIAL VALLEY 10/15/79 2319, EL CENTRO ARRAY 6, 230)
//   ACCELERATION TIME SERIES IN UNITS OF G            (VELOCITY ... CM/S in .VT2, DISPLACEMENT ... CM in .DT2)
//   NPTS=   7990, DT=   .0050 SEC,                    (old: 4096    0.0100    NPTS, DT)
namespace uplift {
namespace {

constexpr int at2_head_lines = 12;  // nobody has more before the line of NPTS

/// The line with both words and a number below it, 0 when there is none.
int counts_line(const RecordText& text) {
  for (int i = 1; i <= std::min(at2_head_lines, text.count()); ++i) {
    const std::string line = upper(text.line(i));
    if (find_word(line, "NPTS") != line.npos && find_word(line, "DT") != line.npos) return number_after(text.line(i + 1), 0) ? i : 0;
  }
  return 0;
}

/// "NPTS= 7990, DT= .005 SEC" or "7990 .005 NPTS, DT".
void read_counts(const RecordText& text, int at, RecordDraft& draft) {
  const std::string line = upper(text.line(at));
  const std::size_t points = find_word(line, "NPTS"), step = find_word(line, "DT");
  std::optional<double> count = number_after(line, points + 4), seconds = number_after(line, step + 2);
  if (!count && !seconds) {
    count = number_after(line, 0);
    if (const std::size_t second = line.find_first_of(" \t,", line.find_first_not_of(" \t")); second != line.npos)
      seconds = number_after(line, second);
  }
  if (!count || !seconds)
    throw InputError(text.where(at), "", "the number of points and the step, as in \"NPTS= 4000, DT= .005 SEC\"",
                     in_quotes(trim(text.line(at))));
  draft.count = {*count, at};
  draft.step = {*seconds, at};
}

/// The line of the unit, the one of the event two before the counts.
void read_head(const RecordText& text, int counts, RecordDraft& draft) {
  for (int i = counts - 1; i >= 1; --i) {
    const std::string line = upper(text.line(i));
    const std::size_t units = line.find("UNITS OF");
    if (units == line.npos) continue;
    // "G", and "G. FILTER POINTS: HP=0.2 Hz LP=35.0 Hz" in the database of 2000
    const std::string_view unit = std::string_view(line).substr(units + 8);
    draft.unit = trim(unit.substr(0, unit.find(". ")));
    draft.unit_line = i;
    if (line.find("ACCEL") != line.npos) draft.kind = MotionKind::acceleration;
    if (line.find("VELOC") != line.npos) draft.kind = MotionKind::velocity;
    if (line.find("DISPL") != line.npos) draft.kind = MotionKind::displacement;
    break;
  }
  const int named = (draft.unit_line > 0 ? draft.unit_line : counts) - 1;
  if (draft.unit_line == 0) draft.unit_line = counts;
  const std::string_view line = trim(text.line(named));
  const std::size_t last = line.rfind(','), before = last == line.npos || last == 0 ? line.npos : line.rfind(',', last - 1);
  if (last == line.npos) {
    draft.event = line;
    return;
  }
  draft.component = trim(line.substr(last + 1));
  draft.azimuth = azimuth_of(draft.component);
  draft.station = trim(before == line.npos ? std::string_view() : line.substr(before + 1, last - before - 1));
  draft.event = trim(line.substr(0, before == line.npos ? last : before));
}

bool is_at2(const RecordText& text) {
  return counts_line(text) > 0;
}

std::vector<Motion> read_at2(const RecordText& text, const RecordOptions& options) {
  const int counts = counts_line(text);
  if (counts == 0) throw InputError(text.where(), "", "a line with NPTS and DT", fmt::format("none in the first {} lines", at2_head_lines));
  RecordDraft draft;
  draft.per_row = 5;
  read_counts(text, counts, draft);
  read_head(text, counts, draft);
  for (int i = counts + 1; i <= text.count(); ++i) add_numbers(text, i, draft.samples);
  return {finished(text, options, std::move(draft))};
}

}  // namespace

const RecordFormat& entry_record_at2() {
  static const RecordFormat entry{
      {.name = "at2",
       .summary = "PEER: .AT2, .VT2, .DT2 with old and new heads",
       .equations = "a line with NPTS and DT in the head; the line before it names the unit, the one before that event, station, component",
       .source = "PEER Strong Motion Database; PEER NGA-West2 Ground Motion Database",
       .params = {}},
      is_at2,
      read_at2};
  return entry;
}

}  // namespace uplift
