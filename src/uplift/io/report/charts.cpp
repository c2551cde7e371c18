#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "uplift/case/schema/case_input.h"
#include "uplift/io/report/motions.h"
#include "uplift/io/results/histories.h"

// The figures: histories of all runs, side by side; hysteresis; energy.
namespace uplift {
namespace {

using Column = Request::Kind;

/// What a figure shows of every run: a column over time, or two columns against each other.
struct View {
  std::string id;
  const char* section;
  std::string title, caption;
  const char *label, *unit;
  Column kind;
  int of;         // full unknown or interface
  double factor;  // multiplies the column
};

Curve curve_of(const ReportRun& run) {
  Curve curve;
  curve.label = run.result->label + (run.say_group ? ", " + run.result->group : "");
  curve.run = run.result->label;  // not the name: a variant has one colour, whatever its damping
  curve.dash = run.spec->bonded;
  curve.failed = run.result->status == RunStatus::failed;
  return curve;
}

void keep_finite(Curve& curve) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i])) {
      curve.x[kept] = curve.x[i];
      curve.y[kept++] = curve.y[i];
    }
  curve.x.resize(kept);
  curve.y.resize(kept);
}

/// Appends the history of a column when the run recorded it.
void add_history(Chart& chart, const ReportRun& run, Column kind, int of, double factor) {
  const std::vector<double>* column = find_column(*run.result, kind, of);
  if (!column) return;
  Curve curve = curve_of(run);
  thin_history(run.result->table.front(), *column, points_per_curve, curve.x, curve.y);
  for (double& value : curve.y) value *= factor;
  if (!curve.x.empty()) chart.curves.push_back(std::move(curve));
}

std::vector<View> motion_views(const BuiltCase& built);
std::vector<View> interface_views(const BuiltCase& built);

/// The same view of a run of another case, whose unknowns have other numbers; null: it has none.
std::optional<View> view_of(const View& view, const ReportRun& run) {
  if (run.spec->other_case.empty()) return view;
  for (const auto& views : {motion_views(*run.built), interface_views(*run.built)})
    for (const View& each : views)
      if (each.id == view.id) return each;
  return std::nullopt;
}

Chart history_chart(const View& view, const std::vector<ReportRun>& runs) {
  const Axis along = statics_alone(runs.front().built->plan) ? Axis{"Load factor", "1"} : Axis{"Time", "s"};
  Chart chart{view.id, view.section, view.title, view.caption, along, {view.label, view.unit}, {}};
  const bool gap = view.kind == Column::uplifted_ratio || view.kind == Column::max_opening;
  for (const ReportRun& run : runs)
    if (!gap || !run.spec->bonded)  // a bonded base stretches instead of opening
      if (const std::optional<View> mine = view_of(view, run)) add_history(chart, run, mine->kind, mine->of, mine->factor);
  return chart;
}

/// What the computation created (positive) or lost, relative to the energy put in.
Chart energy_error_chart(const char* id, const char* section, const std::string& title, const std::vector<ReportRun>& runs) {
  Chart chart{id,
              section,
              title,
              "Residual of the energy balance divided by the largest external work. It should be zero; a positive value means that the "
              "computation created energy.",
              {"Time", "s"},
              {"Energy error", "1"},
              {}};
  for (const ReportRun& run : runs)
    if (run.result->energy_scale > 0) add_history(chart, run, Column::residual, 0, 1 / run.result->energy_scale);
  return chart;
}

