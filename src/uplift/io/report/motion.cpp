#include "uplift/io/report/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "uplift/io/report/motions.h"
#include "uplift/motion/formats/convert.h"
#include "uplift/motion/intensity.h"
#include "uplift/motion/spectrum.h"

namespace uplift {
namespace {

constexpr std::size_t points_per_motion = 3000, points_per_fit = 800;
constexpr std::string_view origin = "uplift motion";

Histories histories_of(const MotionReport& report) {
  Histories histories;
  for (const ShownMotion& shown : report.motions)
    histories.push_back(std::make_shared<const MotionHistory>(std::make_shared<const Motion>(shown.now)));
  return histories;
}

bool was_processed(const ShownMotion& shown) {
  return shown.first.processing != shown.now.processing;
}

Curve history_curve(const Motion& motion, MotionKind kind, std::string label, bool dash) {
  Curve curve{std::move(label), "", {}, converted(motion, kind).values, dash, false};
  for (std::size_t i = 0; i < curve.y.size(); ++i) curve.x.push_back(motion.step * static_cast<double>(i));
  thin_history(curve.x, curve.y, points_per_motion);
  return curve;
}

Chart history_chart(const ShownMotion& shown, std::size_t number, MotionKind kind) {
  const std::string word(to_string(kind));
  Chart chart{fmt::format("{}_{}", word, number),
              fmt::format("motion_{}", number),
              static_cast<char>(word.front() - 'a' + 'A') + word.substr(1),
              was_processed(shown) ? "Solid: after processing. Dashed: before." : "",
              {"Time", "s"},
              {"Ground " + word, std::string(unit_of(kind))},
              {}};
  if (was_processed(shown)) chart.curves.push_back(history_curve(shown.first, kind, "before", true));
  chart.curves.push_back(history_curve(shown.now, kind, was_processed(shown) ? "processed" : shown.now.name, false));
  return chart;
}

std::string percent(double share) {
  return fmt::format("{:g} %", 100 * share);
}

std::vector<Spectrum> spectra_of(const Motion& motion, const std::vector<double>& frequencies, const std::vector<double>& dampings) {
  const Motion acceleration = converted(motion, MotionKind::acceleration);
  return response_spectra(acceleration.values, acceleration.step, frequencies, dampings, Spectrum::Kind::psa);
}

Curve spectrum_curve(const Spectrum& spectrum, std::string label, bool dash) {
  return {std::move(label), "", spectrum.frequencies, spectrum.values, dash, false};
}

/// All dampings of one motion; before the processing the first one only.
Chart spectrum_chart(const ShownMotion& shown, std::size_t number, const MotionReport& report) {
  const std::vector<double>& dampings = report.dampings;
  Chart chart{fmt::format("spectrum_{}", number),
              fmt::format("motion_{}", number),
              "Response spectra",
              "Pseudo-acceleration of damped oscillators.",
              {"Frequency", "Hz", true},
              {"Pseudo-acceleration", "m/s2"},
              {}};
  for (const Spectrum& spectrum : spectra_of(shown.now, report.frequencies, dampings))
    chart.curves.push_back(spectrum_curve(spectrum, percent(spectrum.damping) + " damping", false));
  if (was_processed(shown)) {
    chart.caption += " Dashed: before processing.";
    chart.curves.push_back(spectrum_curve(spectra_of(shown.first, report.frequencies, {dampings.front()}).front(),
                                          percent(dampings.front()) + ", before", true));
  }
  return chart;
}

/// What a generated motion was made for, and what it has.
Chart fit_chart(const SpectrumFit& fit, std::size_t number) {
  Chart chart{fmt::format("fit_{}", number),
              fmt::format("motion_{}", number),
              "Fit to the target",
              fmt::format("{} damping. Mean error {:.2f} %; smallest ratio to the target {:.1f} %.", percent(fit.damping),
                          100 * fit.mean_error, 100 * fit.least_ratio),
              {"Frequency", "Hz", true},
              {"Pseudo-acceleration", "m/s2"},
              {}};
  std::vector<double> least = fit.target;
  for (double& value : least) value *= 0.9;
  chart.curves = {{"target", "", fit.frequencies, fit.target, false, false},
                  {"motion", "", fit.frequencies, fit.reached, false, false},
                  {"90 % of the target", "", fit.frequencies, std::move(least), true, false}};
  for (Curve& curve : chart.curves) thin_history(curve.x, curve.y, points_per_fit);
  return chart;
}

bool side_by_side(const Motion& a, const Motion& b) {
  return a.step == b.step && a.values.size() == b.values.size();
}

/// All motions with the first damping; for two that go together the spectra over all directions.
Chart together_chart(const MotionReport& report) {
  const double damping = report.dampings.front();
  Chart chart{"spectra",
              "together",
              fmt::format("Response spectra, {} damping", percent(damping)),
              "Pseudo-acceleration.",
              {"Frequency", "Hz", true},
              {"Pseudo-acceleration", "m/s2"},
              {}};
  for (const ShownMotion& shown : report.motions)
    chart.curves.push_back(spectrum_curve(spectra_of(shown.now, report.frequencies, {damping}).front(), shown.now.name, false));
  if (report.rotated) {
    chart.caption += fmt::format(
        " RotD50 and RotD100: median and largest value over all directions of {}, provided that these are horizontal and perpendicular.",
        report.rotated_names);
    chart.curves.push_back(spectrum_curve(report.rotated->median, "RotD50", true));
    chart.curves.push_back(spectrum_curve(report.rotated->largest, "RotD100", true));
  }
  return chart;
}

void write_fits(JsonWriter& json, const MotionReport& report) {
  json.begin_object().member("id", "fits").member("title", "Fit to the target spectra");
  json.member("caption",
              "Over the frequency band of the fit: mean of |ratio − 1|, smallest ratio, mean ratio and largest error of the motion's "
              "spectrum relative "
              "to the target. Limits: mean error 5 %, smallest ratio 90 %.");
  json.key("columns").begin_array();
  for (const TableColumn& column : {TableColumn{"name", "Motion", "", "text", 0},
                                    {"status", "Fit", "", "text", 0},
                                    {"damping", "Damping", "", "percent", 2},
                                    {"from", "From", "Hz", "number", 3},
                                    {"to", "To", "Hz", "number", 3},
                                    {"mean", "Mean error", "", "percent", 3},
                                    {"least", "Smallest ratio", "", "percent", 4},
                                    {"average", "Mean ratio", "", "percent", 4},
                                    {"largest", "Largest error", "", "percent", 3}})
    write_column(json, column);
  json.end_array().key("rows").begin_array();
  for (const ShownMotion& shown : report.motions) {
    if (!shown.fit) continue;
    const SpectrumFit& fit = *shown.fit;
    json.begin_object().member("name", shown.now.name).member("status", fit.good() ? "within the limits" : "outside the limits");
    json.member("damping", fit.damping).member("from", fit.frequencies.front()).member("to", fit.frequencies.back());
    json.member("mean", fit.mean_error).member("least", fit.least_ratio).member("average", fit.mean_ratio);
    json.member("largest", fit.largest_error).end_object();
  }
  json.end_array().end_object();
}

struct Correlation {
  std::string first, second;
  double value = 0;
};
/// Pairs of motions with their correlation coefficients.
std::vector<Correlation> correlations_of(const MotionReport& report) {
  std::vector<Correlation> pairs;
  for (std::size_t i = 0; i < report.motions.size(); ++i)
    for (std::size_t j = i + 1; j < report.motions.size(); ++j) {
      const Motion &first = report.motions[i].now, &second = report.motions[j].now;
      if (const std::optional<double> value = correlation_of(first, second)) pairs.push_back({first.name, second.name, *value});
    }
  return pairs;
}

void write_correlation_table(JsonWriter& json, const MotionReport& report) {
  json.begin_object().member("id", "correlations").member("title", "Correlation of the motions");
  json.member(
      "caption",
      "Correlation coefficient at equal times. Motions count as statistically independent up to 0.16 (US NRC Standard Review Plan 3.7.1).");
  json.key("columns").begin_array();
  write_column(json, {"first", "Motion", "", "text", 0});
  write_column(json, {"second", "Motion", "", "text", 0});
  write_column(json, {"correlation", "Correlation", "", "number", 3});
  json.end_array().key("rows").begin_array();
  for (const Correlation& each : correlations_of(report))
    json.begin_object().member("first", each.first).member("second", each.second).member("correlation", each.value).end_object();
  json.end_array().end_object();
}

void write_facts(JsonWriter& json, const MotionReport& report) {
  const ShownMotion& shown = report.motions.front();
  const Intensity intensity = intensity_of(converted(shown.now, MotionKind::acceleration));
  const auto fact = [&](const char* label, const std::string& value, const std::string& detail = {}) {
    json.begin_object().member("label", label).member("value", value).member("detail", detail).end_object();
  };
  const std::string of = report.motions.size() > 1 ? "of " + shown.now.name : "";
  json.key("facts").begin_array();
  fact("Peak acceleration", fmt::format("{:.3g} m/s²", intensity.pga),
       fmt::format("{:.3g} g{}", intensity.pga / standard_gravity, of.empty() ? "" : ", " + of));
  fact("Peak velocity", fmt::format("{:.3g} m/s", intensity.pgv), of);
  fact("Peak displacement", fmt::format("{:.3g} m", intensity.pgd), of);
  fact("Strong-motion duration", fmt::format("{:.3g} s", intensity.significant_duration()), "5 % to 95 % of the Arias intensity");
  if (shown.fit)
    fact("Fit", fmt::format("{:.2g} %", 100 * shown.fit->mean_error),
         fmt::format("mean error; smallest ratio {:.1f} % of the target", 100 * shown.fit->least_ratio));
  json.end_array();
}

/// "NAME: what was done." whether the text ends with a full stop or not.
std::string sentence(const std::string& name, const std::string& text) {
  return fmt::format("{}: {}{}", name, text, text.ends_with('.') ? "" : ".");
}

void write_head(JsonWriter& json, const MotionReport& report) {
  const Provenance& from = report.from;
  json.member("format", "uplift-report-2").member("title", from.title).member("subtitle", from.subtitle).member("version", from.version);
  json.member("created", from.created).member("command", from.command);
  json.key("case").begin_object().member("file", from.case_file).member("sha256", from.case_hash).member("resolved", from.resolved);
  json.end_object().key("verdict").begin_object().member("level", "motion").member("headline", from.subtitle);
  write_facts(json, report);
  std::vector<std::string> paragraphs;
  for (const ShownMotion& shown : report.motions) {
    for (const std::string& text : shown.now.repairs) paragraphs.push_back(sentence("Repaired in " + shown.now.name, text));
    for (const std::string& text : shown.now.processing) paragraphs.push_back(sentence(shown.now.name, text));
  }
  json.key("paragraphs").texts(paragraphs).end_object();
  json.key("choices").begin_array().end_array();
}

bool any_fit(const MotionReport& report) {
  return std::ranges::any_of(report.motions, [](const ShownMotion& shown) { return shown.fit.has_value(); });
}

void write_tables(JsonWriter& json, const MotionReport& report) {
  const Histories histories = histories_of(report);
  json.key("tables").begin_array();
  write_motion_numbers(json, histories, "After processing.");
  if (any_fit(report)) write_fits(json, report);
  if (report.motions.size() > 1) write_correlation_table(json, report);
  write_motion_origins(json, histories);
  json.end_array();
}

}  // namespace

std::optional<double> correlation_of(const Motion& first, const Motion& second) {
  if (!side_by_side(first, second)) return std::nullopt;
  return correlation(converted(first, MotionKind::acceleration).values, converted(second, MotionKind::acceleration).values);
}

std::string motion_report_json(const MotionReport& report) {
  JsonWriter json(6);
  json.begin_object();
  write_head(json, report);
  write_tables(json, report);

  json.key("sections").begin_array();
  const auto section = [&](const std::string& id, const std::string& title) {
    json.begin_object().member("id", id).member("title", title).member("text", "").end_object();
  };
  if (report.motions.size() > 1) section("together", "Comparison");
  for (std::size_t i = 0; i < report.motions.size(); ++i) section(fmt::format("motion_{}", i + 1), report.motions[i].now.name);
  json.end_array().key("charts").begin_array();
  const auto write = [&](const Chart& chart) { write_chart(json, chart, origin); };
  if (report.motions.size() > 1) write(together_chart(report));
  for (std::size_t i = 0; i < report.motions.size(); ++i) {
    const ShownMotion& shown = report.motions[i];
    write(history_chart(shown, i + 1, MotionKind::acceleration));
    if (shown.fit) write(fit_chart(*shown.fit, i + 1));
    write(spectrum_chart(shown, i + 1, report));
    write(history_chart(shown, i + 1, MotionKind::velocity));
    write(history_chart(shown, i + 1, MotionKind::displacement));
  }
  json.end_array().key("model").null().key("animations").begin_array().end_array();
  json.end_object();
  return json.take();
}

namespace {

void write_summary(ResultWriter& out, const MotionReport& report) {
  out.text("version", report.from.version, "version of the program");
  out.text("created", report.from.created, "date and time, UTC");
  out.text("command", report.from.command, "command that was run");
  write_motions(out, histories_of(report));
  out.list("intensities", "intensities of the motions after processing", report.motions, [&](const ShownMotion& shown) {
    const Intensity i = out.is_schema() ? Intensity() : intensity_of(converted(shown.now, MotionKind::acceleration));
    out.text("name", shown.now.name, "name of the motion");
    out.number("pga", i.pga, "m/s2", "peak ground acceleration");
    out.number("pgv", i.pgv, "m/s", "peak ground velocity");
    out.number("pgd", i.pgd, "m", "peak ground displacement");
    out.number("arias", i.arias, "m/s", "Arias intensity");
    out.number("cav", i.cav, "m/s", "cumulative absolute velocity");
    out.number("significant_duration", i.significant_duration(), "s", "time from 5 % to 95 % of the Arias intensity");
    out.number("housner", i.housner, "m",
               "Housner intensity: integral of the pseudo-velocity with 5 % damping over periods from 0.1 s to 2.5 s");
  });
  struct Fit {
    std::string name;
    SpectrumFit fit{.damping = 0, .frequencies = {0}, .target = {}, .reached = {}};
  };
  std::vector<Fit> fits;
  for (const ShownMotion& shown : report.motions)
    if (shown.fit) fits.push_back({shown.now.name, *shown.fit});
  out.list("fits", "fits of generated motions to their target spectra", fits, [&](const Fit& each) {
    const SpectrumFit& fit = each.fit;
    out.text("name", each.name, "name of the motion");
    out.flag("good", fit.good(), "whether the mean error is at most 5 % and no ratio is below 90 %");
    out.number("damping", fit.damping, "1", "damping ratio of the spectra");
    out.number("from", fit.frequencies.front(), "Hz", "lower limit of the frequency band");
    out.number("to", fit.frequencies.back(), "Hz", "upper limit of the frequency band");
    out.number("mean_error", fit.mean_error, "1", "mean of |ratio - 1|, the ratio being that of the motion's spectrum to the target");
    out.number("least_ratio", fit.least_ratio, "1", "smallest ratio");
    out.number("mean_ratio", fit.mean_ratio, "1", "mean ratio");
    out.number("largest_error", fit.largest_error, "1", "largest of |ratio - 1|");
  });
  out.list("correlations", "correlations of motions of equal step and length", correlations_of(report), [&](const Correlation& each) {
    out.text("first", each.first, "name of a motion");
    out.text("second", each.second, "name of another motion");
    out.number("correlation", each.value, "1", "correlation coefficient of their accelerations at equal times");
  });
}

}  // namespace

std::string motion_summary_json(const MotionReport& report) {
  JsonWriter json(0, 2);
  json.begin_object();
  ResultWriter out(json);
  write_summary(out, report);
  json.end_object();
  return json.take();
}

std::string motion_summary_schema() {
  ResultWriter out("summary.json of uplift motion",
                   "Results of `uplift motion`. Numbers are in SI units; the keyword `unit` states the unit of each.");
  write_summary(out, {});
  return out.schema();
}

}  // namespace uplift
