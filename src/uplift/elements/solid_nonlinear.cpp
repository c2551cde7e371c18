#include "uplift/elements/solid_nonlinear.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>

#include "uplift/math/dense.h"
#include "uplift/math/lanes.h"
#include "uplift/math/line_search.h"
#include "uplift/math/small.h"

namespace uplift {

namespace {

/// A point at the apex has no stiffness at all: this share of the elastic one, added to every tangent, keeps matrices regular.
constexpr double least_elastic_share = 1e-9;

/// Elements of up to so many points keep the gradients of their shape functions: at most 2.2 kB (hex8).
constexpr int most_kept_points = 8;

constexpr std::size_t most_amplitudes = 9;
constexpr int width = static_cast<int>(lanes);

/// To the round-off of tangents. n x n.
bool is_symmetric(int n, const double* a) {
  double size = 0, difference = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      size = std::max(size, std::abs(a[i + n * j]));
      difference = std::max(difference, std::abs(a[i + n * j] - a[j + n * i]));
    }
  return difference <= 1e-7 * size;
}

SolidSection with_material(SolidSection section, const ElasticMaterial& material) {
  section.material = material;
  return section;
}

}  // namespace

double NonlinearSolid::mode_gradient(const PointGradient& at) const {
  double sum = 0;
  for (int i = 0; i < dimension(); ++i)
    for (int k = 0; k < modes_; ++k) {
      const double g = at.g[i][static_cast<int>(nodes().size()) + k];
      sum += g * g;
    }
  return std::sqrt(sum);
}

double NonlinearSolid::node_gradient(const PointGradient& at) const {
  double largest = 0;
  for (int i = 0; i < dimension(); ++i)
    for (std::size_t a = 0; a < nodes().size(); ++a) largest = std::max(largest, std::abs(at.g[i][a]));
  return largest;
}

NonlinearSolid::NonlinearSolid(Cell cell, std::span<const int> nodes, Coordinates coordinates, SolidSection section,
                               std::shared_ptr<const BulkLaw> law, const CellRule* part)
    : Solid(cell, nodes, std::move(coordinates), with_material(section, law->material()), part),
      law_(std::move(law)),
      size_(law_->num_history()),
      points_(num_points()),
      modes_(num_modes()),
      side_by_side_(points_ > 1 ? (points_ + width - 1) / width * width : 1) {
  assert(dimension() == 3 || section.plane == PlaneState::strain);
  Scratch elastic;
  find_gradients(elastic.gradient);
  if (points_ <= most_kept_points) keep_gradients(elastic.gradient);
  if (modes_ == 0) return;
  elastic.tangent.assign(elastic.gradient.size(), law_->elastic());
  const Matrix k = full_tangent(elastic, 0);
  mode_flexibility_ = inverse(k.bottomRightCorner(num_amplitudes(), num_amplitudes()));
  modes_of_nodes_ = -mode_flexibility_ * k.bottomLeftCorner(num_amplitudes(), unknowns());
}

void NonlinearSolid::keep_gradients(const std::vector<PointGradient>& all) {
  const int functions = static_cast<int>(nodes().size()) + modes_;
  gradient_.assign(static_cast<std::size_t>((1 + dimension() * functions) * side_by_side_), 0.0);
  for (int p = 0; p < points_; ++p) {
    const PointGradient& at = all[static_cast<std::size_t>(p)];
    double* kept = gradient_.data() + p;
    *kept = at.volume;
    for (int i = 0; i < dimension(); ++i)
      for (int a = 0; a < functions; ++a) *(kept += side_by_side_) = at.g[i][a];
  }
}

void NonlinearSolid::recall_gradient(int point, PointGradient& at) const {
  const int functions = static_cast<int>(nodes().size()) + modes_;
  const double* kept = gradient_.data() + point;
  at.volume = *kept;
  for (int i = 0; i < dimension(); ++i)
    for (int a = 0; a < functions; ++a) at.g[i][a] = *(kept += side_by_side_);
}

void NonlinearSolid::recall_gradients(std::vector<PointGradient>& all) const {
  if (gradient_.empty()) return find_gradients(all);
  all.resize(static_cast<std::size_t>(points_));
  for (int p = 0; p < points_; ++p) recall_gradient(p, all[static_cast<std::size_t>(p)]);
}

int NonlinearSolid::num_history() const {
  return first_amplitude() + num_amplitudes();
}

Strain NonlinearSolid::strain(const PointGradient& at, const Vector& displacement, const double* amplitudes) const {
  const int count = static_cast<int>(nodes().size());
  Strain strain = Strain::Zero();
  add_strain(at, dimension(), 0, count, displacement.data(), strain);
  add_strain(at, dimension(), count, modes_, amplitudes, strain);
  return strain;
}

