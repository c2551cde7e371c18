#include <algorithm>

#include "uplift/base/text.h"
#include "uplift/motion/formats/record_format.h"

// The files of the Engineering Strong Motion database and of ITACA ("DYNA" heads): some 64 lines "KEY: value", then one number per line.
//   EVENT_NAME: EMILIA ... SAMPLING_INTERVAL_S: 0.005000 / NDATA: 18904 / STREAM: HNE / UNITS: cm/s^2 / PGA_CM/S^2: 1.326285 / DATA_TYPE:
//   ACCELERATION
namespace uplift {
namespace {

constexpr int most_esm_head_lines = 120;

struct EsmEntry {
  std::string value;
  int line = 0;
};

/// The value of the key with this name, or the last line of the head when there is none.
EsmEntry find_esm(const RecordText& text, std::string_view key) {
  for (int i = 1; i <= std::min(most_esm_head_lines, text.count()); ++i) {
    const std::string_view line = trim(text.line(i));
    const std::size_t colon = line.find(':');
    if (colon != line.npos && upper(trim(line.substr(0, colon))) == key) return {std::string(trim(line.substr(colon + 1))), i};
  }
  return {};
}

Stated esm_number(const RecordText& text, std::string_view key, const std::string& wanted) {
  const EsmEntry entry = find_esm(text, key);
  const std::optional<double> value = whole_number(entry.value);
  if (!value) throw InputError(text.where(entry.line), std::string(key), wanted, entry.value.empty() ? "nothing" : in_quotes(entry.value));
  return {*value, entry.line};
}

int first_row(const RecordText& text) {
  int row = 1;
  while (row <= text.count() && (text.line(row).find(':') != std::string_view::npos || trim(text.line(row)).empty())) ++row;
  return row;
}

/// The last letter of a stream ("HNE", "HGN", "HNZ") is its direction.
std::optional<double> stream_azimuth(const std::string& stream) {
  if (stream.empty() || stream.back() == 'Z') return std::nullopt;
  return azimuth_of(stream.substr(stream.size() - 1));
}

bool is_esm(const RecordText& text) {
  return find_esm(text, "SAMPLING_INTERVAL_S").line > 0 && find_esm(text, "NDATA").line > 0;
}

std::vector<Motion> read_esm(const RecordText& text, const RecordOptions& options) {
  RecordDraft draft;
  draft.step = esm_number(text, "SAMPLING_INTERVAL_S", "a time step [s]");
  draft.count = esm_number(text, "NDATA", "the number of points");
  const EsmEntry units = find_esm(text, "UNITS"), type = find_esm(text, "DATA_TYPE");
  draft.unit = units.value;
  draft.unit_line = units.line;
  const std::string kind = upper(type.value);
  std::string_view peak = "PGA_CM/S^2";
  if (kind == "ACCELERATION") draft.kind = MotionKind::acceleration;
  if (kind == "VELOCITY") draft.kind = MotionKind::velocity, peak = "PGV_CM/S";
  if (kind == "DISPLACEMENT") draft.kind = MotionKind::displacement, peak = "PGD_CM";
  if (!draft.kind && type.line > 0)
    throw InputError(text.where(type.line), "DATA_TYPE", "ACCELERATION, VELOCITY or DISPLACEMENT", in_quotes(type.value));
  const EsmEntry largest = find_esm(text, peak);
  const std::optional<MotionUnit> unit = motion_unit(units.value);
  if (const std::optional<double> value = whole_number(largest.value); value && unit)
    draft.peak = {*value * 0.01 / unit->factor, largest.line};

  const std::string name = find_esm(text, "STATION_NAME").value, network = find_esm(text, "NETWORK").value;
  draft.event = find_esm(text, "EVENT_NAME").value;
  if (const std::string date = find_esm(text, "EVENT_DATE_YYYYMMDD").value; !date.empty())
    draft.event += (draft.event.empty() ? "" : ", ") + date;
  draft.station = (network.empty() ? "" : network + ".") + find_esm(text, "STATION_CODE").value + (name.empty() ? "" : ", " + name);
  draft.component = find_esm(text, "STREAM").value;
  draft.azimuth = stream_azimuth(draft.component);
  for (int i = first_row(text); i <= text.count(); ++i) add_numbers(text, i, draft.samples);
  return {finished(text, options, std::move(draft))};
}

}  // namespace

const RecordFormat& entry_record_esm() {
  static const RecordFormat entry{{.name = "esm",
                                   .summary = "ESM and ITACA (DYNA): lines \"KEY: value\", then one number per line",
                                   .equations = "SAMPLING_INTERVAL_S and NDATA are needed; UNITS, DATA_TYPE and PGA_CM/S^2 are checked",
                                   .source = "Luzi et al. 2016, Seismological Research Letters 87(4)",
                                   .params = {}},
                                  is_esm,
                                  read_esm};
  return entry;
}

}  // namespace uplift
