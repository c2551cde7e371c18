#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/base/format.h"
#include "uplift/io/report/parts.h"
#include "uplift/io/results/verdict_json.h"

// The first page: what the verdict says in numbers, beside the bonded run, against the user's limits, and what is left after the shock.
namespace uplift {
namespace {

constexpr double highest_safety = 10;  // safeties are drawn up to here
constexpr std::size_t points_of_history = 400, points_per_curve = 1500;

struct Row {
  const char *name, *label;
};
constexpr Row forces[] = {{"max_shear", "Base shear"},
                          {"max_moment", "Base moment"},
                          {"max_compression", "Largest compression"},
                          {"min_compression", "Least compression"},
                          {"max_toe_pressure", "Toe pressure"},
                          {"toe_pressure_ratio", "Toe pressure over static mean"},
                          {"max_eccentricity", "Eccentricity e/B"},
                          {"min_overturning_safety", "Safety against overturning"},
                          {"min_sliding_safety", "Safety against sliding"}};
constexpr Row of_walls[] = {{"max_opening", "Largest gap"},
                            {"max_slip", "Largest slip"},
                            {"max_toe_pressure", "Largest pressure"},
                            {"share_of_horizontal_force", "Share of the horizontal force"},
                            {"share_of_base_moment", "Share of the base moment"}};
constexpr Row of_run[] = {{"max_top_motion", "Motion of the top"},
                          {"max_drift", "Drift of the top"},
                          {"max_drift_without_rotation", "Drift without base rotation"},
                          {"max_total_shear", "Horizontal force, base and walls"},
                          {"max_total_moment", "Moment, base and walls"}};
constexpr Row of_beams[] = {{"max_beam_moment", "Moment of "},
                            {"max_beam_shear", "Shear of "},
                            {"max_beam_compression", "Compression of "},
                            {"max_beam_tension", "Tension of "}};
constexpr Row residuals[] = {{"residual_rotation", "Rotation"},
                             {"residual_settlement", "Settlement"},
                             {"residual_slip", "Slip"},
                             {"residual_opening", "Largest gap"},
                             {"residual_uplifted_ratio", "Uplifted area"}};

/// Values with the texts that stand for them on the page: rounded once, by the program.
void write_number(JsonWriter& json, const std::string& label, const VerdictNumber& number) {
  json.begin_object().member("label", label).member("value", number.value).member("unit", number.quantity->unit);
  json.member("text", text_of(number));
  if (number.coarse) json.member("stepText", format_step_change(number));
  if (number.bonded) json.member("bondedText", format_value(*number.quantity, *number.bonded));
  if (number.bonded) json.member("changeText", number.change ? format_change(*number.change) : "no excitation in this direction");
  if (const std::string swing = swing_text(number); !swing.empty()) json.member("swingText", swing);
  if (number.time) json.member("time", *number.time);
  if (number.bonded) json.member("bonded", *number.bonded);
  if (number.swing) json.member("swing", *number.swing);
  json.end_object();
}

template <class Rows>
void write_rows(JsonWriter& json, const Rows& rows, const std::vector<VerdictNumber>& numbers, bool strip = false) {
  for (const Row& row : rows)
    if (const VerdictNumber* number = find_number(numbers, row.name)) {
      const bool force = number->quantity->unit == "N" || number->quantity->unit == "N m";
      write_number(json, std::string(row.label) + (strip && force ? " per metre" : ""), *number);
    }
}

void write_tension(JsonWriter& json, const InterfaceVerdict& said) {
  const VerdictNumber *pulls = find_number(said.numbers, "linear_tension_ratio"),
                      *uplift = find_number(said.numbers, "predicted_uplifted_ratio"),
                      *happened = find_number(said.numbers, "max_uplifted_ratio");
  if (!pulls || !happened) return;
  json.key("linear").begin_object().member("tension", pulls->value).member("tensionText", text_of(*pulls));
  if (uplift) json.member("predictedText", text_of(*uplift));
  json.member("computedText", text_of(*happened)).key("predicted");
  if (uplift)
    json.value(uplift->value);
  else
    json.null();
  json.member("computed", happened->value).end_object();
}

void write_interface(JsonWriter& json, const ReportInput& input, std::size_t k) {
  const VerdictNumbers& numbers = input.verdict->numbers;
  const InterfaceVerdict& said = numbers.interfaces[k];
  const ReportRun& run = input.runs.front();
  if (statics_alone(run.built->plan)) {  // its facts say all
    json.begin_object().member("name", said.name).member("role", to_string(said.role));
    for (const char* key : {"time", "share", "above", "lost", "beside", "rest"}) json.key(key).begin_array().end_array();
    json.end_object();
    return;
  }
  if (said.role == Role::wall) {
    json.begin_object().member("name", said.name).member("role", to_string(said.role));
    for (const char* key : {"time", "share", "above", "lost", "rest"}) json.key(key).begin_array().end_array();
    json.key("beside").begin_array();
    write_rows(json, of_walls, said.numbers);
    json.end_array().end_object();
    return;
  }
  std::vector<double> time = run.result->steps.time, share = base_history(*run.built, *run.result, k, BaseHistory::uplifted_ratio);
  thin_history(time, share, points_of_history);
  json.begin_object().member("name", said.name).member("role", to_string(said.role));
  json.key("time").numbers(time).key("share").numbers(share);
  json.key("above").begin_array();
  for (const InterfaceVerdict::Above& above : said.above)
    json.begin_object()
        .member("threshold", above.threshold)
        .member("duration", above.duration)
        .member("text", fmt::format("above {} for {}", percent(above.threshold), format_quantity(above.duration, "s")))
        .end_object();
  json.end_array().key("lost").begin_array();
  for (const Interval& interval : said.full_loss) json.numbers(std::vector<double>{interval.from, interval.to});
  json.end_array();
  if (const VerdictNumber* lost = find_number(said.numbers, "full_loss_time"); lost && lost->value > 0)
    json.member("lostText",
                fmt::format("full loss of contact {}, {} in total",
                            said.full_loss.size() == 1 ? "once" : fmt::format("{} times", said.full_loss.size()), text_of(*lost)));
  json.key("beside").begin_array();
  const bool strip = run.built->is_strip();
  if (k == 0) write_rows(json, of_run, numbers.whole, strip);
  write_rows(json, forces, said.numbers, strip);
  if (k == 0)
    for (const BeamVerdict& beam : numbers.beams)
      for (const Row& row : of_beams)
        if (const VerdictNumber* number = find_number(beam.numbers, row.name);
            number && (number->value != 0 || number->bonded.value_or(0) != 0))
          write_number(json, row.label + beam.name, *number);
  json.end_array().key("rest").begin_array();
  write_rows(json, residuals, said.numbers);
  json.end_array();
  write_tension(json, said);
  json.end_object();
}

void write_criterion(JsonWriter& json, const CriterionResult& result) {
  const VerdictQuantity& quantity = *result.criterion.quantity;
  json.begin_object().member("label", quantity.meaning).member("interface", result.interface).member("state", to_string(result.state));
  const bool share = is_share(quantity);
  json.key("value");
  if (result.value)
    json.value(*result.value * (share ? 100 : 1));
  else
    json.null();
  json.member("valueText", result.value ? format_value(quantity, *result.value) : "not computed");
  json.member("limitText", format_value(quantity, result.criterion.limit));
  json.member("limit", result.criterion.limit * (share ? 100 : 1)).member("unit", share ? "%" : quantity.unit);
  json.member("atLeast", quantity.at_least);
  json.member("source", result.criterion.source).end_object();
}

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

/// One history of the first interface, for all runs that open.
Chart safety_chart(const char* id, const char* title, const char* caption, BaseHistory which, const std::vector<ReportRun>& runs) {
  const bool safety = which == BaseHistory::overturning_safety || which == BaseHistory::sliding_safety;
  Chart chart{id, "interface", title, caption, {"Time", "s"}, {safety ? "Safety" : "e/B", "1"}, {}};
  for (const ReportRun& run : runs) {
    if (run.spec->bonded || run.result->steps.size() == 0 || run.built->facts.empty()) continue;
    Curve curve;
    curve.label = curve.run = run.result->label;
    curve.failed = run.result->status == RunStatus::failed;
    const std::vector<double> history = base_history(*run.built, *run.result, 0, which);
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

void write_verdict(JsonWriter& json, const ReportInput& input) {
  const Verdict& verdict = *input.verdict;
  json.begin_object().member("level", to_string(verdict.level)).member("headline", verdict.headline);
  json.member("consequence", verdict.consequence);
  ResultWriter out(json);
  out.when(!statics_alone(input.runs.front().built->plan));
  write_step_check(out, "stepCheck", verdict.step_check);
  json.key("facts").begin_array();
  for (const Verdict::Fact& fact : verdict.facts)
    if (fact.tile) {
      json.begin_object().member("label", fact.label).member("value", fact.value).member("detail", fact.detail);
      if (!fact.step_change.empty()) json.member("stepChange", fact.step_change);
      json.end_object();
    }
  json.end_array();
  std::vector<std::string> paragraphs = verdict.paragraphs;
  for (const std::string& warning : input.warnings)
    paragraphs.push_back("Warning: " + warning + (warning.ends_with("?") || warning.ends_with(".") ? "" : "."));
  json.key("paragraphs").texts(paragraphs);
  json.member("run", input.runs.front().result->label);
  json.key("interfaces").begin_array();
  for (std::size_t k = 0; k < verdict.numbers.interfaces.size(); ++k) write_interface(json, input, k);
  json.end_array().key("criteria").begin_array();
  for (const CriterionResult& result : verdict.numbers.criteria) write_criterion(json, result);
  json.end_array();
  write_floor_changes(out, "floors", input.floors);
  json.end_object();
}

std::vector<Chart> rest_charts(const ReportRun& run) {
  const Model& model = run.built->model;
  const std::vector<Frame>& frames = run.result->frames;
  if (model.space.dimension == 3 || model.interfaces.empty() || frames.empty()) return {};
  const Interface& interface = model.interfaces.front();
  const Vec3 t = local_axis(model.space, mean_normal(interface), 0);
  std::vector<std::pair<double, int>> order;
  for (int i = 0; i < interface.batch.points; ++i)
    order.emplace_back(t.dot(interface.position[static_cast<std::size_t>(i)] - interface.reference), i);
  std::ranges::sort(order);
  const bool stands = statics_alone(run.built->plan);
  if (!stands && frames.size() < 2) return {};
  Vector widest = Vector::Zero(interface.batch.points);
  for (const Frame& frame : frames) widest = widest.cwiseMax(frame.opening.head(interface.batch.points));
  Chart gap = profile("rest_gap", "Gap along the base",
                      "At the end of the run, compared with the widest gap of each point in the frames of the animation.", "Gap", "m");
  Chart pressure = profile("rest_pressure", "Pressure along the base", "At the beginning and at the end of the run.", "Pressure", "Pa");
  if (stands) {
    gap.caption = pressure.caption = "Under the constant loads.";
    gap.curves = {along("gap", order, frames.back().opening.cwiseMax(0), false)};
    pressure.curves = {along("pressure", order, frames.back().pressure, false)};
    return {std::move(gap), std::move(pressure)};
  }
  gap.curves = {along("at the end", order, frames.back().opening.cwiseMax(0), false), along("widest", order, widest, true)};
  pressure.curves = {along("at the end", order, frames.back().pressure, false),
                     along("at the beginning", order, frames.front().pressure, true)};
  return {std::move(gap), std::move(pressure)};
}

std::vector<Chart> safety_charts(const std::vector<ReportRun>& runs) {
  const auto chart = [&](const char* id, const char* title, const char* caption, BaseHistory which) {
    return safety_chart(id, title, caption, which, runs);
  };
  return {
      chart("eccentricity", "Eccentricity of the thrust",
            "Place of the resultant pressure over the width of the base; at one half it stands on the edge.", BaseHistory::eccentricity_1),
      chart("overturning_safety", "Safety against overturning", "Stabilising over driving moment about the toe; drawn up to 10.",
            BaseHistory::overturning_safety),
      chart("sliding_safety", "Safety against sliding", "Friction and cohesion over base shear; drawn up to 10.",
            BaseHistory::sliding_safety)};
}

}  // namespace uplift