Chart ledger_chart(const ReportRun& run) {
  Chart chart{"energy_ledger",
              "energy",
              "Energy ledger: " + run.result->label,
              "Terms of the energy balance over time. The residual should be zero.",
              {"Time", "s"},
              {"Energy", "J"},
              {}};
  struct Term {
    Column kind;
    const char* label;
  };
  for (const Term& term :
       {Term{Column::external, "external work"}, Term{Column::kinetic, "kinetic"}, Term{Column::strain, "strain"},
        Term{Column::stored, "stored in the interface"}, Term{Column::interface_dissipated, "dissipated by the interface"},
        Term{Column::plastic, "dissipated by yielding solids"}, Term{Column::damping, "damping"}, Term{Column::impact, "impacts"},
        Term{Column::stop, "taken by static stages"}, Term{Column::algorithmic, "dissipated by the time scheme"},
        Term{Column::filter, "stored in the filters of the scheme"}, Term{Column::residual, "residual"}}) {
    add_history(chart, run, term.kind, 0, 1);
    if (!chart.curves.empty() && chart.curves.back().label == run.result->label) {
      chart.curves.back().label = term.label;
      chart.curves.back().run.clear();
      chart.curves.back().dash = term.kind == Column::residual;
    }
  }
  return chart;
}

/// The loads of the case over time: the sum of the forces of each, on a node or on faces.
Chart load_chart(const Case& read, const ReportRun& run) {
  Chart chart{"loads", "loads", "Loads", "Resultant force of each load on nodes and faces.", {"Time", "s"}, {"Force", "N"}, {}};
  const Model& model = run.built->model;
  const auto along = [&](int axis) {
    return axis == model.space.up() ? "vertical" : model.space.dimension == 2 ? "horizontal" : axis == 0 ? "along x" : "along y";
  };
  const double end = std::max(run.result->end_time, 1e-9);
  const auto sample = [&](const std::string& label, double amplitude, const TimeFunction& function) {
    Curve curve;
    curve.label = label;
    for (int i = 0; i <= 6000; ++i) {
      curve.x.push_back(end * i / 6000);
      curve.y.push_back(amplitude * function.value(curve.x.back()));
    }
    thin_history(curve.x, curve.y, points_per_curve);
    chart.curves.push_back(std::move(curve));
  };
  std::size_t next = 0;  // time loads stand in the order of the loads of the case; names may come twice
  const DrawnParts parts = drawn_parts(read, *run.built);
  for (const DrawnParts::Load& load : parts.loads) {
    std::size_t at = next;
    while (at < model.time_loads.size() && model.time_loads[at].name != load.name) ++at;
    if (at == model.time_loads.size()) continue;
    next = at + 1;
    const Vector pattern(model.assembly.loads[at]);
    for (int axis = 0; axis < model.space.dimension; ++axis) {
      double sum = 0;
      for (Index i = axis; i < pattern.size(); i += model.space.unknowns()) sum += pattern[i];
      if (std::abs(sum) > 1e-12 * pattern.lpNorm<1>())
        sample(fmt::format("{}, {}", load.name, along(axis)), sum, *model.time_loads[at].function);
    }
  }
  return chart;
}

/// Which rotation is meant.
std::string about(const BuiltCase& built) {
  if (built.model.space.dimension == 2) return "Counter-clockwise positive.";
  return fmt::format("About the {} axis, right-handed.", built.sway == ux ? "y" : "x");
}

/// Sign of the base moment of a horizontal force at the top that acts in the positive direction: its lever arm points upwards, and the
/// axis of the moment is z in the plane, y for a sway along x, x for a sway along y.
double sign_of_moment(const BuiltCase& built) {
  return built.model.space.dimension == 3 && built.sway == ux ? 1 : -1;
}

