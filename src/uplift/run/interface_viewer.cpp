#include "uplift/run/interface_viewer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/math/small.h"

namespace uplift {

namespace {

/// Weights whose sums with the openings are the slopes of their best plane, c + theta . (arm x n), for arms in the axes of the mean normal.
std::array<Vector, 2> slope_weights(const Interface& interface) {
  const Vec3 normal = mean_normal(interface);
  const int points = interface.batch.points, slopes = interface.space.dimension - 1;
  Matrix shape(points, slopes);  // opening per slope
  for (int i = 0; i < points; ++i) {
    const Vec3 arm = interface.position[static_cast<std::size_t>(i)] - interface.reference;
    for (int k = 0; k < slopes; ++k) {
      const Vec3 axis = slopes == 1 ? Vec3(Vec3::UnitZ()) : local_axis(interface.space, normal, k);
      shape(i, k) = cross(axis, arm).dot(normal);
    }
  }
  const Vector mean = shape.transpose() * interface.area / interface.area.sum();
  shape.rowwise() -= mean.transpose();
  const Matrix inertia = shape.transpose() * interface.area.asDiagonal() * shape;
  Matrix inverse = Matrix::Zero(slopes, slopes);
  const double det = slopes == 1 ? inertia(0, 0) : inertia(0, 0) * inertia(1, 1) - inertia(0, 1) * inertia(1, 0);
  const double size = inertia.trace();
  if (slopes == 1 && size > 0) inverse(0, 0) = 1 / inertia(0, 0);
  if (slopes == 2 && det > 1e-12 * size * size)
    inverse << inertia(1, 1) / det, -inertia(0, 1) / det, -inertia(1, 0) / det, inertia(0, 0) / det;
  const Matrix weights = interface.area.asDiagonal() * shape * inverse;
  std::array<Vector, 2> made;
  for (int k = 0; k < slopes; ++k) made[static_cast<std::size_t>(k)] = weights.col(k);
  return made;
}

constexpr double whole = 1 - 1e-12;  // share of an area: all of it but for round-off
constexpr double much_softer = 10;   // what lies under a joint than the joint, before its openings count as bent

/// Of the closed joint, in compression [Pa/m].
double normal_stiffness(const Interface& interface) {
  if (interface.law == nullptr) return HUGE_VAL;
  std::array<double, most_components> stiffness{};
  interface.law->closed_stiffness(interface.batch.components, stiffness.data());
  return stiffness[static_cast<std::size_t>(interface.batch.translations()) - 1];
}

bool flat(const Interface& interface) {
  return std::ranges::all_of(interface.normal, [&](const Vec3& n) { return (n - interface.normal.front()).norm() < 1e-9; });
}

/// Whether values at the points are those of a plane. `weight`: the slope weights of the interface.
bool of_a_plane(const Interface& interface, const std::array<Vector, 2>& weight, const Vector& values) {
  const Vec3& normal = interface.normal.front();
  Vector left = values;
  for (int k = 0; k < interface.space.dimension - 1; ++k) {
    const double slope = weight[static_cast<std::size_t>(k)].dot(values);
    const Vec3 axis = interface.space.dimension == 2 ? Vec3(Vec3::UnitZ()) : local_axis(interface.space, normal, k);
    for (int i = 0; i < interface.batch.points; ++i)
      left[i] -= slope * cross(axis, interface.position[static_cast<std::size_t>(i)] - interface.reference).dot(normal);
  }
  left.array() -= left.mean();
  return left.cwiseAbs().maxCoeff() <= 1e-9 * values.cwiseAbs().maxCoeff();
}

/// Whether the openings of an interface are those of a plane however the model moves: a rigid body on ground that is fixed, or rigid too.
/// An arbitrary motion shows it. `row`: the first one of the normal openings among the rows of all interfaces.
bool opens_as_a_plane(const Model& model, const Interface& interface, const std::array<Vector, 2>& weight, int row) {
  const int points = interface.batch.points, first = (interface.batch.translations() - 1) * points;
  if (points < 2 || interface.gap.size() < interface.rows() || interface.b.rows() < interface.rows() || !flat(interface)) return false;
  Vector opening = Vector::Zero(points);
  for (Index column = 0; column < interface.b.outerSize(); ++column)
    for (Sparse::InnerIterator entry(interface.b, column); entry; ++entry)
      if (const Index i = entry.row() - first; i >= 0 && i < points)
        opening[i] += entry.value() * std::sin(1 + static_cast<double>(entry.col()));
  return of_a_plane(interface, weight, opening) && of_a_plane(interface, weight, interface.gap.segment(first, points)) &&
         std::ranges::all_of(model.motions, [&](const PrescribedMotion& motion) {
           return motion.opening.size() == 0 || of_a_plane(interface, weight, motion.opening.segment(row, points));
         });
}

}  // namespace

GapRule gap_rule(const Interface& interface) {
  if (interface.law == nullptr || interface.batch.rotations > 0) return {};
  const LawScales scales = interface.law->scales();
  const bool may_pull = scales.strength > 0 || interface.behaviour == "external";  // what a function of the caller's does is not known
  return {scales.opens, may_pull ? 1 / normal_stiffness(interface) : 0};
}

InterfaceViewer::InterfaceViewer(const Model& model, double gap_tolerance, const std::vector<std::vector<int>>& bases,
                                 const std::vector<std::shared_ptr<const Facets>>& facets)
    : tolerance_(gap_tolerance) {
  for (std::size_t k = 0; k < bases.size(); ++k) bases_.emplace_back(model, model.interfaces[k], bases[k]);
  int first = 0, first_history = 0;
  for (const Interface& interface : model.interfaces) {
    Layout layout;
    layout.first = first;
    layout.first_history = first_history;
    layout.batch = interface.batch;
    if (interface.batch.rotations > 0) layout.footing = interface.law.get();
    layout.points = interface.batch.points;
    layout.translations = interface.batch.translations();
    layout.normal = first + (layout.translations - 1) * layout.points;
    layout.space = interface.space;
    layout.area = interface.area;
    layout.inverse_area = interface.area.cwiseInverse();
    layout.along.resize(layout.points);
    layout.across.resize(layout.points);
    for (int i = 0; i < layout.points; ++i) {
      const auto p = static_cast<std::size_t>(i);
      const Vec3 arm = interface.position[p] - interface.reference;
      layout.along[i] = arm.dot(local_axis(interface.space, interface.normal[p], 0));
      layout.across[i] = arm.dot(interface.normal[p]);
    }
    if (interface.space.dimension == 3 || layout.footing != nullptr || !flat(interface)) layout.resultant_rows = resultant_rows(interface);
    layout.total = interface.area.sum();
    layout.slope_weight = slope_weights(interface);
    layout.stiffness = normal_stiffness(interface);
    layout.bonded = interface.law != nullptr && !interface.law->scales().opens;
    layout.rule = gap_rule(interface);
    if (layout.rule.differs()) gap_.setZero(std::max<Index>(gap_.size(), layout.points));
    if (const std::size_t k = layouts_.size(); k < facets.size() && facets[k] != nullptr) {
      layout.share = PositiveShare(*facets[k]);
      layout.corners = facets[k]->corners;
      layout.at_edge = facets[k]->at_edge;
      const bool bare = layout.rule.opens && !(interface.law != nullptr && interface.law->scales().strength > 0) &&
                        std::isfinite(layout.stiffness);  // it gives, and never pulls
      if ((bare || layout.bonded) && opens_as_a_plane(model, interface, layout.slope_weight, layout.normal)) {
        layout.plane = bare;
        layout.plane_tractions = layout.bonded && interface.weight.size() == interface.area.size() && interface.weight == interface.area;
      }
      value_.setZero(std::max(value_.size(), layout.share.room()));
    }
    layouts_.push_back(std::move(layout));
    first += interface.rows();
    if (interface.law != nullptr) first_history += interface.law->num_history(interface.batch.components) * interface.batch.points;
  }
}

/// The share of the area that is open, given the view, where points still count as a whole. Openings are cut where they pass zero. Where
/// what lies under the joint is softer than the joint, or the joint does not give at all, the opening has a bend there: it does not get
/// much below zero. The closed side then goes on with pressure times a compliance c that makes its mean slope that of the open side. With
/// the volume V of the gap over the share s and the compression P over the share 1 - s, both as triangles: c = (V/s^2)/(P/(1 - s)^2).
double InterfaceViewer::open_share(const Layout& layout, const double* gap, const double* force, const InterfaceView& view) {
  const double counted = view.open_area, closed = 1 - counted, tolerance = tolerance_;
  // the same compliance from the largest values, good enough to decide
  const bool bent = view.max_opening * closed * layout.stiffness > much_softer * counted * view.max_pressure;
  if (!bent && layout.share.points_alone()) return layout.share.above(tolerance, gap);
  const double *area = layout.area.data(), *inverse = layout.inverse_area.data();
  double* value = value_.data();
  const Lanes zero = 0;
  Lanes volume = zero, compression = zero;
  for_lanes(layout.points, [&](const auto& at) {
    const Lanes here = at(gap);
    volume += at(area) * larger(here, zero);
    compression -= smaller(at(force), zero);
    at.put(value, here - tolerance);
  });
  const double pressed = sum(compression) * counted * counted;
  const double compliance = bent && pressed > 0 ? sum(volume) * closed * closed / pressed : 0;
  if (compliance > 0)
    for_lanes(layout.points, [&](const auto& at) {
      const Lanes here = at(value);
      at.put(value, choose(here > zero, here, smaller(here, compliance * at(force) * at(inverse))));
    });
  return layout.share.positive(value);
}

/// The share of the surface on which a quantity is above a level, linear between the points.
[[gnu::noinline]] double InterfaceViewer::share_above(const Layout& layout, double level, const double* value) {
  if (layout.share.points_alone()) return layout.share.above(level, value);
  for_lanes(layout.points, [&, left = value_.data()](const auto& at) { at.put(left, at(value) - level); });
  return layout.share.positive(value_.data());
}

/// The share of the area that pulls, tractions cut where they pass zero.
double InterfaceViewer::tension_share(const Layout& layout, const double* force) {
  for_lanes(layout.points, [&, value = value_.data()](const auto& at) { at.put(value, at(force) * at(layout.inverse_area.data())); });
  return layout.share.positive(value_.data());
}

/// The largest pressure at the edges of the base that no point reaches: linear from the points next to them, of which those that bear
/// nothing have the pressure zero. It does not jump when one of them loses contact.
double InterfaceViewer::edge_pressure(const Layout& layout, const double* force) {
  double most = 0;
  for (const Facets::Corner& corner : layout.corners) {
    double traction = 0;
    for (const auto& [point, weight] : corner) traction += weight * std::min(0.0, force[point]) * layout.inverse_area[point];
    most = larger(most, -traction);
  }
  return most;
}

/// Whether a plane of tractions pulls at an edge that no point reaches.
bool InterfaceViewer::pulls_at_edge(const Layout& layout, const double* force) {
  return std::ranges::any_of(layout.corners, [&](const Facets::Corner& corner) {
    double traction = 0;
    for (const auto& [point, weight] : corner) traction += weight * force[point] * layout.inverse_area[point];
    return traction > 0;
  });
}

/// The largest opening at corners that no point reaches: linear from the points next to them, where these are open.
double InterfaceViewer::edge_opening(const Layout& layout, const double* gap) const {
  double most = 0;
  for (const Facets::Corner& corner : layout.corners) {
    double opening = 0;
    bool open = true;
    for (const auto& [point, weight] : corner) {
      opening += weight * gap[point];
      open = open && gap[point] > tolerance_;
    }
    if (open) most = larger(most, opening);
  }
  return most;
}

/// Gap and open share of a plane, which has no bend, and may have left the ground between the last points and the edge only.
void InterfaceViewer::look_at_plane(const Layout& layout, const double* gap, InterfaceView& view) {
  double most = view.max_opening, least = view.least_opening;
  for (const Facets::Corner& corner : layout.corners) {
    double opening = 0;
    for (const auto& [point, weight] : corner) opening += weight * gap[point];
    most = larger(most, opening);
    least = smaller(least, opening);
  }
  if (!(most > tolerance_)) return;
  view.max_opening = most;
  if (!layout.share.empty() && !(least > tolerance_)) view.open_area = share_above(layout, tolerance_, gap);
}

/// One point with rotations: its law knows how much of the footing is open. A pressure is not among its forces.
void InterfaceViewer::look_at_footing(const Layout& layout, const Vector& opening, const Vector& force, const Vector& history,
                                      const Vector* radiation, InterfaceView& view) const {
  const double* rows = opening.data() + layout.first;
  const FootingContact contact = layout.footing->contact(layout.batch, rows, history.data() + layout.first_history);
  view.open_area = contact.open_share;
  view.tension_area = layout.bonded && force[layout.first + layout.batch.normal()] > 0 ? 1 : 0;
  view.max_opening = contact.max_gap;
  view.least_opening = contact.least_gap;
  view.max_pressure = 0;
  view.bearing_utilisation = contact.bearing_utilisation;
  view.sliding_utilisation = contact.sliding_utilisation;
  view.bearing_capacity = contact.bearing_capacity;
  for (int k = 0; k < std::min(2, layout.batch.rotations); ++k) {  // about the axes of the resultant
    double rotation = 0;
    for (int row = layout.translations; row < layout.batch.components; ++row)
      rotation += layout.resultant_rows(layout.translations + k, row) * rows[row];
    view.rotation[static_cast<std::size_t>(k)] = rotation;
  }
  view.resultant = view.in_law = resultant_by_rows(layout, force);
  if (radiation != nullptr) view.resultant = resultant_by_rows(layout, force, radiation);
}

Resultant InterfaceViewer::resultant_by_rows(const Layout& layout, const Vector& force, const Vector* more) {
  std::array<double, 6> sums{};
  for (Index row = 0; row < layout.resultant_rows.cols(); ++row) {
    const Index at = layout.first + row;
    const double value = more != nullptr ? force[at] + (*more)[at] : force[at];
    for (Index c = 0; c < layout.resultant_rows.rows(); ++c) sums[static_cast<std::size_t>(c)] += layout.resultant_rows(c, row) * value;
  }
  return resultant_of(layout.space, sums.data());
}

/// Of every point, at the end of the step [m]; negative where it is closed. What round-off leaves of a stretched joint is no gap.
const double* InterfaceViewer::gaps(const Layout& layout, const double* opening, const double* force) {
  const double* inverse = layout.inverse_area.data();
  for_lanes(layout.points, [&, gap = gap_.data(), opens = layout.rule.opens, softness = layout.rule.softness](const auto& at) {
    const Lanes zero = 0, stretch = softness * larger(at(force) * at(inverse), zero), left = at(opening) - stretch;
    at.put(gap, opens ? choose(stretch > zero && left < 1e-9 * stretch, zero, left) : smaller(at(opening), zero));
  });
  return gap_.data();
}

/// The share of the area of the points that pull.
double InterfaceViewer::pulling_points(const Layout& layout, const double* force) {
  const Lanes zero = 0;
  Lanes pulled = zero;
  for_lanes(layout.points, [&, area = layout.area.data()](const auto& at) { pulled += choose(at(force) > zero, at(area), zero); });
  return std::min(1.0, sum(pulled) / layout.total);
}

/// Points without rotations.
void InterfaceViewer::look_at_points(const Layout& layout, const State& state, InterfaceView& view) {
  const int n = layout.points;
  const double *opening = state.opening.data() + layout.normal, *p = state.mean_force.data() + layout.normal;
  const double* gap = layout.rule.differs() ? gaps(layout, opening, state.force.data() + layout.normal) : opening;
  const double *area = layout.area.data(), *inverse = layout.inverse_area.data(), *along = layout.along.data(),
               *slope = layout.slope_weight[0].data();
  const double tolerance = tolerance_;
  const Lanes zero = 0;
  Lanes axials = zero, moments = zero, slopes = zero, open = zero, widest = zero, traction = zero, pull = zero, least = gap[0];
  for_lanes(
      n, [&](const auto& at) __attribute__((always_inline)) {
        const Lanes force = at(p);
        axials += force;
        moments += at(along) * force;
        slopes += at(slope) * at(opening);
        open += choose(at(gap) > tolerance, at(area), zero);
        widest = larger(widest, at(gap));
        least = smaller(least, at(gap, gap[0]));
        traction = smaller(traction, force * at(inverse));
        pull = larger(pull, force);
      });
  const bool pulls = any(pull > zero);
  const double axial = sum(axials);
  double moment = sum(moments), shear = 0;
  view.rotation = {sum(slopes), 0};
  view.max_opening = largest(widest);
  view.least_opening = smallest(least);
  view.max_pressure = 0 - smallest(traction);  // not -0
  view.open_area = std::min(1.0, sum(open) / layout.total);
  view.tension_area = pulls ? pulling_points(layout, p) : 0;
  const auto in_parts = [&](double share) { return !layout.share.empty() && share > 0 && share < whole; };
  const bool plane = layout.plane && !(layout.rule.softness > 0 && state.force.segment(layout.normal, n).maxCoeff() > 0);
  if (plane)
    look_at_plane(layout, gap, view);
  else if (in_parts(view.open_area))
    view.open_area = open_share(layout, gap, p, view);
  if (layout.bonded && (in_parts(view.tension_area) || (layout.plane_tractions && view.tension_area == 0 && pulls_at_edge(layout, p))))
    view.tension_area = tension_share(layout, p);
  if (!layout.corners.empty()) {
    if (layout.at_edge) view.max_pressure = std::max(view.max_pressure, edge_pressure(layout, p));
    if (!plane && view.max_opening > tolerance) view.max_opening = std::max(view.max_opening, edge_opening(layout, gap));
  }
  if (layout.slope_weight[1].size() > 0) view.rotation[1] = small::dot(n, layout.slope_weight[1].data(), opening);
  if (layout.resultant_rows.size() > 0) {
    view.resultant = resultant_by_rows(layout, state.mean_force);
    return;
  }
  if (layout.translations > 1) {
    const double *t = state.mean_force.data() + layout.first, *across = layout.across.data();
#pragma omp simd reduction(+ : shear, moment)
    for (int i = 0; i < n; ++i) shear += t[i], moment -= across[i] * t[i];
  }
  view.resultant = {.axial = axial, .shear = shear, .moment = moment};
}

void InterfaceViewer::look(const State& state, std::vector<InterfaceView>& views, const Vector* radiation) {
  if (views.empty()) views.resize(layouts_.size());
  InterfaceView* view = views.data();
  for (const Layout& layout : layouts_) {
    if (layout.footing != nullptr)
      look_at_footing(layout, state.opening, state.mean_force, state.history, radiation, *view++);
    else
      look_at_points(layout, state, *view++);
  }
}

BasePose InterfaceViewer::pose(const State& state, std::size_t interface, const InterfaceView& view) const {
  const Layout& layout = layouts_[interface];
  const int n = layout.points;
  const double *along = state.opening.data() + layout.first, *area = layout.area.data();
  BasePose pose{.max_opening = view.max_opening, .open_area = view.open_area};
  if (layout.translations > 1) pose.slip_1 = small::dot(n, area, along) / layout.total;
  if (layout.translations > 2) pose.slip_2 = small::dot(n, area, along + n) / layout.total;
  if (!bases_.empty()) bases_[interface].look(state, pose);
  return pose;
}

}  // namespace uplift
