#include <gtest/gtest.h>

#include "manual.h"
#include "solids_support.h"
#include "uplift/math/fixed.h"

// Claim: displacements converge with h^(p+1) (L2 norm), strains with h^p (energy norm), p = 1 for linear, 2 for second-order cells.
// Source: manufactured solution u = sum of a sin(q . x + phase), for which div stress is closed form. Tolerance 0.1 in the order.
namespace uplift::verification::solids_orders_test {
namespace {

constexpr double young = 1, poisson = 0.3;

struct Ripple {
  Vec3 amplitude, wave;
  double phase;
};

/// Exact displacement, its gradient and the body force that it needs.
struct Exact {
  std::vector<Ripple> ripples;
  double lambda, mu;

  Vec3 displacement(const Vec3& x) const {
    Vec3 u = Vec3::Zero();
    for (const Ripple& r : ripples) u += r.amplitude * std::sin(r.wave.dot(x) + r.phase);
    return u;
  }
  Mat3 gradient(const Vec3& x) const {
    Mat3 g = Mat3::Zero();
    for (const Ripple& r : ripples) g += r.amplitude * r.wave.transpose() * std::cos(r.wave.dot(x) + r.phase);
    return g;
  }
  /// -div(lambda tr e I + 2 mu e) = sin (.) ((lambda + mu) (a . q) q + mu |q|^2 a)
  Vec3 force(const Vec3& x) const {
    Vec3 f = Vec3::Zero();
    for (const Ripple& r : ripples)
      f += std::sin(r.wave.dot(x) + r.phase) * ((lambda + mu) * r.amplitude.dot(r.wave) * r.wave + mu * r.wave.squaredNorm() * r.amplitude);
    return f;
  }
  double energy(const Mat3& gradient_of_error) const {
    const Mat3 e = (gradient_of_error + gradient_of_error.transpose()) / 2;
    return lambda * e.trace() * e.trace() + 2 * mu * e.squaredNorm();
  }
};

Exact manufactured(int dimension, PlaneState plane) {
  Exact exact;
  exact.ripples = {{{1, 0.5, -0.4}, {2.1, 1.3, -1.1}, 0.3}, {{-0.3, 0.8, 0.6}, {-1.2, 2.2, 0.9}, 1.1}};
  if (dimension == 2)
    for (Ripple& r : exact.ripples) r.amplitude.z() = r.wave.z() = 0;
  exact.mu = young / (2 * (1 + poisson));
  exact.lambda =
      plane == PlaneState::stress ? young * poisson / (1 - poisson * poisson) : young * poisson / ((1 + poisson) * (1 - 2 * poisson));
  return exact;
}

/// Runs over the points of a rule of every cell: place, shape functions, their gradients and the volume.
template <class Visit>
void for_points(const SmallMesh& mesh, int degree, const Visit& visit) {
  const int d = info(mesh.cell).dimension;
  const CellRule rule = cell_rule(mesh.cell, degree);
  for (const auto& nodes : mesh.cells) {
    std::vector<Vec3> places;
    for (const int n : nodes) places.push_back((*mesh.nodes)[static_cast<std::size_t>(n)]);
    for (std::size_t p = 0; p < rule.point.size(); ++p) {
      const CellShape shape = cell_shape(mesh.cell, rule.point[p]);
      Mat3 jacobian = Mat3::Identity();  // columns dx/dr_k
      for (int k = 0; k < d; ++k) jacobian.col(k) = cell_tangent(shape, places, k);
      const double det = jacobian.col(0).dot(Vec3(jacobian(1, 1) * jacobian(2, 2) - jacobian(2, 1) * jacobian(1, 2),
                                                  jacobian(2, 1) * jacobian(0, 2) - jacobian(0, 1) * jacobian(2, 2),
                                                  jacobian(0, 1) * jacobian(1, 2) - jacobian(1, 1) * jacobian(0, 2)));
      visit(nodes, shape, cell_position(shape, places), jacobian, rule.weight[p] * det);
    }
  }
}

Mat3 inverse(const Mat3& m) {
  const Vec3 a = m.row(0), b = m.row(1), c = m.row(2);
  const auto cross = [](const Vec3& x, const Vec3& y) {
    return Vec3(x.y() * y.z() - x.z() * y.y(), x.z() * y.x() - x.x() * y.z(), x.x() * y.y() - x.y() * y.x());
  };
  Mat3 out;
  out << cross(b, c), cross(c, a), cross(a, b);
  return out / a.dot(cross(b, c));
}

struct Errors {
  double displacement = 0, energy = 0;
};

Errors errors(Cell cell, bool modes, PlaneState plane, int n) {
  const int d = info(cell).dimension;
  const Vec3 size(1, 1, 1);
  // a smooth distortion: cells become parallel-sided as the mesh is refined, as in graded meshes
  const SmallMesh mesh = small_mesh(cell, size, {n, n, n}, [&](const Vec3& x) {
    return Vec3(x.x() + 0.1 * std::sin(2 * x.y() + x.z()), x.y() + 0.1 * x.x() * x.x() - 0.05 * x.z(),
                d == 2 ? 0 : x.z() + 0.1 * std::cos(x.x() + 2 * x.y()));
  });
  SolidSection section;
  section.material = {young, poisson, 0};
  section.plane = plane;
  section.incompatible_modes = modes;
  const SolidSystem system = assemble(mesh, section);
  const Exact exact = manufactured(d, plane);
  Vector force = Vector::Zero(system.stiffness.rows()), u(force.size());
  for_points(mesh, 6, [&](const std::vector<int>& nodes, const CellShape& shape, const Vec3& x, const Mat3&, double volume) {
    for (std::size_t a = 0; a < nodes.size(); ++a) force.segment(d * nodes[a], d) += volume * shape.value[a] * exact.force(x).head(d);
  });
  for (std::size_t a = 0; a < mesh.nodes->size(); ++a)
    u.segment(d * static_cast<Index>(a), d) = exact.displacement((*mesh.nodes)[a]).head(d);
  solve_held(system.stiffness, force, held_where(mesh, [&](const Vec3& x) { return on_surface(x, size, d); }), u);
  Errors error;
  for_points(mesh, 6, [&](const std::vector<int>& nodes, const CellShape& shape, const Vec3& x, const Mat3& jacobian, double volume) {
    const Mat3 back = inverse(jacobian);
    Vec3 miss = exact.displacement(x);
    Mat3 gradient = exact.gradient(x);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      Vec3 value = Vec3::Zero();
      value.head(d) = u.segment(d * nodes[a], d);
      const Vec3 slope = back.transpose() * Vec3(shape.slope[a][0], shape.slope[a][1], shape.slope[a][2]);
      miss -= shape.value[a] * value;
      gradient -= value * slope.transpose();
    }
    error.displacement += volume * miss.squaredNorm();
    error.energy += volume * exact.energy(gradient);
  });
  return {std::sqrt(error.displacement), std::sqrt(error.energy)};
}

TEST(SolidsOrders, ManufacturedSolutions) {
  VERIFIES({"Solids", "Order of all solids", "Manufactured solution: body forces of sines in closed form"});
  for (const CellInfo& cell : all_cells()) {
    if (cell.dimension < 2) continue;
    const bool quadratic = cell.nodes > cell.corners, can = cell.cell == Cell::quad4 || cell.cell == Cell::hex8;
    const int coarse = cell.dimension == 2 ? 8 : quadratic ? 3 : 5, fine = cell.dimension == 2 ? 16 : quadratic ? 5 : 9;
    const int p = quadratic ? 2 : 1;
    for (const bool modes : {false, true})
      for (const PlaneState plane : {PlaneState::strain, PlaneState::stress}) {
        if ((modes && !can) || (cell.dimension == 3 && plane == PlaneState::stress)) continue;
        const Errors a = errors(cell.cell, modes, plane, coarse), b = errors(cell.cell, modes, plane, fine);
        const double ratio = std::log(static_cast<double>(fine) / coarse);
        const double of_displacement = std::log(a.displacement / b.displacement) / ratio, of_energy = std::log(a.energy / b.energy) / ratio;
        const std::string name = std::string(cell.name) + (modes ? ", modes" : "") + (plane == PlaneState::stress ? ", plane stress" : "");
        RecordProperty("order of displacement, " + name, std::to_string(of_displacement));
        RecordProperty("order of energy, " + name, std::to_string(of_energy));
        VERIFY_GE("order of the displacement (compared with p + 1 − 0.1)", "1", of_displacement, p + 1 - 0.1) << name;
        VERIFY_GE("order of the energy norm, lower bound", "1", of_energy, p - 0.1) << name;
        VERIFY_LE("order of the energy norm, upper bound", "1", of_energy, p + 0.2) << name;
      }
  }
}

}  // namespace
}  // namespace uplift::verification::solids_orders_test