BulkResponse NonlinearSolid::evaluate(const Vector& displacement, std::span<const double> old, std::span<double> now, bool tangents,
                                      Scratch& scratch) const {
  const double* amplitudes = now.data() + first_amplitude();
  for (std::size_t p = 0; p < scratch.gradient.size(); ++p) scratch.strain[p] = strain(scratch.gradient[p], displacement, amplitudes);
  const BulkResponse response = law_->respond(
      {scratch.strain, old.data(), now.data(), scratch.stress.data(), tangents ? scratch.tangent.data() : nullptr, scratch.duration});
  scratch.mode_force.setZero(num_amplitudes());
  if (modes_ > 0)
    for (std::size_t p = 0; p < scratch.gradient.size(); ++p)
      add_force(scratch.gradient[p], dimension(), static_cast<int>(nodes().size()), modes_, scratch.stress[p], scratch.mode_force.data());
  return response;
}

Matrix NonlinearSolid::full_tangent(const Scratch& scratch, double elastic_share) const {
  const int d = dimension(), functions = static_cast<int>(nodes().size()) + modes_;
  Matrix k = Matrix::Zero(d * functions, d * functions), strain_of(6, d * functions);
  for (std::size_t p = 0; p < scratch.gradient.size(); ++p) {
    const PointGradient& at = scratch.gradient[p];
    for (int c = 0; c < d * functions; ++c) {
      const Vec3 unit = Vec3::Unit(c % d);
      Strain column = Strain::Zero();
      add_strain(at, d, c / d, 1, unit.data(), column);
      strain_of.col(c) = column;
    }
    k += at.volume * strain_of.transpose() * ((scratch.tangent[p] + elastic_share * law_->elastic()) * strain_of);
  }
  return k;
}

