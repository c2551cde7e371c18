#include "uplift/io/report/motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numbers>
#include <utility>

#include "uplift/motion/formats/convert.h"
#include "uplift/motion/intensity.h"
#include "uplift/motion/spectrum.h"

namespace uplift {
namespace {

constexpr double spectrum_damping = 0.05, least_frequency = 0.1, most_frequency = 50;  // 1, Hz
constexpr int spectrum_points = 300;

Motion acceleration_of(const MotionHistory& history) {
  return converted(*history.motion(), MotionKind::acceleration);
}

/// Title of a table over motions: the variant, and the damping when there are several.
std::string title_of(const MotionTable& table) {
  return "Statistics over the motions: " + table.run + (table.damping.empty() ? "" : ", " + table.damping);
}

void write_over_motions_table(JsonWriter& json, const MotionTable& table, std::size_t number) {
  json.begin_object().member("id", fmt::format("over_motions_{}", number)).member("title", title_of(table));
  json.member("caption",
              fmt::format("Largest magnitudes. Envelope, mean and standard deviation of the sample, over the {} completed runs of {}.",
                          table.counted, table.rows.size()));
  json.key("columns").begin_array();
  write_column(json, {"motion", "Motion", "", "text", 0});
  write_column(json, {"status", "Status", "", "status", 0});
  for (const MotionTable::Quantity& quantity : table.quantities) {
    const bool share = quantity.unit == "1";
    write_column(json, {quantity.key.c_str(), quantity.label.c_str(), share ? "" : quantity.unit.c_str(), share ? "percent" : "number", 4});
  }
  json.end_array().key("rows").begin_array();
  const auto row = [&](const std::string& motion, std::string_view status, const std::vector<double>& values) {
    json.begin_object().member("motion", motion).member("status", status);
    for (std::size_t k = 0; k < values.size(); ++k) json.member(table.quantities[k].key, values[k]);
    json.end_object();
  };
  for (const MotionTable::Row& each : table.rows) row(each.motion, to_string(each.status), each.peaks);
  row("envelope", "", table.envelope);
  row("mean", "", table.mean);
  row("standard deviation", "", table.spread);
  json.end_array().end_object();
}

Chart motion_chart(const Histories& motions, MotionKind kind) {
  const std::string word(to_string(kind)), title = std::string(1, static_cast<char>(std::toupper(word.front()))) + word.substr(1);
  Chart chart{"motion_" + word,
              "motions",
              title + " of the ground",
              "Ground motions of the model, without the amplitude factors of the case.",
              {"Time", "s"},
              {title, std::string(unit_of(kind))},
              {}};
  for (const auto& history : motions) {
    const Motion motion = converted(*history->motion(), kind);
    Curve curve;
    curve.label = motion.name;
    curve.y = motion.values;
    for (std::size_t i = 0; i < curve.y.size(); ++i) curve.x.push_back(motion.step * static_cast<double>(i));
    thin_history(curve.x, curve.y, points_per_curve);
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

Chart spectrum_chart(const Histories& motions) {
  Chart chart{"motion_spectrum",
              "motions",
              "Response spectra of the ground",
              "Pseudo-acceleration of oscillators with 5 % damping.",
              {"Frequency", "Hz", true},
              {"PSA", "m/s2"},
              {}};
  const std::vector<double> frequencies = log_spaced(least_frequency, most_frequency, spectrum_points);
  for (const auto& history : motions) {
    const Motion motion = acceleration_of(*history);
    Spectrum spectrum = response_spectra(motion.values, motion.step, frequencies, {spectrum_damping}, Spectrum::Kind::psa).front();
    Curve curve;
    curve.label = motion.name;
    curve.x = frequencies;
    curve.y = std::move(spectrum.values);
    chart.curves.push_back(std::move(curve));
  }
  return chart;
}

/// A long text as lines that fit a page, parted where a thought ends, else between words.
std::vector<std::string> lines_of(std::string_view text) {
  constexpr std::size_t most = 110;  // characters
  std::vector<std::string> lines;
  while (text.size() > most) {
    std::size_t end = std::string_view::npos;
    for (const std::string_view mark : {"; ", ". ", ": ", ", ", " "})
      if (end = text.rfind(mark, most - mark.size()); end != text.npos && end >= most / 3) {
        end += mark.size();
        break;
      }
    if (end == text.npos || end < most / 3) break;
    lines.emplace_back(text.substr(0, text[end - 2] == ';' ? end - 2 : end - 1));
    text.remove_prefix(end);
  }
  lines.emplace_back(text);
  return lines;
}

}  // namespace

Histories motions_of(const std::vector<ReportRun>& runs) {
  Histories found;
  for (const ReportRun& run : runs)
    for (const MotionUse& use : run.built->motions)
      if (std::ranges::find(found, use.history) == found.end()) found.push_back(use.history);
  return found;
}

void write_motion_numbers(JsonWriter& json, const Histories& motions, std::string_view caption) {
  json.begin_object().member("id", "motions").member("title", "Motions");
  json.member(
      "caption",
      fmt::format("{} PGV and PGD: exact integration of the acceleration, which is linear between its samples. Arias: π/(2 g) times the "
                  "integral of a². D5-95: time from 5 % to 95 % of the Arias intensity. CAV: integral of |a|. Housner: integral of "
                  "the pseudo-velocity with 5 % damping over periods from 0.1 s to 2.5 s.",
                  caption));
  json.key("columns").begin_array();
  for (const TableColumn& column : {TableColumn{"name", "Motion", "", "text", 0},
                                    {"station", "Station", "", "text", 0},
                                    {"component", "Component", "", "text", 0},
                                    {"count", "Points", "", "number", 6},
                                    {"step", "Step", "s", "number", 4},
                                    {"duration", "Duration", "s", "number", 4},
                                    {"pga", "PGA", "m/s2", "number", 4},
                                    {"pgv", "PGV", "m/s", "number", 4},
                                    {"pgd", "PGD", "m", "number", 4},
                                    {"arias", "Arias", "m/s", "number", 4},
                                    {"cav", "CAV", "m/s", "number", 4},
                                    {"significant", "D5-95", "s", "number", 4},
                                    {"housner", "Housner", "m", "number", 4}})
    write_column(json, column);
  json.end_array().key("rows").begin_array();
  for (const auto& history : motions) {
    const Motion& motion = *history->motion();
    const Intensity intensity = intensity_of(acceleration_of(*history));
    json.begin_object().member("name", motion.name).member("station", motion.station).member("component", motion.component);
    json.member("count", static_cast<long>(motion.values.size())).member("step", motion.step).member("duration", motion.duration());
    json.member("pga", intensity.pga).member("pgv", intensity.pgv).member("pgd", intensity.pgd);
    json.member("arias", intensity.arias).member("cav", intensity.cav);
    json.member("significant", intensity.significant_duration()).member("housner", intensity.housner).end_object();
  }
  json.end_array().end_object();
}

void write_motion_origins(JsonWriter& json, const Histories& motions) {
  json.begin_object().member("id", "motion_origins").member("title", "Sources of the motions");
  json.member("caption", "Files with SHA-256, factors to SI units, repairs made on reading, and all processing steps.");
  json.key("columns").begin_array();
  for (const TableColumn& column : {TableColumn{"what", "What", "", "text", 0}, {"value", "Value", "", "text", 0}})
    write_column(json, column);
  json.end_array().key("rows").begin_array();
  for (const auto& history : motions) {
    const Motion& motion = *history->motion();
    const auto row = [&](const std::string& what, const std::string& value) {
      if (!value.empty()) json.begin_object().member("name", motion.name).member("what", what).member("value", value).end_object();
    };
    row("file", motion.file);
    row("SHA-256", motion.sha256);
    row("format", motion.format);
    row("event", motion.event);
    if (!motion.unit.empty()) row("unit", fmt::format("{}, times {:.8g}", motion.unit, motion.factor));
    if (motion.azimuth) row("azimuth", fmt::format("{:.4g} degrees, clockwise from north", *motion.azimuth * 180 / std::numbers::pi));
    for (const std::string& repair : motion.repairs)
      for (const std::string& line : lines_of(repair)) row("repaired", line);
    for (std::size_t i = 0; i < motion.processing.size(); ++i) {
      const std::vector<std::string> lines = lines_of(motion.processing[i]);
      for (std::size_t k = 0; k < lines.size(); ++k) row(fmt::format("step {}{}", i + 1, k == 0 ? "" : ", continued"), lines[k]);
    }
  }
  json.end_array().member("rowGroup", "name").end_object();
}

void write_motion_tables(JsonWriter& json, const ReportInput& input) {
  if (input.compared)
    for (std::size_t i = 0; i < input.compared->motions.size(); ++i) write_over_motions_table(json, input.compared->motions[i], i + 1);
  const Histories motions = motions_of(input.runs);
  if (motions.empty()) return;
  write_motion_numbers(json, motions, "As applied to the model.");
  write_motion_origins(json, motions);
}

void write_motion_charts(JsonWriter& json, const ReportInput& input) {
  const Histories motions = motions_of(input.runs);
  if (motions.empty()) return;
  write_chart(json, motion_chart(motions, MotionKind::acceleration));
  write_chart(json, spectrum_chart(motions));
  write_chart(json, motion_chart(motions, MotionKind::velocity));
  write_chart(json, motion_chart(motions, MotionKind::displacement));
}

}  // namespace uplift