/// Motion of the top and of the base for some runs, in the order of the paper's figures 5 and 6.
std::vector<View> motion_views(const BuiltCase& built) {
  std::vector<View> views;
  if (built.top >= 0 && built.top_arm.isZero(0)) {  // a centre of mass has no column
    const std::string along = built.model.space.dimension == 2 ? "." : fmt::format(" along {}.", built.sway == ux ? "x" : "y");
    const std::string node = "node " + built.model.nodes[static_cast<std::size_t>(built.top)].name;
    views.push_back({"top_displacement", "response", "Displacement of the top", "Horizontal displacement of " + node + along,
                     "Displacement", "m", Column::displacement, built.top_sway(), 1});
    views.push_back({"top_velocity", "response", "Velocity of the top", "Horizontal velocity of " + node + along, "Velocity", "m/s",
                     Column::velocity, built.top_sway(), 1});
  }
  if (built.base >= 0) {
    const auto title = [&](std::string_view of_the_base) { return title_of(of_the_base, built, 0); };  // `base` is a node of the first one
    views.push_back({"base_displacement", "response", title("Displacement of the base"), "Vertical displacement of the base.",
                     "Displacement", "m", Column::displacement, built.base_lift(), 1});
    views.push_back({"base_velocity", "response", title("Velocity of the base"), "Vertical velocity of the base.", "Velocity", "m/s",
                     Column::velocity, built.base_lift(), 1});
    views.push_back({"base_rotation", "response", title("Rotation of the base"), about(built), "Rotation", "rad", Column::displacement,
                     built.base_turn(), 1});
  }
  return views;
}

std::vector<View> views_of_one_interface(const BuiltCase& built) {
  return {
      {"base_moment", "interface", "Base moment", "Moment of the interface about its centre. " + about(built), "Moment", "N m",
       built.base_moment(), 0, 1},
      {"base_axial", "interface", "Vertical force of the base", "Compression is negative.", "Force", "N", Column::axial, 0, 1},
      {"base_shear", "interface", "Base shear", "Shear force in the interface.", "Force", "N", Column::shear, 0, 1},
      {"uplifted_ratio", "interface", "Uplifted area of the base", "Share of the area with a gap.", "Uplifted share", "1",
       Column::uplifted_ratio, 0, 1},
      {"max_opening", "interface", "Largest gap", "Largest opening of the interface, up to its edges.", "Gap", "m", Column::max_opening, 0,
       1},
      {"max_pressure", "interface", "Largest pressure", "Largest pressure of all points; with the path average the mean over each step.",
       "Pressure", "Pa", Column::max_pressure, 0, 1},
      {"bearing_utilisation", "interface", "Utilisation of bearing capacity",
       "Vertical force over the bearing capacity under the shear and the moment of the same time. The ground yields at 1. At the end of "
       "each step.",
       "Utilisation", "1", Column::bearing_utilisation, 0, 1},
      {"bearing_capacity", "interface", "Bearing capacity",
       "Vertical load that the ground bears without shear and moment. It grows with the permanent settlement.", "Capacity", "N",
       Column::bearing_capacity, 0, 1},
      {"sliding_utilisation", "interface", "Utilisation of sliding resistance",
       "Shear over the resistance of friction and cohesion. The footing slides at 1. At the end of each step.", "Utilisation", "1",
       Column::sliding_utilisation, 0, 1}};
}

std::vector<View> interface_views(const BuiltCase& built) {
  std::vector<View> views;
  for (std::size_t k = 0; k < bases_shown(built); ++k)
    for (View& view : views_of_one_interface(built)) {
      view.id = id_of(view.id, k);
      view.title = title_of(view.title, built, k);
      view.of = static_cast<int>(k);
      views.push_back(std::move(view));
    }
  return views;
}

/// Height of the top above the base [m]; 0 without them, where the top is no node, and on several bases, whose moments are not those of the
/// whole structure.
double height_of_top(const BuiltCase& built) {
  if (built.top < 0 || !built.top_arm.isZero(0) || built.base < 0 || built.model.interfaces.empty() || built.bases() > 1) return 0;
  const int up = built.model.space.up();
  return built.model.nodes[static_cast<std::size_t>(built.top)].position[up] - built.model.interfaces.front().reference[up];
}

