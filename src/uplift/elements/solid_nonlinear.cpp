#include "uplift/elements/solid_nonlinear.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "uplift/elements/solid_rules.h"
#include "uplift/math/dense.h"

namespace uplift {

namespace {

/// A point at the apex has no stiffness at all: this share of the elastic one, added to every tangent, keeps matrices regular.
constexpr double least_elastic_share = 1e-9;

SolidSection with_material(SolidSection section, const ElasticMaterial& material) {
  section.material = material;
  return section;
}

}  // namespace

/// The integration points during one update.
struct NonlinearSolid::Points {
  std::vector<PointGradient> gradient;
  std::vector<Stress> stress;
  std::vector<Mat6> tangent;
  Vector mode_force;  // N: zero when the modes are in balance
  double scale = 0;   // N: what mode_force is compared with
};

double NonlinearSolid::mode_gradient(const PointGradient& at) const {
  double sum = 0;
  for (int i = 0; i < dimension(); ++i)
    for (int k = 0; k < num_modes(); ++k) sum = std::hypot(sum, at.g[i][static_cast<int>(nodes().size()) + k]);
  return sum;
}

double NonlinearSolid::node_gradient(const PointGradient& at) const {
  double largest = 0;
  for (int i = 0; i < dimension(); ++i)
    for (std::size_t a = 0; a < nodes().size(); ++a) largest = std::max(largest, std::abs(at.g[i][a]));
  return largest;
}

NonlinearSolid::NonlinearSolid(Cell cell, std::span<const int> nodes, Coordinates coordinates, SolidSection section,
                               const DruckerPragerParameters& law)
    : Solid(cell, nodes, std::move(coordinates), with_material(section, law.elastic)), law_(law) {
  assert(dimension() == 3 || section.plane == PlaneState::strain);
}

int NonlinearSolid::num_history() const {
  return first_amplitude() + dimension() * num_modes();
}

Strain NonlinearSolid::strain(const PointGradient& at, const Vector& displacement, const double* amplitudes) const {
  const int count = static_cast<int>(nodes().size());
  Strain strain = Strain::Zero();
  add_strain(at, dimension(), 0, count, displacement.data(), strain);
  add_strain(at, dimension(), count, num_modes(), amplitudes, strain);
  return strain;
}

void NonlinearSolid::evaluate(const Vector& displacement, std::span<const double> old, std::span<double> now, Points& points) const {
  constexpr auto size = static_cast<std::size_t>(DruckerPrager::num_history);
  const int count = static_cast<int>(nodes().size());
  const double* amplitudes = now.data() + first_amplitude();
  points.mode_force.setZero(dimension() * num_modes());
  points.scale = 0;
  // round-off of the strain under a large rigid motion: 1e-13 of this is a few last digits of the displacement
  const double noise =
      0.01 * law_.parameters().elastic.constrained() * displacement.cwiseAbs().maxCoeff() * node_gradient(points.gradient.front());
  for (std::size_t p = 0; p < points.gradient.size(); ++p) {
    const PointGradient& at = points.gradient[p];
    points.stress[p] =
        law_.respond(strain(at, displacement, amplitudes), old.subspan(size * p, size), now.subspan(size * p, size), &points.tangent[p]);
    if (num_modes() == 0) continue;
    add_force(at, dimension(), count, num_modes(), points.stress[p], points.mode_force.data());
    points.scale += at.volume * mode_gradient(at) * (points.stress[p].norm() + noise);
  }
}

Matrix NonlinearSolid::full_tangent(const Points& points, double elastic_share, int first) const {
  const Mat6 elastic = elastic_share * elastic_matrix(law_.parameters().elastic);
  const int d = dimension(), functions = static_cast<int>(nodes().size()) + num_modes() - first;
  Matrix k = Matrix::Zero(d * functions, d * functions), strain_of(6, d * functions);
  for (std::size_t p = 0; p < points.gradient.size(); ++p) {
    const PointGradient& at = points.gradient[p];
    for (int c = 0; c < d * functions; ++c) {
      const Vec3 unit = Vec3::Unit(c % d);
      Strain column = Strain::Zero();
      add_strain(at, d, first + c / d, 1, unit.data(), column);
      strain_of.col(c) = column;
    }
    k += at.volume * strain_of.transpose() * ((points.tangent[p] + elastic) * strain_of);
  }
  return k;
}

BulkResponse NonlinearSolid::balance_modes(const Vector& displacement, std::span<const double> old, std::span<double> now,
                                           Points& points) const {
  const Index n = dimension() * num_modes();
  const auto first = static_cast<std::size_t>(first_amplitude());
  std::copy(old.begin() + static_cast<std::ptrdiff_t>(first), old.end(), now.begin() + static_cast<std::ptrdiff_t>(first));
  Map amplitudes(now.data() + first, n);
  evaluate(displacement, old, now, points);
  double share = least_elastic_share, floor = least_elastic_share;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const double rest = points.mode_force.norm();
    if (rest <= 1e-13 * points.scale) return {};
    amplitudes -= PartialLu(full_tangent(points, share, static_cast<int>(nodes().size()))).solve(points.mode_force);
    evaluate(displacement, old, now, points);
    if (points.mode_force.norm() < rest) {
      share = std::max(share / 2, floor);
    } else {
      if (rest <= 1e-10 * points.scale) return {};  // round-off
      share = std::clamp(4 * share, 0.01, 2.0);
      floor = std::clamp(2 * floor, 1e-3, 0.5);
    }
  }
  return {false, "the incompatible modes of a yielding solid element find no balance in 200 iterations"};
}

