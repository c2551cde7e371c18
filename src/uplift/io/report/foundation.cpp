#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "uplift/base/format.h"
#include "uplift/io/report/parts.h"
#include "uplift/laws/macro_element.h"

// Figures of a whole foundation: forces against each other and against the rotation, with the strength of the ground and the limits of
// uplift (docs/theory/macro_element.md).
namespace uplift {
namespace {

using Column = Request::Kind;
constexpr int points_per_side = 60;  // of a limit; with fewer than 40 the page marks them

/// One direction in which a foundation tilts: what is shown, and which plan length is concerned.
struct Tilt {
  LoopAxis rotation, moment;
  LoopAxis law_moment, law_shear;       // what the strength of the ground limits
  int axis;                             // of the macro-element: 0 along t1, 1 along t2
  const char *about = "", *along = "";  // in space
};

/// Columns of foundation k are along and about x and y, the limits belong to its own axes: t1 = c x + s y, t2 = c y - s x.
std::vector<Tilt> tilts_of(int k, const Interface& joint, bool radiates) {
  using enum Column;
  const auto pick = [&](Column all, Column law) { return radiates ? law : all; };
  if (joint.space.dimension == 2) return {{{rotation, k}, {moment, k}, {pick(moment, law_moment), k}, {pick(shear, law_shear), k}, 0}};
  const double azimuth = joint.footprint->azimuth, c = std::cos(azimuth), s = std::sin(azimuth);
  const auto first = [&](Column x, Column y) { return LoopAxis{x, k, c, y, s}; };
  const auto second = [&](Column x, Column y) { return LoopAxis{y, k, c, x, -s}; };
  const Column m1 = pick(moment_1, law_moment_1), m2 = pick(moment_2, law_moment_2);
  const Column h1 = pick(shear_1, law_shear_1), h2 = pick(shear_2, law_shear_2);
  const bool turned = azimuth != 0;
  const char *x = turned ? "the width" : "x", *y = turned ? "the length" : "y";
  return {{second(rotation_1, rotation_2), second(moment_1, moment_2), second(m1, m2), first(h1, h2), 0, y, x},
          {first(rotation_1, rotation_2), first(moment_1, moment_2), first(m1, m2), second(h1, h2), 1, x, y}};
}

/// The direction in which the model sways, or the one nearest to it.
int tilt_of_sway(const BuiltCase& built, const Interface& joint) {
  const double azimuth = joint.footprint->azimuth;
  const bool near_x = std::abs(std::cos(azimuth)) >= std::abs(std::sin(azimuth));
  return (built.sway == ux) == near_x ? 0 : 1;
}

/// Both signs of a limit y(N), for N from 0 to `most` [N].
Curve limit(std::string label, double most, bool dash, const std::function<double(double)>& y) {
  Curve curve;
  curve.label = std::move(label);
  curve.dash = dash;
  const auto add = [&](int i, double sign) {
    curve.x.push_back(most * i / points_per_side);
    curve.y.push_back(sign * y(curve.x.back()));
  };
  for (int i = points_per_side; i >= 0; --i) add(i, -1);
  for (int i = 0; i <= points_per_side; ++i) add(i, 1);
  return curve;
}

double largest_size(const std::vector<Curve>& curves, std::vector<double> Curve::*of) {
  double most = 0;
  for (const Curve& curve : curves)
    for (const double value : curve.*of) most = std::max(most, std::abs(value));
  return most;
}

/// Adds the bearing surface at the beginning and, where the ground has hardened, at the end.
void add_bearing(Chart& chart, const MacroSurfaces& surfaces, double capacity_at_end, const std::function<double(double, double)>& y) {
  if (!surfaces.has_bearing()) return;
  const auto add = [&](const char* when, double v, bool dash) {
    chart.curves.push_back(
        limit(fmt::format("bearing capacity{}, V = {}", when, format_quantity(v, "N")), v, dash, [&](double n) { return y(n, v); }));
  };
  const double service = surfaces.capacity(0);
  const bool hardened = capacity_at_end > service * (1 + 1e-6);
  add(hardened ? " at the beginning" : "", service, false);
  if (hardened) add(" at the end", capacity_at_end, true);
}

/// Adds a straight limit y = slope N + constant, up to a little beyond what else is drawn.
void add_line(Chart& chart, std::string label, double slope, double constant, double n, double height) {
  constexpr double margin = 1.1;
  const double most = slope > 0 ? std::clamp((margin * height - constant) / slope, 0.0, margin * n) : margin * n;
  chart.curves.push_back(limit(std::move(label), most, true, [&](double at) { return slope * at + constant; }));
}

void add_moment_limits(Chart& chart, const MacroElement& ground, int axis, double capacity_at_end) {
  const MacroSurfaces& surfaces = ground.surfaces();
  add_bearing(chart, surfaces, capacity_at_end, [&](double n, double v) { return surfaces.largest_moment(axis, n, v); });
  const double n = largest_size(chart.curves, &Curve::x), height = largest_size(chart.curves, &Curve::y);
  const MacroElasticity& elasticity = ground.elasticity();
  add_line(chart, "limit of uplift, N D/2", 0.5 * elasticity.length[axis], 0, n, height);
  add_line(chart, fmt::format("first uplift, N D/{:.3g}", elasticity.shape), elasticity.length[axis] / elasticity.shape, 0, n, height);
  if (surfaces.has_bearing()) chart.caption += " The bearing capacity is that without a horizontal force.";
}

void add_shear_limits(Chart& chart, const MacroSurfaces& surfaces, double capacity_at_end) {
  add_bearing(chart, surfaces, capacity_at_end, [&](double n, double v) { return surfaces.largest_shear(n, v); });
  const MacroStrength& strength = surfaces.strength();
  const double n = largest_size(chart.curves, &Curve::x), height = largest_size(chart.curves, &Curve::y);
  if (surfaces.has_sliding())
    add_line(chart, "sliding resistance", strength.friction, strength.cohesion, n, std::max(height, strength.cohesion));
  if (surfaces.has_bearing() || surfaces.has_sliding()) chart.caption += " The limits are those without a moment.";
}

}  // namespace

std::vector<Chart> foundation_charts(const std::vector<ReportRun>& runs, std::size_t interface) {
  const BuiltCase& built = *runs.front().built;
  const Interface& joint = built.model.interfaces[interface];
  if (!joint.footprint) return {};
  const MacroElement* ground = as_macro_element(joint.law.get());
  const StepRecord& steps = runs.front().result->steps;
  const double capacity = steps.extremes.empty() ? 0 : steps.extremes[interface].bearing_capacity;
  const bool space = joint.space.dimension == 3, radiates = !radiation_damping(*joint.footprint).empty();
  const char* part = radiates ? " These are the forces in its law, without those of the radiation dashpots." : "";
  const Column axial = radiates ? Column::law_axial : Column::axial;
  const int k = static_cast<int>(interface);
  const Axis vertical{"Vertical force, compression", "N"};
  std::vector<Chart> charts;
  for (const Tilt& tilt : tilts_of(k, joint, radiates)) {
    const bool main = interface == 0 && (!space || tilt_of_sway(built, joint) == tilt.axis);
    const std::string suffix = main ? "" : "_" + joint.name + (!space ? "" : tilt.axis == 0 ? "_x" : "_y");
    const std::string of = built.model.interfaces.size() > 1 ? ": " + joint.name : "";
    const std::string about = (space ? fmt::format(", about {}", tilt.about) : "") + of;
    const std::string along = (space ? fmt::format(", along {}", tilt.along) : "") + of;
    charts.push_back(loop_chart(
        {"moment_rotation" + suffix,
         "interface",
         "Moment against rotation" + about,
         std::string("Base moment against the rotation of the foundation.") + (radiates ? " It includes the radiation dashpots." : ""),
         {"Rotation", "rad"},
         {"Moment", "N m"},
         {}},
        runs, tilt.rotation, tilt.moment));
    Chart moment = loop_chart({"moment_vertical" + suffix,
                               "interface",
                               "Moment against vertical force" + about,
                               std::string("Base moment against the vertical force of the foundation.") + part,
                               vertical,
                               {"Moment", "N m"},
                               {}},
                              runs, {axial, k, -1}, tilt.law_moment);
    Chart shear = loop_chart({"shear_vertical" + suffix,
                              "interface",
                              "Horizontal force against vertical force" + along,
                              std::string("Base shear against the vertical force of the foundation.") + part,
                              vertical,
                              {"Horizontal force", "N"},
                              {}},
                             runs, {axial, k, -1}, tilt.law_shear);
    if (ground != nullptr && !moment.curves.empty()) add_moment_limits(moment, *ground, tilt.axis, capacity);
    if (ground != nullptr && !shear.curves.empty()) add_shear_limits(shear, ground->surfaces(), capacity);
    charts.push_back(std::move(moment));
    charts.push_back(std::move(shear));
  }
  return charts;
}

}  // namespace uplift