void NonlinearSolid::find_mode_tangent(Scratch& scratch, double elastic_share) const {
  constexpr int voigt[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  const int first = static_cast<int>(nodes().size()), n = num_amplitudes(), d = dimension();
  scratch.mode_stiffness.setZero(n, n);
  for (std::size_t p = 0; p < scratch.gradient.size(); ++p) {
    const PointGradient& at = scratch.gradient[p];
    const Mat6 tangent = scratch.tangent[p] + elastic_share * law_->elastic();
    for (int c = 0; c < n; ++c) {
      Stress stress = at.g[0][first + c / d] * tangent.col(voigt[c % d][0]);
      for (int j = 1; j < d; ++j) stress += at.g[j][first + c / d] * tangent.col(voigt[c % d][j]);
      add_force(at, d, first, modes_, stress, scratch.mode_stiffness.col(c).data());
    }
  }
}

// No force works on the modes: K_aa a + K_au u - int G^T D e dV = 0 with the inelastic strains e.
void NonlinearSolid::add_inelastic_amplitudes(std::span<const double> history, const Scratch& scratch, double* amplitudes) const {
  double force[most_amplitudes] = {};
  for (std::size_t p = 0; p < scratch.gradient.size(); ++p)
    add_force(scratch.gradient[p], dimension(), static_cast<int>(nodes().size()), modes_, law_->elastic() * inelastic_strain(history, p),
              force);
  small::multiply_add(mode_flexibility_, force, amplitudes);
}

BulkResponse NonlinearSolid::balance_modes(const Vector& displacement, std::span<const double> old, std::span<double> now, bool tangents,
                                           Scratch& scratch) const {
  const int n = num_amplitudes();
  Map amplitudes(now.data() + first_amplitude(), n);
  // round-off of the strain under a large rigid motion: 1e-13 of this is a few last digits of the displacement
  const double noise = 0.01 * law_->material().constrained() * displacement.cwiseAbs().maxCoeff() * node_gradient(scratch.gradient.front());
  double share = least_elastic_share, floor = least_elastic_share;
  std::array<double, most_amplitudes> from, step;
  const auto work = [&] { return std::inner_product(step.begin(), step.begin() + n, scratch.mode_force.data(), 0.0); };
  for (int iteration = 0; iteration < 200; ++iteration) {
    double scale = 0;  // N
    for (std::size_t p = 0; p < scratch.gradient.size(); ++p)
      scale += scratch.gradient[p].volume * mode_gradient(scratch.gradient[p]) * (scratch.stress[p].norm() + noise);
    const double rest = scratch.mode_force.norm();
    if (rest <= 1e-13 * scale) return {};
    if (iteration == 0 && !tangents)
      if (const BulkResponse response = evaluate(displacement, old, now, true, scratch); !response.converged) return response;
    find_mode_tangent(scratch, share);
    // a line search wants forces that descend a convex function; else more of the elastic stiffness shortens a step
    const bool associated = is_symmetric(n, scratch.mode_stiffness.data());
    std::copy_n(scratch.mode_force.data(), n, step.begin());
    std::copy_n(amplitudes.data(), n, from.begin());
    if (!small::gauss_solve<0>(n, scratch.mode_stiffness.data(), step.data())) break;
    LineSearch search(associated ? work() : 0);
    do {
      for (int k = 0; k < n; ++k) amplitudes[k] = from[static_cast<std::size_t>(k)] - search.share() * step[static_cast<std::size_t>(k)];
      if (const BulkResponse response = evaluate(displacement, old, now, true, scratch); !response.converged) return response;
    } while (scratch.mode_force.norm() > rest / 2 && search.goes_on(work()));
    if (scratch.mode_force.norm() >= rest && rest <= 1e-10 * scale) return {};  // round-off
    if (associated) {
      share = search.share() < 0.1 ? std::clamp(10 * share, 1e-6, 0.1) : std::max(share / 10, least_elastic_share);
    } else if (scratch.mode_force.norm() < rest) {
      share = std::max(share / 2, floor);
    } else {
      share = std::clamp(4 * share, 0.01, 2.0);
      floor = std::clamp(2 * floor, 1e-3, 0.5);
    }
  }
  return {false, "the incompatible modes of a yielding solid element find no balance in 200 iterations"};
}

BulkResponse NonlinearSolid::respond(const Vector& displacement, std::span<const double> old, std::span<double> now, Scratch& scratch,
                                     Vector* force, Matrix* tangent) const {
  assert(displacement.size() == unknowns());
  assert(static_cast<int>(old.size()) == num_history() && static_cast<int>(now.size()) == num_history());
  // where the update before changed the memory this one will: its modes need the tangents, and begin where that one has ended
  const bool again = modes_ > 0 && yields(old, now);
  std::array<double, most_amplitudes> last;
  if (again) std::copy_n(now.begin() + first_amplitude(), num_amplitudes(), last.begin());
  const bool side_by_side = !gradient_.empty() && points_ > 1;
  if (side_by_side && stays_elastic(displacement, old, now, scratch, force) && tangent == nullptr) {
    std::copy_n(old.begin(), first_amplitude(), now.begin());
    return {};
  }
  const bool tangents = tangent != nullptr || again;
  recall_gradients(scratch.gradient);
  scratch.strain.resize(scratch.gradient.size());
  scratch.stress.resize(scratch.gradient.size());
  scratch.tangent.resize(scratch.gradient.size());
  if (modes_ > 0 && !side_by_side) {
    // not a Map: what Eigen's lazy product rounds depends on where the memory begins
    small::multiply_any(modes_of_nodes_, displacement.data(), now.data() + first_amplitude());
    if (has_yielded(old)) add_inelastic_amplitudes(old, scratch, now.data() + first_amplitude());
  }
  std::array<double, most_amplitudes> elastic;
  std::copy_n(now.begin() + first_amplitude(), num_amplitudes(), elastic.begin());
  const auto update_from = [&](const std::array<double, most_amplitudes>& amplitudes) {
    std::copy_n(amplitudes.begin(), num_amplitudes(), now.begin() + first_amplitude());
    const BulkResponse response = evaluate(displacement, old, now, tangents, scratch);
    const bool balance = response.converged && modes_ > 0 && (again || yields(old, now));
    return balance ? balance_modes(displacement, old, now, tangents, scratch) : response;
  };
  BulkResponse outcome = update_from(again ? last : elastic);
  if (!outcome.converged && again) outcome = update_from(elastic);

  if (force) {
    force->setZero(unknowns());
    for (std::size_t p = 0; p < scratch.gradient.size(); ++p)
      add_force(scratch.gradient[p], dimension(), 0, static_cast<int>(nodes().size()), scratch.stress[p], force->data());
  }
  if (!tangent) return outcome;
  const Matrix k = full_tangent(scratch, least_elastic_share);
  const Index keep = unknowns(), modes = k.rows() - keep;
  *tangent = k.topLeftCorner(keep, keep);
  if (modes > 0)
    *tangent -= k.topRightCorner(keep, modes) * PartialLu(k.bottomRightCorner(modes, modes)).solve(k.bottomLeftCorner(modes, keep));
  return outcome;
}

std::vector<Stress> NonlinearSolid::point_stress(const Vector& displacement, std::span<const double> history) const {
  std::vector<Stress> stress;
  for (const PointGradient& at : gradients()) {
    const Strain total = strain(at, displacement, history.data() + first_amplitude());
    stress.push_back(law_->elastic() * (total - inelastic_strain(history, stress.size())));
  }
  return stress;
}

std::vector<Stress> NonlinearSolid::node_stress(const Vector& displacement, std::span<const double> history) const {
  return extrapolate(point_stress(displacement, history));
}

std::vector<ElementOutput> NonlinearSolid::outputs() const {
  std::vector<ElementOutput> all = Solid::outputs();
  for (const BulkOutput& each : law_->outputs()) all.push_back({std::string(each.name), std::string(each.unit)});
  return all;
}

std::vector<double> NonlinearSolid::at_nodes(std::size_t k, const Vector& displacement, std::span<const double> history) const {
  const std::vector<double> natural(history.empty() ? static_cast<std::size_t>(num_history()) : 0, 0.0);
  if (history.empty() && k == 0) return Solid::at_nodes(k, displacement, history);
  if (history.empty()) history = natural;
  if (k == 0) return in_one_list(node_stress(displacement, history));
  std::vector<double> values(law_->outputs().size()), at_points;
  for (int p = 0; p < points_; ++p) {
    law_->find_outputs(history.data() + size_ * p, values.data());
    at_points.push_back(values[k - 1]);
  }
  return extrapolate(at_points);
}

double NonlinearSolid::stored_energy(const Vector& displacement, std::span<const double> history) const {
  double sum = 0;
  std::size_t p = 0;
  for (const PointGradient& at : gradients()) {
    const Strain recoverable = strain(at, displacement, history.data() + first_amplitude()) - inelastic_strain(history, p);
    sum += at.volume * (recoverable.dot(law_->elastic() * recoverable) / 2 + locked_energy(history, p));
    ++p;
  }
  return sum;
}

bool NonlinearSolid::has_yielded(std::span<const double> history) const {
  for (int p = 0; p < points_; ++p) {
    const double* e = history.data() + size_ * p;
    if (std::any_of(e, e + 6, [](double value) { return value != 0; })) return true;
  }
  return false;
}

bool NonlinearSolid::yields(std::span<const double> old, std::span<const double> now) const {
  for (int p = 0; p < points_; ++p) {
    const double* was = old.data() + size_ * p;
    if (!std::equal(was, was + 6, now.data() + size_ * p)) return true;
  }
  return false;
}

// With the amplitudes of the linear solid taken off, the modes a answer the inelastic strains e alone: int G^T D (G a - e) dV = 0. The
// stress s = D (G a - e) is what yielding adds to the linear one, which is in balance with the modes as s is; so the mixed terms of the
// energy are those with the nodes.
void NonlinearSolid::find_inelastic(std::span<const double> history, Scratch& scratch, Inelastic& made) const {
  recall_gradients(scratch.gradient);
  find_inelastic_of_response(history, scratch, made);
}

void NonlinearSolid::find_inelastic_of_response(std::span<const double> history, Scratch& scratch, Inelastic& made) const {
  const int count = static_cast<int>(nodes().size()), d = dimension();
  double amplitudes[most_amplitudes] = {};
  if (modes_ > 0) add_inelastic_amplitudes(history, scratch, amplitudes);
  made.force.setZero(unknowns());
  made.energy = 0;
  for (std::size_t p = 0; p < scratch.gradient.size(); ++p) {
    const PointGradient& at = scratch.gradient[p];
    Strain strain = -inelastic_strain(history, p);
    add_strain(at, d, count, modes_, amplitudes, strain);
    const Stress stress = law_->elastic() * strain;
    add_force(at, d, 0, count, stress, made.force.data());
    made.energy += at.volume * stress.dot(strain) / 2;
    made.energy += at.volume * locked_energy(history, p);
  }
}

double NonlinearSolid::dissipated(const Vector& from, std::span<const double> old, const Vector& to, std::span<const double> now) const {
  double sum = 0;
  std::vector<PointGradient> made;
  if (gradient_.empty()) made = gradients();
  PointGradient kept;
  for (std::size_t p = 0; p < static_cast<std::size_t>(points_); ++p) {
    if (!gradient_.empty()) recall_gradient(static_cast<int>(p), kept);
    const PointGradient& at = gradient_.empty() ? made[p] : kept;
    const ConstMap before = inelastic_strain(old, p), after = inelastic_strain(now, p);
    const Strain recoverable =
        strain(at, from, old.data() + first_amplitude()) + strain(at, to, now.data() + first_amplitude()) - before - after;
    sum += at.volume * (law_->elastic() * recoverable).dot(after - before) / 2;
    sum -= at.volume * (locked_energy(now, p) - locked_energy(old, p));
  }
  return sum;
}

}  // namespace uplift