Chart force_displacement_chart(const std::vector<ReportRun>& runs, double height) {
  Chart chart{"force_displacement",
              "response",
              "Force against displacement",
              fmt::format("Equivalent horizontal force at the top, positive in the direction of positive displacement: base "
                          "moment divided by the height of {:g} m.",
                          height),
              {"Displacement of the top", "m"},
              {"Equivalent force", "N"},
              {}};
  for (const ReportRun& run : runs)
    if (const double own = height_of_top(*run.built); own > 0)
      add_loop(chart, run, {Column::displacement, run.built->top_sway()}, {run.built->base_moment(), 0, sign_of_moment(*run.built) / own});
  return chart;
}

void write_loops(JsonWriter& json, const ReportInput& input, const std::vector<ReportRun>& runs) {
  const BuiltCase& built = *input.runs.front().built;
  if (built.model.interfaces.empty()) return;
  if (const double height = height_of_top(built); height > 0) write_chart(json, force_displacement_chart(runs, height));
  for (std::size_t k = 0; k < bases_shown(built); ++k) {
    Chart tilts{id_of("moment_tilt", k),
                "interface",
                title_of("Moment against tilt", built, k),
                "Base moment against the tilt of the base, which contains the deformation of the ground under it.",
                {"Tilt", "rad"},
                {"Moment", "N m"},
                {}};
    Chart rotations{id_of("moment_rotation", k),
                    "interface",
                    title_of("Moment against rotation", built, k),
                    "Base moment against the rotation of the interface.",
                    {"Rotation", "rad"},
                    {"Moment", "N m"},
                    {}};
    const int number = static_cast<int>(k);
    for (const ReportRun& run : runs) {
      if (k > 0 && run.built->bases() <= k) continue;  // of another case
      add_loop(tilts, run, {run.built->base_tilt(), number}, {run.built->base_moment(), number});
      add_loop(rotations, run, {run.built->base_rotation(), number}, {run.built->base_moment(), number});
    }
    write_chart(json, tilts);
    if (!built.model.interfaces[k].footprint) write_chart(json, rotations);
  }
  for (std::size_t k = 0; k < built.model.interfaces.size(); ++k)
    for (const Chart& chart : foundation_charts(runs, k)) write_chart(json, chart);
}

/// Of all rows; empty where a column is not recorded.
std::vector<double> values_of(const ReportRun& run, const LoopAxis& axis) {
  const std::vector<double>* column = find_column(*run.result, axis.column, axis.of);
  const std::vector<double>* other = axis.other_factor != 0 ? find_column(*run.result, axis.other, axis.of) : column;
  if (!column || !other) return {};
  std::vector<double> values;
  for (std::size_t i = 0; i < column->size(); ++i) values.push_back(axis.factor * (*column)[i] + axis.other_factor * (*other)[i]);
  return values;
}

}  // namespace

std::string title_of(std::string_view title, const BuiltCase& built, std::size_t number) {
  if (built.bases() < 2) return std::string(title);
  return fmt::format("{}{}{}", title, title.ends_with("the base") ? " " : " of ", built.facts[number].name);
}

std::size_t bases_shown(const BuiltCase& built) {
  constexpr std::size_t most = 4;
  return std::clamp<std::size_t>(built.bases(), 1, most);
}

std::string id_of(std::string_view id, std::size_t base) {
  return base == 0 ? std::string(id) : fmt::format("{}_{}", id, base + 1);
}

void add_loop(Chart& chart, const ReportRun& run, const LoopAxis& x, const LoopAxis& y) {
  const std::vector<double> along = values_of(run, x), up = values_of(run, y);
  if (along.empty() || up.empty()) return;
  Curve curve = curve_of(run);
  const std::size_t stride = std::max<std::size_t>(1, along.size() / (2 * points_per_curve));
  for (std::size_t i = 0; i < along.size(); i += stride) {
    curve.x.push_back(along[i]);
    curve.y.push_back(up[i]);
  }
  keep_finite(curve);
  if (!curve.x.empty()) chart.curves.push_back(std::move(curve));
}

