#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/io/report/parts.h"
#include "uplift/verdict/base_over_time.h"

// The first page: sentences of the verdict and the uplifted share over time; its numbers are those of summary.json. Figures of the residual
// state and of the safeties.
namespace uplift {
namespace {

constexpr double highest_safety = 10;  // safeties are drawn up to here
constexpr std::size_t points_of_history = 400;

Chart profile(const char* id, const char* title, std::string caption, const char* label, const char* unit) {
  return {id, "rest", title, std::move(caption), {"Along the base", "m"}, {label, unit}, {}};
}

Curve along(const char* label, const std::vector<std::pair<double, int>>& order, const Vector& values, bool dash) {
  Curve curve;
  curve.label = label;
  curve.dash = dash;
  for (const auto& [x, point] : order) {
    curve.x.push_back(x);
    curve.y.push_back(values[point]);
  }
  return curve;
}

/// One history of a base, for all runs that open.
Chart safety_chart(const char* id, std::string title, const char* caption, BaseHistory which, std::size_t base,
                   const std::vector<ReportRun>& runs) {
  const bool safety = which == BaseHistory::overturning_safety || which == BaseHistory::sliding_safety;
  Chart chart{id_of(id, base), "interface", std::move(title), caption, {"Time", "s"}, {safety ? "Safety" : "e/B", "1"}, {}};
  for (const ReportRun& run : runs) {
    if (run.spec->bonded || run.result->steps.size() == 0 || run.built->facts.empty() || (base > 0 && run.built->bases() <= base)) continue;
    Curve curve;
    curve.label = curve.run = run.result->label;
    curve.failed = run.result->status == RunStatus::failed;
    const std::vector<double> history = base_history(*run.built, *run.result, base, which);
    for (std::size_t i = 0; i < history.size(); ++i)
      if (std::isfinite(history[i])) {
        curve.x.push_back(run.result->steps.time[i]);
        curve.y.push_back(safety ? std::min(history[i], highest_safety) : history[i]);
      }
    thin_history(curve.x, curve.y, points_per_curve);
    if (!curve.x.empty()) chart.curves.push_back(std::move(curve));
  }
  return chart;
}

}  // namespace

void write_sentences(JsonWriter& json, const ReportInput& input) {
  json.begin_object().key("facts").begin_array();
  for (const Verdict::Fact& fact : input.verdict->facts)
    if (fact.tile) {
      json.begin_object().member("label", fact.label).member("value", fact.value).member("detail", fact.detail);
      if (!fact.step_change.empty()) json.member("stepChange", fact.step_change);
      json.end_object();
    }
  json.end_array();
  std::vector<std::string> paragraphs = input.verdict->paragraphs;
  for (const std::string& warning : input.warnings)
    paragraphs.push_back("Warning: " + warning + (warning.ends_with("?") || warning.ends_with(".") ? "" : "."));
  json.key("paragraphs").texts(paragraphs).end_object();
}

void write_uplifted_shares(JsonWriter& json, const ReportInput& input) {
  const ReportRun& run = input.runs.front();
  json.begin_array();
  for (std::size_t k = 0; k < input.verdict->numbers.interfaces.size(); ++k) {
    std::vector<double> time, share;
    if (input.verdict->numbers.interfaces[k].role == Role::base && !statics_alone(run.built->plan)) {
      time = run.result->steps.time;
      share = base_history(*run.built, *run.result, k, BaseHistory::uplifted_ratio);
      thin_history(time, share, points_of_history);
    }
    json.begin_object().key("time").numbers(time).key("share").numbers(share).end_object();
  }
  json.end_array();
}

/// Gap and pressure along a base, whose points begin at `first` in the frames.
void add_rest_charts(const ReportRun& run, std::size_t number, Index first, std::vector<Chart>& charts) {
  const std::vector<Frame>& frames = run.result->frames;
  const Interface& interface = run.built->model.interfaces[number];
  const Index points = interface.batch.points;
  const Vec3 t = local_axis(run.built->model.space, mean_normal(interface), 0);
  std::vector<std::pair<double, int>> order;
  for (int i = 0; i < points; ++i) order.emplace_back(t.dot(interface.position[static_cast<std::size_t>(i)] - interface.reference), i);
  std::ranges::sort(order);
  const auto gaps = [&](const Frame& frame) { return Vector(frame.opening.segment(first, points)); };
  const auto pressures = [&](const Frame& frame) { return Vector(frame.pressure.segment(first, points)); };
  Chart gap = profile("rest_gap", "Gap along the base",
                      "At the end of the run, compared with the widest gap of each point in the frames of the animation.", "Gap", "m");
  Chart pressure = profile("rest_pressure", "Pressure along the base", "At the beginning and at the end of the run.", "Pressure", "Pa");
  for (Chart* each : {&gap, &pressure}) each->id = id_of(each->id, number), each->title = title_of(each->title, *run.built, number);
  if (statics_alone(run.built->plan)) {
    gap.caption = pressure.caption = "Under the constant loads.";
    gap.curves = {along("gap", order, gaps(frames.back()).cwiseMax(0), false)};
    pressure.curves = {along("pressure", order, pressures(frames.back()), false)};
  } else {
    Vector widest = Vector::Zero(points);
    for (const Frame& frame : frames) widest = widest.cwiseMax(gaps(frame));
    gap.curves = {along("at the end", order, gaps(frames.back()).cwiseMax(0), false), along("widest", order, widest, true)};
    pressure.curves = {along("at the end", order, pressures(frames.back()), false),
                       along("at the beginning", order, pressures(frames.front()), true)};
  }
  charts.push_back(std::move(gap));
  charts.push_back(std::move(pressure));
}

std::vector<Chart> rest_charts(const ReportRun& run) {
  const Model& model = run.built->model;
  const std::vector<Frame>& frames = run.result->frames;
  const bool stands = statics_alone(run.built->plan);
  if (model.space.dimension == 3 || model.interfaces.empty() || frames.empty() || (!stands && frames.size() < 2)) return {};
  std::vector<Chart> charts;
  Index first = 0;  // of its points
  for (std::size_t k = 0; k < bases_shown(*run.built); ++k) {
    const Interface& interface = model.interfaces[k];
    const Index points = interface.batch.points;
    if (!interface.footprint) add_rest_charts(run, k, first, charts);  // one point has no profile
    first += points;
  }
  return charts;
}

std::vector<Chart> safety_charts(const std::vector<ReportRun>& runs) {
  std::vector<Chart> charts;
  if (runs.empty()) return charts;
  const BuiltCase& built = *runs.front().built;
  for (std::size_t k = 0; k < bases_shown(built); ++k) {
    const auto add = [&](const char* id, const char* title, const char* caption, BaseHistory which) {
      charts.push_back(safety_chart(id, title_of(title, built, k), caption, which, k, runs));
    };
    add("eccentricity", "Eccentricity of the resultant",
        "Position of the resultant, divided by the width of the base; at 0.5 the base stands on its edge.", BaseHistory::eccentricity_1);
    add("overturning_safety", "Safety against overturning", "Stabilising over driving moment about the toe; drawn up to 10.",
        BaseHistory::overturning_safety);
    add("sliding_safety", "Safety against sliding", "Friction and cohesion over base shear; drawn up to 10.", BaseHistory::sliding_safety);
  }
  return charts;
}

}  // namespace uplift
