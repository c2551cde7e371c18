#include <algorithm>

#include "uplift/base/text.h"
#include "uplift/motion/formats/record_format.h"

// V1 and V2 of the California Strong Motion Instrumentation Program (CESMD), any number of channels one after the other. Text lines,
// integers and reals, then:
//   13200 Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)                         (V1, uncorrected)
//    7500 points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.6)                          (V2; velocity and displacement
//    follow)
// What V2 holds of velocity and displacement are integrals of the acceleration and left out.
namespace uplift {
namespace {

/// The line before a block of acceleration: begins with a number, says "points" and "accel".
bool begins_block(std::string_view line) {
  const std::string capital = upper(line);
  return number_after(line, 0) && capital.find("POINTS") != capital.npos && capital.find("ACCEL") != capital.npos &&
         capital.find(" AT ") != capital.npos;
}

/// ".010 sec" or "200 pts/sec".
double step_of(const RecordText& text, int line) {
  const std::string head = upper(text.line(line));
  const std::size_t at = head.find(" AT ");
  const std::optional<double> number = number_after(head, at + 4);
  if (!number) throw InputError(text.where(line), "", "a step, as in \"equally spaced at .01 sec\"", in_quotes(trim(text.line(line))));
  const bool rate =
      head.find("/SEC", at) != head.npos && (head.find("PTS/SEC", at) != head.npos || head.find("SAMPLES/SEC", at) != head.npos);
  return rate && *number != 0 ? 1 / *number : *number;
}

/// The first word behind the step that is a unit of acceleration.
std::string unit_of_head(std::string_view line) {
  const std::string head = upper(line);
  std::string_view rest = std::string_view(head).substr(std::min(head.find(" AT "), head.size()));
  while (!rest.empty()) {
    const std::size_t begin = rest.find_first_not_of(" \t,():");
    if (begin == rest.npos) break;
    const std::string_view word = rest.substr(begin, std::min(rest.find_first_of(" \t,():", begin), rest.size()) - begin);
    const std::optional<MotionUnit> unit = motion_unit(word);
    if (unit && unit->kind == MotionKind::acceleration) return std::string(word);
    rest.remove_prefix(begin + word.size());
  }
  return {};
}

/// Event, station, component and peak in the lines from `first` to the block.
void read_csmip_texts(const RecordText& text, int first, int block, RecordDraft& draft) {
  for (int i = first; i < block; ++i) {
    const std::string_view line = trim(text.line(i));
    const std::string capital = upper(line);
    if (capital.starts_with("STATION NO")) {
      const std::string_view name = trim(text.line(i + 1));
      draft.station = trim(name.substr(0, name.find("   ")));  // the agency stands behind it
    }
    if (capital.starts_with("CHAN") && line.find(':') != line.npos) draft.component = trim(line.substr(line.find(':') + 1));
    for (const std::string_view words : {"RECORD OF", "RCRD OF"})
      if (capital.starts_with(words) && draft.event.empty()) draft.event = text_after(line.substr(0, line.find("   ")), words);
    if (const std::size_t peak = capital.find("PEAK ACCELERATION"); peak != capital.npos)
      if (const std::optional<double> value = number_after(line, peak + 17)) draft.peak = {*value, i};
  }
  draft.azimuth = azimuth_of(draft.component);
}

bool is_csmip(const RecordText& text) {
  const std::string first = upper(trim(text.line(1)));
  return first.starts_with("CORRECTED ACCELEROGRAM") || first.starts_with("UNCORRECTED ACCELEROGRAM");
}

std::vector<Motion> read_csmip(const RecordText& text, const RecordOptions& options) {
  std::vector<Motion> motions;
  int first = 1;
  for (int i = 1; i <= text.count();) {
    if (!begins_block(text.line(i))) {
      ++i;
      continue;
    }
    // "7500 points of ... accel, veloc and displ data" in the text of V2 is no block: no numbers follow
    if (!number_after(text.line(i + 1), 0)) {
      ++i;
      continue;
    }
    RecordDraft draft;
    const RowForm form = row_form(text.line(i));
    draft.kind = MotionKind::acceleration;
    draft.count = {*number_after(text.line(i), 0), i};
    draft.step = {step_of(text, i), i};
    draft.unit = unit_of_head(text.line(i));
    draft.unit_line = i;
    draft.per_row = std::max<std::size_t>(form.numbers, 1);
    read_csmip_texts(text, first, i, draft);
    i = first = add_block(text, i + 1, draft.count->value, form.width, draft.samples);
    motions.push_back(finished(text, options, std::move(draft)));
  }
  if (motions.empty())
    throw InputError(text.where(), "", "a line such as \"7500 points of accel data equally spaced at .010 sec, in cm/sec2. (8f10.6)\"",
                     "none");
  return motions;
}

}  // namespace

const RecordFormat& entry_record_csmip() {
  static const RecordFormat entry{
      {.name = "csmip",
       .summary = "V1 and V2 of the California Strong Motion Instrumentation Program, as CESMD distributes them",
       .equations = "the line before the values gives their number, step, unit and form; velocity and displacement of V2 are left out",
       .source = "Shakal and Huang 1985, Standard tape format for CSMIP strong-motion data tapes",
       .params = {}},
      is_csmip,
      read_csmip};
  return entry;
}

}  // namespace uplift
