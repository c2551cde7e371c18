#include "uplift/elements/solid_nonlinear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "unit/elements/solid_support.h"
#include "uplift/elements/bulk_laws/drucker_prager.h"
#include "uplift/math/dense.h"

namespace uplift::solid_nonlinear_test {
namespace {

DruckerPragerParameters clay(double cohesion, double dilation) {
  DruckerPragerParameters p;
  p.elastic = {3e9, 0.3, 2000};
  p.cohesion = cohesion;
  p.friction = 0.5;
  p.dilation = dilation;
  p.hardening = 2e7;
  return p;
}

NonlinearSolid yielding(const SolidKind& kind, const std::vector<Vec3>& positions, const DruckerPragerParameters& law) {
  return NonlinearSolid(kind.cell, first_numbers(info(kind.cell).nodes), std::make_shared<const std::vector<Vec3>>(positions),
                        section_of(kind), std::make_shared<const DruckerPrager>(law));
}

std::vector<SolidKind> nonlinear_kinds() {
  std::vector<SolidKind> kinds;
  for (const SolidKind& kind : solid_kinds())
    if (kind.plane == PlaneState::strain) kinds.push_back(kind);
  return kinds;
}

Vector random_displacement(Index n, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-size, size);
  Vector u(n);
  for (double& x : u) x = uniform(random);
  return u;
}

double accumulated(const NonlinearSolid& solid, const std::vector<double>& history) {
  double sum = 0;
  for (int p = 0; p < solid.num_points(); ++p) sum += history[static_cast<std::size_t>(p * DruckerPrager::history_size + 6)];
  return sum;
}

TEST(SolidNonlinear, BelowYieldItIsTheLinearSolid) {
  std::mt19937 random(31);
  for (const SolidKind& kind : nonlinear_kinds()) {
    const auto positions = distorted_nodes(kind.cell, 0.15, random);
    const NonlinearSolid solid = yielding(kind, positions, clay(1e12, 0.2));
    const Vector u = random_displacement(solid.unknowns(), 1e-4, random);
    const std::vector<double> old(static_cast<std::size_t>(solid.num_history()), 0.0);
    std::vector<double> now(old.size());
    NonlinearSolid::Scratch scratch;
    Vector force;
    Matrix tangent, k;
    const BulkResponse outcome = solid.respond(u, old, now, scratch, &force, &tangent);
    ASSERT_TRUE(outcome.converged) << kind.name << outcome.why;
    solid.form({&k, nullptr, nullptr});
    EXPECT_LE((tangent - k).norm(), 1.001e-9 * k.norm()) << kind.name;  // the share of the elastic stiffness that every tangent has
    EXPECT_LE((force - k * u).norm(), 1e-12 * force.norm()) << kind.name;
    EXPECT_NEAR(solid.stored_energy(u, now), u.dot(k * u) / 2, 1e-12 * u.dot(k * u)) << kind.name;
    const auto linear = static_cast<const Solid&>(solid).point_stress(u), here = solid.point_stress(u, now);
    for (std::size_t p = 0; p < here.size(); ++p) EXPECT_LE((here[p] - linear[p]).norm(), 1e-11 * linear[p].norm()) << kind.name;
  }
}

/// An update begins with the incompatible modes of the update before it. Soil without dilatancy and hardening may find no balance from
/// there, but always where it finds one from the elastic modes.
TEST(SolidNonlinear, AnUpdateFarFromTheLastOneStillConverges) {
  std::mt19937 random(40);
  int compared = 0;
  for (const SolidKind& kind : nonlinear_kinds()) {
    DruckerPragerParameters law = clay(2e5, 0);
    law.hardening = 0;
    NonlinearSolid::Scratch scratch;
    Vector force;
    for (int draw = 0; draw < 150; ++draw) {
      const auto positions = distorted_nodes(kind.cell, 0.1, random);
      const NonlinearSolid solid = yielding(kind, positions, law);
      const std::vector<double> natural(static_cast<std::size_t>(solid.num_history()), 0.0);
      std::vector<double> anew = natural, on = natural;
      Mat3 shear = -1e-4 * Mat3::Identity();
      shear(0, 1) = 1e-3;
      const Vector u = linear_field(positions, solid.dimension(), shear) + random_displacement(solid.unknowns(), 1e-3, random);
      if (!solid.respond(0.5 * u, natural, anew, scratch, &force, nullptr).converged) continue;
      if (!solid.respond(u, natural, on, scratch, &force, nullptr).converged) continue;
      ++compared;
      EXPECT_TRUE(solid.respond(0.5 * u, natural, on, scratch, &force, nullptr).converged) << kind.name << ", " << draw;
    }
  }
  EXPECT_GT(compared, 300);
}

/// Where no point yields, an update takes a short way unless the tangent is asked for. Small steps around a state that has yielded before:
/// both ways remember the same and give the same force, and some of the steps yield, others do not.
TEST(SolidNonlinear, TheShortWayIsThatOfTheWholeUpdate) {
  std::mt19937 random(39);
  for (const SolidKind& kind : nonlinear_kinds()) {
    const auto positions = distorted_nodes(kind.cell, 0.1, random);
    const NonlinearSolid solid = yielding(kind, positions, clay(2e5, 0.1));
    const int n = solid.unknowns(), d = solid.dimension();
    const Vector pressed = linear_field(positions, d, -1e-4 * Mat3::Identity());
    NonlinearSolid::Scratch scratch;
    Vector force, whole;
    Matrix tangent;
    const std::vector<double> natural(static_cast<std::size_t>(solid.num_history()), 0.0);
    std::vector<double> old = natural, now = natural, expected = natural;
    Mat3 shear = Mat3::Zero();
    shear(0, 1) = 1e-3;
    const Vector u = pressed + linear_field(positions, d, shear) + random_displacement(n, 1e-5, random);
    ASSERT_TRUE(solid.respond(u, natural, old, scratch, &force, nullptr).converged) << kind.name;
    ASSERT_TRUE(solid.has_yielded(old)) << kind.name;
    int elastic = 0, plastic = 0;
    for (const double size : {1e-8, 1e-7, 1e-6, 1e-5})
      for (int draw = 0; draw < 10; ++draw) {
        const double on = draw % 2 == 0 ? 0.05 : -0.05;  // of the way from the pressed state
        const Vector next = u + on * (u - pressed) + random_displacement(n, size, random);
        ASSERT_TRUE(solid.respond(next, old, expected, scratch, &whole, &tangent).converged) << kind.name;
        ASSERT_TRUE(solid.respond(next, old, now, scratch, &force, nullptr).converged) << kind.name;
        ++(solid.yields(old, expected) ? plastic : elastic);
        EXPECT_EQ(solid.yields(old, now), solid.yields(old, expected)) << kind.name << ", " << size;
        for (std::size_t k = 0; k < now.size(); ++k) EXPECT_NEAR(now[k], expected[k], 1e-14) << kind.name << ", " << size;
        EXPECT_LE((force - whole).norm(), 1e-12 * whole.norm()) << kind.name << ", " << size;
      }
    EXPECT_GT(elastic, 3) << kind.name;
    EXPECT_GT(plastic, 3) << kind.name;
  }
}

TEST(SolidNonlinear, TangentIsTheFiniteDifferenceOfTheForce) {
  std::mt19937 random(32);
  for (const SolidKind& kind : nonlinear_kinds())
    for (const double dilation : {0.1, 0.5}) {
      const auto positions = distorted_nodes(kind.cell, 0.1, random);
      const NonlinearSolid solid = yielding(kind, positions, clay(2e5, dilation));
      const int n = solid.unknowns(), d = solid.dimension();
      // pressed, then sheared at random: the cone everywhere
      const Vector pressed = linear_field(positions, d, -1e-4 * Mat3::Identity());
      NonlinearSolid::Scratch scratch;
      Vector u, force, up, down;
      Matrix tangent;
      const std::vector<double> natural(static_cast<std::size_t>(solid.num_history()), 0.0);
      std::vector<double> old = natural, now = natural;
      for (int draw = 0; draw < 20 && !(accumulated(solid, now) > accumulated(solid, old)); ++draw) {  // one that yields twice
        u = pressed + random_displacement(n, 2e-3, random);
        ASSERT_TRUE(solid.respond(0.6 * u, natural, old, scratch, &force, nullptr).converged) << kind.name;
        ASSERT_TRUE(solid.respond(u, old, now, scratch, &force, &tangent).converged) << kind.name;
      }
      ASSERT_GT(accumulated(solid, now), accumulated(solid, old)) << kind.name;
      const double h = 1e-9;
      int compared = 0;
      for (int k = 0; k < n; ++k) {
        const auto status = [&](const std::vector<double>& of) {
          std::vector<bool> yields;
          for (int p = 0; p < solid.num_points(); ++p) {
            const auto at = static_cast<std::size_t>(p * DruckerPrager::history_size + 6);
            yields.push_back(of[at] > old[at]);
          }
          return yields;
        };
        const auto here = status(now);
        std::vector<double> other = now;
        solid.respond(u + h * Vector::Unit(n, k), old, other, scratch, &up, nullptr);
        const bool same_up = status(other) == here;
        solid.respond(u - h * Vector::Unit(n, k), old, other, scratch, &down, nullptr);
        if (!same_up || status(other) != here) continue;  // a kink lies between
        ++compared;
        EXPECT_LE(((up - down) / (2 * h) - tangent.col(k)).norm(), 1e-6 * tangent.norm()) << kind.name << ", unknown " << k;
      }
      EXPECT_GE(compared, n / 2) << kind.name;
      if (dilation == 0.5) EXPECT_LE((tangent - tangent.transpose()).norm(), 1e-12 * tangent.norm()) << kind.name;
    }
}

TEST(SolidNonlinear, UniformStrainGivesThePointsStress) {
  // patch test of one element beyond yield: the forces are those of the uniform stress on the sides
  std::mt19937 random(33);
  for (const SolidKind& kind : nonlinear_kinds()) {
    const auto positions = distorted_nodes(kind.cell, 0.15, random);
    const DruckerPragerParameters p = clay(2e5, 0.2);
    const NonlinearSolid solid = yielding(kind, positions, p);
    const int d = solid.dimension();
    Mat3 g = Mat3::Zero();
    g.topLeftCorner<2, 2>() << -4e-4, 2e-3, 1e-3, 1e-4;
    if (d == 3) g(2, 0) = 7e-4, g(2, 2) = -1e-4;
    Strain strain;
    strain << g(0, 0), g(1, 1), g(2, 2), g(0, 1) + g(1, 0), g(1, 2) + g(2, 1), g(2, 0) + g(0, 2);
    std::vector<double> old(static_cast<std::size_t>(solid.num_history()), 0.0), now = old;
    NonlinearSolid::Scratch scratch;
    Vector force;
    ASSERT_TRUE(solid.respond(linear_field(positions, d, g), old, now, scratch, &force, nullptr).converged) << kind.name;
    ASSERT_GT(accumulated(solid, now), 0) << kind.name;
    const std::vector<double> zero(DruckerPrager::history_size, 0.0);
    std::vector<double> point(DruckerPrager::history_size);
    const Stress s = DruckerPrager(p).respond(strain, zero, point, nullptr);
    for (const Stress& at_node : solid.node_stress(linear_field(positions, d, g), now))
      EXPECT_LE((at_node - s).norm(), 1e-11 * s.norm()) << kind.name;
    // virtual work with any other uniform gradient
    Mat3 other = Mat3::Zero();
    other.topLeftCorner<2, 2>() << 3, -1, 2, 5;
    if (d == 3) other(0, 2) = 1, other(2, 2) = -4;
    Mat3 tensor;
    tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    const double work = solid.volume() * (tensor * other.transpose()).trace();
    EXPECT_NEAR(linear_field(positions, d, other).dot(force), work, 1e-11 * solid.volume() * s.norm() * other.norm()) << kind.name;
  }
}

TEST(SolidNonlinear, RigidMotionsOfAYieldedElementChangeNothing) {
  std::mt19937 random(34);
  for (const SolidKind& kind : nonlinear_kinds()) {
    const auto positions = distorted_nodes(kind.cell, 0.15, random);
    const NonlinearSolid solid = yielding(kind, positions, clay(2e5, 0.2));
    const int d = solid.dimension();
    const Vector u = linear_field(positions, d, -1e-3 * Mat3::Identity()) + random_displacement(solid.unknowns(), 1e-3, random);
    std::vector<double> old(static_cast<std::size_t>(solid.num_history()), 0.0), now = old;
    NonlinearSolid::Scratch scratch;
    Vector force, moved;
    ASSERT_TRUE(solid.respond(u, old, now, scratch, &force, nullptr).converged) << kind.name;
    Vector far = u;
    for (Index a = 0; a < far.size(); a += d) far[a] += 0.5, far[a + 1] -= 0.3;
    ASSERT_TRUE(solid.respond(far, old, now, scratch, &moved, nullptr).converged) << kind.name;
    EXPECT_LE((moved - force).norm(), 1e-10 * force.norm()) << kind.name;
    for (int i = 0; i < d; ++i) {
      double sum = 0;
      for (Index a = i; a < force.size(); a += d) sum += force[a];
      EXPECT_NEAR(sum, 0, 1e-12 * force.norm()) << kind.name;
    }
  }
}

TEST(SolidNonlinear, WorkIsStoredEnergyAndDissipation) {
  // over any path the work of the nodal forces (trapezoidal rule) is the change of the stored energy and what the points dissipate:
  // mean stress times plastic strain. The modes do no work because no force acts on them.
  std::mt19937 random(35);
  Mat3 affine;
  affine << 1, 0.3, 0, -0.2, 1, 0, 0, 0, 1;
  for (const SolidKind& kind : nonlinear_kinds()) {
    if (info(kind.cell).nodes != info(kind.cell).corners || kind.cell == Cell::wedge6) continue;
    std::vector<Vec3> positions;  // a parallelogram: all points have the same volume
    for (int a = 0; a < info(kind.cell).nodes; ++a) positions.push_back(affine * local_node(kind.cell, a));
    const DruckerPragerParameters p = clay(2e5, 0.2);
    const NonlinearSolid solid = yielding(kind, positions, p);
    const Vector a = random_displacement(solid.unknowns(), 2e-3, random), b = random_displacement(solid.unknowns(), 1e-3, random);
    std::vector<double> old(static_cast<std::size_t>(solid.num_history()), 0.0), now = old;
    NonlinearSolid::Scratch scratch;
    Vector force = Vector::Zero(solid.unknowns()), before = force, u = Vector::Zero(solid.unknowns());
    std::vector<Stress> stress_before(static_cast<std::size_t>(solid.num_points()), Stress::Zero());
    double work = 0, dissipated = 0;
    for (int step = 1; step <= 60; ++step) {
      const double t = 2 * std::numbers::pi * step / 60;
      const Vector next = (1 - std::cos(t)) / 2 * a + std::sin(t) * b;
      ASSERT_TRUE(solid.respond(next, old, now, scratch, &force, nullptr).converged) << kind.name << step;
      work += (force + before).dot(next - u) / 2;
      const auto stress = solid.point_stress(next, now);
      for (std::size_t i = 0; i < stress.size(); ++i) {
        const double* was = old.data() + i * DruckerPrager::history_size;
        const double* is = now.data() + i * DruckerPrager::history_size;
        dissipated += solid.volume() / solid.num_points() * (stress[i] + stress_before[i]).dot(ConstMap(is, 6) - ConstMap(was, 6)) / 2;
      }
      before = force;
      stress_before = stress;
      u = next;
      old = now;
    }
    EXPECT_GT(dissipated, 0) << kind.name;
    EXPECT_NEAR(work, solid.stored_energy(u, now) + dissipated, 1e-9 * dissipated) << kind.name;
  }
}

/// Von Mises yield with linear kinematic hardening (Prager): |s - a| <= radius, back stress a = (2/3) H e, which locks up e.a/2.
class KinematicHardening final : public BulkLaw {
 public:
  KinematicHardening(const ElasticMaterial& material, double radius, double hardening)
      : BulkLaw(material), radius_(radius), hardening_(2 * hardening / 3) {}
  int num_history() const override { return 6; }
  BulkResponse respond(const BulkPoints& points) const override {
    const double shear = material().shear();
    for (std::size_t p = 0; p < points.strain.size(); ++p) {
      const ConstMap old(points.old + 6 * p, 6);
      Map now(points.now + 6 * p, 6);
      now = old;
      points.stress[p] = elastic() * (points.strain[p] - old);
      if (points.tangent != nullptr) points.tangent[p] = elastic();
      Stress relative = points.stress[p];
      relative.head<3>().array() -= points.stress[p].head<3>().mean();
      relative -= hardening_ * halved(old);
      const double size = std::sqrt(relative.head<3>().squaredNorm() + 2 * relative.tail<3>().squaredNorm());
      if (size <= radius_) continue;
      const Stress direction = relative / size;
      const double length = (size - radius_) / (2 * shear + hardening_);
      Strain flow = length * direction;
      flow.tail<3>() *= 2;
      now += flow;
      points.stress[p] -= 2 * shear * length * direction;
      if (points.tangent == nullptr) continue;
      Mat6 deviatoric = Mat6::Zero();
      deviatoric.topLeftCorner<3, 3>().setConstant(-1.0 / 3);
      deviatoric.diagonal() += Stress(1, 1, 1, 0.5, 0.5, 0.5);
      points.tangent[p] -= 2 * shear *
                           (2 * shear * length / size * (deviatoric - direction * direction.transpose()) +
                            2 * shear / (2 * shear + hardening_) * direction * direction.transpose());
    }
    return {};
  }
  double locked_energy(const double* history) const override {
    const Strain e = ConstMap(history, 6);
    return hardening_ * e.dot(halved(e)) / 2;
  }