Chart loop_chart(Chart chart, const std::vector<ReportRun>& runs, const LoopAxis& x, const LoopAxis& y) {
  for (const ReportRun& run : runs) add_loop(chart, run, x, y);
  return chart;
}

void write_chart(JsonWriter& json, const Chart& chart, std::string_view origin) {
  if (chart.curves.empty()) return;
  const auto axis = [&](const char* key, const Axis& each) {
    json.key(key).begin_object().member("label", each.label).member("unit", each.unit).member("log", each.log).end_object();
  };
  json.begin_object().member("id", chart.id).member("section", chart.section).member("title", chart.title).member("caption", chart.caption);
  if (!origin.empty()) json.member("origin", origin);
  axis("x", chart.x);
  axis("y", chart.y);
  json.key("series").begin_array();
  for (const Curve& curve : chart.curves) {
    json.begin_object().member("label", curve.label);
    if (!curve.run.empty()) json.member("run", curve.run);
    json.key("x").numbers(curve.x).key("y").numbers(curve.y);
    if (curve.dash) json.member("dash", true);
    if (curve.failed) json.member("failed", true);
    json.end_object();
  }
  json.end_array().end_object();
}

void write_figures(JsonWriter& json, const Case& read) {
  json.begin_object();
  for (const CaseFigure& figure : read.input->figures) {
    json.key(figure.chart).begin_object().member("origin", figure.origin);
    if (figure.caption) json.member("caption", *figure.caption);
    json.end_object();
  }
  json.end_object();
}

void write_charts(JsonWriter& json, const ReportInput& input) {
  const BuiltCase& built = *input.runs.front().built;
  std::vector<ReportRun> runs, others;  // the group of the first run, and the rest
  for (const ReportRun& run : input.runs) (run.result->group == input.runs.front().result->group ? runs : others).push_back(run);
  std::string other = others.empty() ? "" : others.front().result->group;
  if (std::ranges::any_of(others, [&](const ReportRun& run) { return run.result->group != other; })) {
    for (ReportRun& run : others) run.say_group = true;
    other = "all others";
  }
  json.begin_array();
  if (statics_alone(built.plan)) {  // nothing over time
    for (const View& view : motion_views(built))
      if (view.kind != Column::velocity) write_chart(json, history_chart(view, runs));
    for (const View& view : interface_views(built)) write_chart(json, history_chart(view, runs));
    write_loops(json, input, runs);
    for (const Chart& chart : rest_charts(input.runs.front())) write_chart(json, chart);
    write_chart(json, law_chart(input.runs.front()));
    json.end_array();
    return;
  }
  write_chart(json, load_chart(*input.read, input.runs.front()));
  write_motion_charts(json, input);
  for (const View& view : motion_views(built)) write_chart(json, history_chart(view, runs));
  for (const View& view : interface_views(built)) write_chart(json, history_chart(view, runs));
  for (const Chart& chart : safety_charts(runs)) write_chart(json, chart);
  for (const Chart& chart : rest_charts(runs.front())) write_chart(json, chart);
  write_loops(json, input, runs);
  write_floor_charts(json, input);
  if (!others.empty()) {
    std::vector<View> views = motion_views(built);
    for (View& view : views) {
      const std::string id = std::string("other_") + view.id, title = fmt::format("{}, {}", view.title, other);
      if (view.kind == Column::velocity && view.of != built.top_sway()) continue;
      view.section = "others";
      Chart chart = history_chart(view, others);
      chart.id = id;
      chart.title = title;
      write_chart(json, chart);
    }
    write_chart(json, energy_error_chart("other_energy_error", "others", "Energy error, " + other, others));
  }
  write_chart(json, energy_error_chart("energy_error", "energy", "Energy error", runs));
  write_chart(json, ledger_chart(input.runs.front()));
  write_chart(json, law_chart(input.runs.front()));
  json.end_array();
}

}  // namespace uplift
