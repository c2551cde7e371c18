#include "uplift/analysis/record.h"

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

constexpr double nothing = 0;
constexpr double whole = 1 - 1e-12;  // share of an area: all of it but for round-off
constexpr double much_softer = 10;   // what lies under a joint than the joint, before its openings count as bent

/// Of the closed joint, in compression [Pa/m].
double normal_stiffness(const Interface& interface) {
  if (interface.law == nullptr) return HUGE_VAL;
  std::array<double, 3> stiffness{};
  interface.law->closed_stiffness(interface.batch.components, stiffness.data());
  return stiffness[static_cast<std::size_t>(interface.batch.components) - 1];
}

bool flat(const Interface& interface) {
  return std::ranges::all_of(interface.normal, [&](const Vec3& n) { return (n - interface.normal.front()).norm() < 1e-9; });
}

}  // namespace

InterfaceViewer::InterfaceViewer(const Model& model, double gap_tolerance, const std::vector<std::vector<int>>& bases,
                                 const std::vector<std::shared_ptr<const Facets>>& facets)
    : tolerance_(gap_tolerance) {
  for (std::size_t k = 0; k < bases.size(); ++k) bases_.emplace_back(model, model.interfaces[k], bases[k]);
  int first = 0;
  for (const Interface& interface : model.interfaces) {
    Layout layout;
    layout.first = first;
    layout.points = interface.batch.points;
    layout.components = interface.batch.components;
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
    if (interface.space.dimension == 3 || !flat(interface)) layout.resultant_rows = resultant_rows(interface);
    layout.total = interface.area.sum();
    layout.slope_weight = slope_weights(interface);
    layout.stiffness = normal_stiffness(interface);
    layout.bonded = interface.behaviour == "elastic";
    if (const std::size_t k = layouts_.size(); k < facets.size() && facets[k] != nullptr) {
      layout.share = PositiveShare(*facets[k]);
      if (facets[k]->at_edge) layout.edge = facets[k]->corners;
      value_.setZero(std::max(value_.size(), layout.share.room()));
    }
    layouts_.push_back(std::move(layout));
    first += interface.rows();
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

/// The share of the area that pulls, tractions cut where they pass zero.
double InterfaceViewer::tension_share(const Layout& layout, const double* force) {
  for_lanes(layout.points, [&, value = value_.data()](const auto& at) { at.put(value, at(force) * at(layout.inverse_area.data())); });
  return layout.share.positive(value_.data());
}

/// The largest pressure at the edges of the base that no point reaches: linear from the points next to them, where these are in contact.
double InterfaceViewer::edge_pressure(const Layout& layout, const double* force) {
  double most = 0;
  for (const Facets::Corner& corner : layout.edge) {
    double traction = 0;
    bool contact = true;
    for (const auto& [point, weight] : corner) {
      traction += weight * force[point] * layout.inverse_area[point];
      contact = contact && force[point] < 0;
    }
    if (contact) most = larger(most, -traction);
  }
  return most;
}

void InterfaceViewer::look(const Vector& opening, const Vector& force, std::vector<InterfaceView>& views) {
  views.resize(layouts_.size());
  for (std::size_t k = 0; k < layouts_.size(); ++k) {
    const Layout& layout = layouts_[k];
    const int n = layout.points, normal = layout.first + (layout.components - 1) * n;
    const double *gap = opening.data() + normal, *p = force.data() + normal;
    const double *area = layout.area.data(), *inverse = layout.inverse_area.data(), *along = layout.along.data();
    const double *slope = layout.slope_weight[0].data(), tolerance = tolerance_;
    const Lanes zero = 0;
    Lanes axials = zero, moments = zero, slopes = zero, open = zero, pulled = zero, widest = zero, pressure = zero, least = gap[0];
    for_lanes(n, [&](const auto& at) {
      const Lanes pull = at(p), here = at(gap), weight = at(area);
      axials += pull;
      moments += at(along) * pull;
      slopes += at(slope) * here;
      open += choose(here > tolerance, weight, zero);
      pulled += choose(pull > zero, weight, zero);
      widest = larger(widest, here);
      least = smaller(least, at(gap, gap[0]));
      pressure = larger(pressure, -pull * at(inverse));
    });
    double shear = 0, moment = sum(moments);
    InterfaceView& view = views[k];
    view.open_area = std::min(1.0, sum(open) / layout.total);
    view.tension_area = std::min(1.0, sum(pulled) / layout.total);
    view.max_opening = largest(widest);
    view.least_opening = smallest(least);
    view.max_pressure = largest(pressure);
    const auto in_parts = [&](double share) { return !layout.share.empty() && share > 0 && share < whole; };
    if (in_parts(view.open_area)) view.open_area = open_share(layout, gap, p, view);
    if (layout.bonded && in_parts(view.tension_area)) view.tension_area = tension_share(layout, p);
    if (!layout.edge.empty()) view.max_pressure = std::max(view.max_pressure, edge_pressure(layout, p));
    view.rotation = {sum(slopes), 0};
    if (layout.slope_weight[1].size() > 0) view.rotation[1] = small::dot(n, layout.slope_weight[1].data(), gap);
    if (layout.resultant_rows.size() > 0) {
      std::array<double, 6> sums{};
      for (Index row = 0; row < layout.resultant_rows.cols(); ++row)
        for (Index c = 0; c < layout.resultant_rows.rows(); ++c)
          sums[static_cast<std::size_t>(c)] += layout.resultant_rows(c, row) * force[layout.first + row];
      view.resultant = resultant_of(layout.space, sums.data());
      continue;
    }
    if (layout.components > 1) {
      const double* t = force.data() + layout.first;
      const double* across = layout.across.data();
#pragma omp simd reduction(+ : shear, moment)
      for (int i = 0; i < n; ++i) shear += t[i], moment -= across[i] * t[i];
    }
    view.resultant = {.axial = sum(axials), .shear = shear, .moment = moment};
  }
}

BasePose InterfaceViewer::pose(const State& state, std::size_t interface, const InterfaceView& view) const {
  const Layout& layout = layouts_[interface];
  const int n = layout.points;
  const double *along = state.opening.data() + layout.first, *area = layout.area.data();
  BasePose pose{.max_opening = view.max_opening, .open_area = view.open_area};
  if (layout.components > 1) pose.slip_1 = small::dot(n, area, along) / layout.total;
  if (layout.components > 2) pose.slip_2 = small::dot(n, area, along + n) / layout.total;
  if (!bases_.empty()) bases_[interface].look(state, pose);
  return pose;
}

Recorder::Recorder(const Model& model, const RunPlan& plan, const State& state, const Energies& energies, const Stepper* stepper,
                   const std::vector<InterfaceView>& views, const ForceStage& stage, long steps, double step, PageTaker& pages,
                   RunResult& result)
    : model_(model),
      plan_(plan),
      state_(state),
      energies_(energies),
      stepper_(stepper),
      views_(views),
      result_(result),
      floors_(model, plan, steps, step, result) {
  wants_acceleration_ = records_accelerations(plan);
  for (const Frame& frame : result.frames)
    for (const double share : frame.uplifted) peak_uplift_ = std::max(peak_uplift_, share);
  if (asks_for_forces(plan)) forces_ = std::make_unique<ForceRecorder>(stage, plan, stepper, state, result);
  const std::size_t expected_rows = static_cast<std::size_t>(steps / plan.every) + 2;
  const bool fresh = result_.table.empty();  // a later dynamic stage goes on in the same table
  if (fresh) {
    result_.columns = plan.requests;
    result_.table.assign(plan.requests.size() + 1, {});
  }
  for (std::vector<double>& column : result_.table) {
    column.reserve(column.size() + expected_rows + 2);
    pages.add(column.data() + column.size(), (expected_rows + 2) * sizeof(double));
  }
  recent_.resize(plan.requests.size() * apart);
  const auto moves_base = [](const Request& request) {
    return request.kind == Request::Kind::settlement || request.kind == Request::Kind::tilt_1 || request.kind == Request::Kind::tilt_2;
  };
  if (std::ranges::any_of(plan.requests, moves_base))
    for (std::size_t k = 0; k < plan.bases.size(); ++k) bases_.emplace_back(model, model.interfaces[k], plan.bases[k]);
  const SparseRows reduction(model.reduction);
  for (const Request& request : plan.requests) {
    Source source = source_of(request, reduction);
    source.request = &request;
    source.to = recent_.data() + most_.size() * apart;
    if (fresh) result_.peaks.push_back({request.name, request.unit, 0, 0});
    most_.push_back(std::abs(result_.peaks[most_.size()].value));
    (source.place != nullptr ? placed_ : source.vector != nullptr ? entries_ : made_).push_back(std::move(source));
  }
  if (stepper_ == nullptr) acceleration_ = Vector::Zero(model.free());
  before_ = state.time;
}

Recorder::Source Recorder::source_of(const Request& request, const SparseRows& reduction) const {
  using What = Request::Kind;
  const InterfaceView* view = views_.data() + request.interface;
  const auto entry_of = [&](const Vector State::*vector) {  // of one free unknown, or made from several
    Source source{.vector = vector};
    for (SparseRows::InnerIterator entry(reduction, request.unknown); entry; ++entry)
      source.terms.emplace_back(static_cast<int>(entry.col()), entry.value());
    if (request.below >= 0)
      for (SparseRows::InnerIterator entry(reduction, request.below); entry; ++entry)
        source.terms.emplace_back(static_cast<int>(entry.col()), -entry.value());
    for (const PrescribedMotion& motion : model_.motions)
      source.moved = source.moved || motion.shape[request.unknown] != 0 || (request.below >= 0 && motion.shape[request.below] != 0);
    for (auto& [unknown, factor] : source.terms) factor *= request.factor;
    if (source.moved || source.terms.size() != 1)
      source.vector = nullptr;
    else
      source.entry = source.terms.front().first, source.factor = source.terms.front().second;
    return source;
  };
  const auto row_of = [&](const Vector State::*vector, bool per_area) {
    int first = 0;
    for (int i = 0; i < request.interface; ++i) first += model_.interfaces[static_cast<std::size_t>(i)].rows();
    const Interface& interface = model_.interfaces[static_cast<std::size_t>(request.interface)];
    if (request.component >= interface.batch.components) return Source{.place = &nothing};  // free to slide: neither moved nor pulled
    return Source{.vector = vector,
                  .entry = first + request.component * interface.batch.points + request.point,
                  .factor = per_area ? 1 / interface.area[request.point] : 1.0};
  };
  switch (request.kind) {
    case What::displacement:
      return entry_of(&State::displacement);
    case What::velocity:
      return entry_of(&State::velocity);
    case What::acceleration:
    case What::absolute_acceleration:
      return entry_of(nullptr);
    case What::opening:
      return row_of(&State::opening, false);
    case What::traction:
      return row_of(&State::mean_force, true);
    case What::end_traction:
      return row_of(&State::force, true);
    case What::rotation:
      return {.place = model_.space.dimension == 2 ? &view->rotation[0] : nullptr};
    case What::rotation_1:
      return {.place = &view->rotation[0]};
    case What::rotation_2:
      return {.place = &view->rotation[1]};
    case What::axial:
      return {.place = &view->resultant.axial};
    case What::shear:
      return {.place = &view->resultant.shear};
    case What::moment:
      return {.place = &view->resultant.moment};
    case What::shear_1:
      return {.place = &view->resultant.shear_1};
    case What::shear_2:
      return {.place = &view->resultant.shear_2};
    case What::moment_1:
      return {.place = &view->resultant.moment_1};
    case What::moment_2:
      return {.place = &view->resultant.moment_2};
    case What::torsion:
      return {.place = &view->resultant.torsion};
    case What::uplifted_ratio:
      return {.place = &view->open_area};
    case What::max_opening:
      return {.place = &view->max_opening};
    case What::max_pressure:
      return {.place = &view->max_pressure};
    case What::kinetic:
      return {.place = &energies_.kinetic};
    case What::strain:
      return {.place = &energies_.strain};
    case What::stored:
      return {.place = &energies_.stored};
    case What::interface_dissipated:
      return {.place = &energies_.interface_dissipated};
    case What::damping:
      return {.place = &energies_.damping};
    case What::impact:
      return {.place = &energies_.impact};
    case What::external:
      return {.place = &energies_.external};
    case What::residual:
      return {.place = &energies_.residual};
    case What::plastic:
      return {.place = &energies_.plastic};
    case What::algorithmic:
      return {.place = &energies_.algorithmic};
    case What::filter:
      return {.place = &energies_.filter};
    case What::settlement:
    case What::tilt_1:
    case What::tilt_2:
      return {};
    case What::force:
      return {.place = forces_->value(request)};
  }
  return {};
}

/// Acceleration of the relative frame along the axis of the request [m/s2].
double Recorder::ground(const Request& request, double time) const {
  return model_.ground_acceleration(model_.space.axis(model_.space.index_of(request.unknown)), time);
}

double Recorder::made(const Source& source) const {
  using What = Request::Kind;
  const Request& request = *source.request;
  const State& state = state_;
  const bool rests = stepper_ == nullptr;
  const auto sum = [&](const Vector& q, int derivative) {
    if (source.moved) {
      const auto at = [&](MotionInstant instant) {
        const double below = request.below >= 0 ? model_.full(request.below, q, derivative, instant) : 0;
        return request.factor * (model_.full(request.unknown, q, derivative, instant) - below);
      };
      return derivative == 2 ? 0.5 * (at(before_) + at(state.time)) : at(state.instant());
    }
    double total = 0;
    for (const auto& [unknown, factor] : source.terms) total += factor * q[unknown];
    return total;
  };
  switch (request.kind) {
    case What::displacement:
      return sum(state.displacement, 0);
    case What::velocity:
      return rests ? 0 : sum(state.velocity, 1);
    case What::acceleration:
      return rests ? 0 : sum(acceleration_, 2);
    case What::absolute_acceleration:
      return rests ? 0 : sum(acceleration_, 2) + 0.5 * (ground(request, before_) + ground(request, state.time));
    case What::rotation: {
      const std::array<double, 2>& slope = views_[static_cast<std::size_t>(request.interface)].rotation;
      return std::hypot(slope[0], slope[1]);
    }
    case What::settlement:
    case What::tilt_1:
    case What::tilt_2: {
      BasePose pose;
      bases_[static_cast<std::size_t>(request.interface)].look(state, pose);
      return request.kind == What::settlement ? pose.settlement : request.kind == What::tilt_1 ? pose.tilt_1 : pose.tilt_2;
    }
    default:
      return 0;
  }
}

void Recorder::record(bool row, double abscissa) {
  const State& state = state_;
  if (wants_acceleration_ && stepper_ != nullptr) stepper_->acceleration(acceleration_);
  if (stepper_ == nullptr || !stepper_->averages_acceleration()) before_ = state.time;
  floors_.record(acceleration_, before_, state.time);
  if (forces_) forces_->record();
  const std::size_t at = count_;
#pragma GCC unroll 4
  for (const Source& each : placed_) each.to[at] = *each.place;
#pragma GCC unroll 4
  for (const Source& each : entries_) each.to[at] = each.factor * (state.*each.vector).data()[each.entry];
  for (const Source& each : made_) each.to[at] = made(each);
  time_[at] = abscissa;
  before_ = state.time;
  is_row_[at] = row;
  if (++count_ == many) flush();
}

void Recorder::flush() {
  const std::size_t count = std::exchange(count_, 0);
  for (std::size_t k = 0; k < most_.size(); ++k) {
    const double* recent = recent_.data() + k * apart;
    Lanes sizes = most_[k];
    for_lanes(static_cast<std::ptrdiff_t>(count), [&](const auto& at) {
      const Lanes size = absolute(at(recent));
      sizes = choose(size > sizes, size, sizes);  // never what is not a number
    });
    const double most = largest(sizes);
    if (most == most_[k]) continue;
    most_[k] = most;
    const double* peak = std::find_if(recent, recent + count, [most](double value) { return std::abs(value) == most; });
    result_.peaks[k].value = *peak, result_.peaks[k].time = time_[static_cast<std::size_t>(peak - recent)];
  }
  std::array<std::size_t, many> rows;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (is_row_[i]) rows[kept++] = i;
  const auto append_rows = [&](std::vector<double>& column, double* numbers) {
    for (std::size_t i = 0; kept < count && i < kept; ++i) numbers[i] = numbers[rows[i]];
    column.insert(column.end(), numbers, numbers + kept);
  };
  append_rows(result_.table.front(), time_.data());
  for (std::size_t k = 0; k < most_.size(); ++k) append_rows(result_.table[k + 1], recent_.data() + k * apart);
}

void Recorder::finish() {
  flush();
  if (peak_frame_.displacement.size() == 0) return;
  const auto next = std::ranges::lower_bound(result_.frames, peak_frame_.time, {}, &Frame::time);
  if (next == result_.frames.end() || next->time != peak_frame_.time) result_.frames.insert(next, std::move(peak_frame_));
}

void Recorder::picture(const State& state) {
  result_.frames.push_back(frame_of(state));
}

void Recorder::note_largest_uplift() {
  double largest = peak_uplift_;
  for (std::size_t k = 0; k < views_.size(); ++k)
    if (plan_.is_wall.empty() || !plan_.is_wall[k]) largest = std::max(largest, views_[k].open_area);
  if (!(largest > peak_uplift_)) return;
  peak_uplift_ = largest;
  peak_frame_ = frame_of(state_);
}

Frame Recorder::frame_of(const State& state) const {
  Frame frame;
  frame.time = state.time;
  frame.displacement = model_.reduction * state.displacement;
  for (const PrescribedMotion& motion : model_.motions)
    frame.displacement += motion.shape * (state.load_factor * motion.function->value(state.time));
  int points = 0;
  for (const Interface& interface : model_.interfaces) points += interface.batch.points;
  frame.opening.resize(points);
  frame.pressure.resize(points);
  int first = 0, point = 0;
  for (const Interface& interface : model_.interfaces) {
    for (int i = 0; i < interface.batch.points; ++i, ++point) {
      frame.opening[point] = state.opening[first + interface.batch.normal() + i];
      frame.pressure[point] = std::max(0.0, -state.mean_force[first + interface.batch.normal() + i] / interface.area[i]);
    }
    first += interface.rows();
  }
  for (const InterfaceView& view : views_) frame.uplifted.push_back(view.open_area);
  return frame;
}

}  // namespace uplift