 private:
  /// Tensor components of a strain with engineering shear strains.
  static Strain halved(Strain e) {
    e.tail<3>() /= 2;
    return e;
  }
  double radius_, hardening_;
};

TEST(SolidNonlinear, ALawThatLocksUpEnergyKeepsTheBalance) {
  // a law that the program does not know: work of the mean force = change of the stored energy + dissipation in every step; what the
  // linear solid lacks, force and energy, follows from the memory; and all of it comes back when the back stress pulls the element back
  std::mt19937 random(37);
  const auto law = std::make_shared<const KinematicHardening>(ElasticMaterial{3e9, 0.3, 2000}, 5e5, 1e9);
  for (const SolidKind& kind : nonlinear_kinds()) {
    const auto positions = distorted_nodes(kind.cell, 0.1, random);
    const NonlinearSolid solid(kind.cell, first_numbers(info(kind.cell).nodes), std::make_shared<const std::vector<Vec3>>(positions),
                               section_of(kind), law);
    const Vector a = random_displacement(solid.unknowns(), 2e-3, random);
    std::vector<double> old(static_cast<std::size_t>(solid.num_history()), 0.0), now = old;
    NonlinearSolid::Scratch scratch;
    Inelastic inelastic;
    Vector u = Vector::Zero(solid.unknowns()), before = u, force;
    Matrix k, tangent;
    solid.form({&k, nullptr, nullptr});
    double dissipated = 0, largest = 0;
    for (int step = 1; step <= 12; ++step) {
      const Vector next = std::sin(std::numbers::pi * step / 6) * a;
      const BulkResponse outcome = solid.respond(next, old, now, scratch, &force, &tangent);
      ASSERT_TRUE(outcome.converged) << kind.name << step << outcome.why;
      const double work = (force + before).dot(next - u) / 2, gained = solid.stored_energy(next, now) - solid.stored_energy(u, old);
      const double lost = solid.dissipated(u, old, next, now);
      largest = std::max(largest, std::abs(work));
      EXPECT_NEAR(work, gained + lost, 1e-10 * largest) << kind.name << step;
      solid.find_inelastic(now, scratch, inelastic);
      EXPECT_LE((k * next + inelastic.force - force).norm(), 1e-12 * (k * a).norm()) << kind.name;
      EXPECT_NEAR(next.dot(k * next) / 2 + next.dot(inelastic.force) + inelastic.energy, solid.stored_energy(next, now), 1e-10 * largest);
      EXPECT_LE((tangent - tangent.transpose()).norm(), 1e-11 * tangent.norm()) << kind.name;
      dissipated += lost;
      u = next, before = force, old = now;
    }
    EXPECT_TRUE(solid.has_yielded(now)) << kind.name;
    EXPECT_GT(dissipated, 0) << kind.name;
    double locked = 0;
    for (int p = 0; p < solid.num_points(); ++p) locked += law->locked_energy(now.data() + 6 * p);
    EXPECT_GT(locked, 0) << kind.name;
  }
}

TEST(SolidNonlinear, ALawThatFailsFailsTheElement) {
  class Failing final : public BulkLaw {
   public:
    using BulkLaw::BulkLaw;
    int num_history() const override { return 6; }
    BulkResponse respond(const BulkPoints& points) const override {
      for (std::size_t p = 0; p < points.strain.size(); ++p) points.stress[p].setZero();
      return {false, "no stress fits"};
    }
  };
  const SolidKind kind = nonlinear_kinds().front();
  std::mt19937 random(38);
  const NonlinearSolid solid(kind.cell, first_numbers(info(kind.cell).nodes),
                             std::make_shared<const std::vector<Vec3>>(distorted_nodes(kind.cell, 0.1, random)), section_of(kind),
                             std::make_shared<const Failing>(ElasticMaterial{3e9, 0.3, 2000}));
  std::vector<double> old(static_cast<std::size_t>(solid.num_history()), 0.0), now = old;
  NonlinearSolid::Scratch scratch;
  Vector force;
  const BulkResponse outcome = solid.respond(Vector::Ones(solid.unknowns()), old, now, scratch, &force, nullptr);
  EXPECT_FALSE(outcome.converged);
  EXPECT_EQ(outcome.why, "no stress fits");
}

TEST(SolidNonlinear, APointWithoutStiffnessAtTheApexIsNoObstacle) {
  // pulled apart without hardening every tangent at the apex is zero; the update still ends, its force is that of the apex stress
  for (const SolidKind& kind : nonlinear_kinds()) {
    std::mt19937 random(36);
    const auto positions = distorted_nodes(kind.cell, 0.15, random);
    DruckerPragerParameters p = clay(2e5, 0.5);
    p.hardening = 0;
    const NonlinearSolid solid = yielding(kind, positions, p);
    const int d = solid.dimension();
    const Vector u = linear_field(positions, d, 5e-3 * Mat3::Identity()) + random_displacement(solid.unknowns(), 1e-4, random);
    std::vector<double> old(static_cast<std::size_t>(solid.num_history()), 0.0), now = old;
    NonlinearSolid::Scratch scratch;
    Vector force;
    Matrix tangent;
    const BulkResponse outcome = solid.respond(u, old, now, scratch, &force, &tangent);
    ASSERT_TRUE(outcome.converged) << kind.name << outcome.why;
    ASSERT_TRUE(tangent.allFinite()) << kind.name;
    const double expected = p.cohesion / std::tan(p.friction);
    for (const Stress& s : solid.point_stress(u, now)) EXPECT_NEAR(s[0], expected, 1e-9 * expected) << kind.name;
  }
}

}  // namespace
}  // namespace uplift::solid_nonlinear_test