BulkResponse NonlinearSolid::respond(const Vector& displacement, std::span<const double> old, std::span<double> now, Vector& force,
                                     Matrix* tangent) const {
  assert(displacement.size() == unknowns());
  assert(static_cast<int>(old.size()) == num_history() && static_cast<int>(now.size()) == num_history());
  const auto count = static_cast<std::size_t>(num_points());
  Points points{gradients(), std::vector<Stress>(count), std::vector<Mat6>(count), {}};
  BulkResponse outcome;
  if (num_modes() > 0)
    outcome = balance_modes(displacement, old, now, points);
  else
    evaluate(displacement, old, now, points);

  force.setZero(unknowns());
  for (std::size_t p = 0; p < count; ++p)
    add_force(points.gradient[p], dimension(), 0, static_cast<int>(nodes().size()), points.stress[p], force.data());
  if (!tangent) return outcome;
  const Matrix k = full_tangent(points, least_elastic_share);
  const Index keep = unknowns(), modes = k.rows() - keep;
  *tangent = k.topLeftCorner(keep, keep);
  if (modes > 0)
    *tangent -= k.topRightCorner(keep, modes) * PartialLu(k.bottomRightCorner(modes, modes)).solve(k.bottomLeftCorner(modes, keep));
  return outcome;
}

std::vector<Stress> NonlinearSolid::point_stress(const Vector& displacement, std::span<const double> history) const {
  std::vector<Stress> stress;
  std::array<double, DruckerPrager::num_history> unused;
  std::size_t first = 0;
  for (const PointGradient& at : gradients()) {
    const auto of_point = history.subspan(first, DruckerPrager::num_history);
    first += DruckerPrager::num_history;
    stress.push_back(law_.respond(strain(at, displacement, history.data() + first_amplitude()), of_point, unused, nullptr));
  }
  return stress;
}

std::vector<Stress> NonlinearSolid::node_stress(const Vector& displacement, std::span<const double> history) const {
  return extrapolate(point_stress(displacement, history));
}

double NonlinearSolid::stored_energy(const Vector& displacement, std::span<const double> history) const {
  double sum = 0;
  std::size_t first = 0;
  for (const PointGradient& at : gradients()) {
    const auto of_point = history.subspan(first, DruckerPrager::num_history);
    first += DruckerPrager::num_history;
    sum += at.volume * law_.stored_energy(strain(at, displacement, history.data() + first_amplitude()), of_point);
  }
  return sum;
}

bool NonlinearSolid::has_yielded(std::span<const double> history) const {
  for (int p = 0; p < num_points(); ++p)
    if (history[static_cast<std::size_t>(DruckerPrager::num_history * p + 6)] > 0) return true;
  return false;
}

bool NonlinearSolid::yields(std::span<const double> old, std::span<const double> now) const {
  for (int p = 0; p < num_points(); ++p) {
    const auto at = static_cast<std::size_t>(DruckerPrager::num_history * p + 6);
    if (now[at] > old[at]) return true;
  }
  return false;
}

// With the amplitudes of the linear solid taken off, the modes a answer the plastic strains e alone: int G^T D (G a - e) dV = 0. The stress
// s = D (G a - e) is what yielding adds to the linear one, which is in balance with the modes as s is; so the mixed terms of the energy are
// those with the nodes.
NonlinearSolid::Yielded NonlinearSolid::yielded(std::span<const double> history) const {
  const int count = static_cast<int>(nodes().size()), d = dimension();
  const Mat6 elastic = elastic_matrix(law_.parameters().elastic);
  Points points{gradients(), {}, std::vector<Mat6>(static_cast<std::size_t>(num_points()), Mat6::Zero()), {}};
  const auto plastic = [&](std::size_t p) { return ConstMap(history.data() + DruckerPrager::num_history * p, 6); };
  Vector amplitudes = Vector::Zero(d * num_modes());
  if (num_modes() > 0) {
    for (std::size_t p = 0; p < points.gradient.size(); ++p)
      add_force(points.gradient[p], d, count, num_modes(), elastic * plastic(p), amplitudes.data());
    amplitudes = PartialLu(full_tangent(points, 1, count)).solve(amplitudes).eval();
  }
  Yielded made;
  made.force.setZero(unknowns());
  for (std::size_t p = 0; p < points.gradient.size(); ++p) {
    const PointGradient& at = points.gradient[p];
    Strain strain = -plastic(p);
    add_strain(at, d, count, num_modes(), amplitudes.data(), strain);
    const Stress stress = elastic * strain;
    add_force(at, d, 0, count, stress, made.force.data());
    made.energy += at.volume * stress.dot(strain) / 2;
  }
  return made;
}

double NonlinearSolid::dissipated(const Vector& from, std::span<const double> old, const Vector& to, std::span<const double> now) const {
  const Mat6 elastic = elastic_matrix(law_.parameters().elastic);
  double sum = 0;
  std::size_t first = 0;
  for (const PointGradient& at : gradients()) {
    const ConstMap before(old.data() + first, 6), after(now.data() + first, 6);
    first += DruckerPrager::num_history;
    const Strain recoverable =
        strain(at, from, old.data() + first_amplitude()) + strain(at, to, now.data() + first_amplitude()) - before - after;
    sum += at.volume * (elastic * recoverable).dot(after - before) / 2;
  }
  return sum;
}

}  // namespace uplift
