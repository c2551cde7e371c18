#include <gtest/gtest.h>

#include <numbers>

#include "manual.h"
#include "solids_support.h"
#include "support.h"
#include "uplift/elements/absorbing.h"
#include "uplift/math/dense.h"

// Claims: a vertically incident wave through an absorbing face moves the free surface by twice the incoming motion and leaves without a
// trace (1e-3, order 2 in h and the time step); plane waves at other angles are reflected as the algebra of Lysmer & Kuhlemeyer says
// (reference/lysmer_reflection.csv, 1e-10).
namespace uplift::verification::solids_waves_test {
namespace {

const ElasticMaterial soil = material_of_wave_speed(200, 0.3, 1900);
constexpr double height = 20;

/// Column under a wave: what is left of the surface's motion, relative to the largest.
struct Column {
  double wrong = 0;  // largest |u - 2 u_inc(t - H/c)|
  double left = 0;   // largest |u| anywhere after the wave has gone
};

/// u_inc = exp(-((t - t0)/s)^2) [m] and its rate.
double pulse(double t) {
  return std::exp(-std::pow((t - 0.08) / 0.02, 2));
}
double pulse_rate(double t) {
  return -2 * (t - 0.08) / (0.02 * 0.02) * pulse(t);
}

/// One unknown per level: all nodes of a level move together along one axis.
struct Levels {
  std::vector<Index> of_node;
  Index count = 0;
};

Levels levels(const SmallMesh& mesh, int up) {
  std::map<long, Index> known;
  for (const Vec3& x : mesh.before) known.try_emplace(std::lround(x[up] * 1e6), 0);
  Levels result;
  for (auto& [height_key, number] : known) number = result.count++;
  for (const Vec3& x : mesh.before) result.of_node.push_back(known.at(std::lround(x[up] * 1e6)));
  return result;
}

Column run(Cell cell, int along, bool lumped, int pieces) {
  const int d = info(cell).dimension, up = d - 1;
  const double c = along == up ? soil.p_wave_speed() : soil.s_wave_speed(), h = height / pieces;
  std::array<int, 3> n{1, 1, 1};
  n[static_cast<std::size_t>(up)] = pieces;
  Vec3 size(h, h, h);
  size[up] = height;
  const SmallMesh mesh = small_mesh(cell, size, n, [](const Vec3& x) { return x; });
  SolidSection section;
  section.material = soil;
  section.mass = lumped ? SolidSection::Mass::lumped : SolidSection::Mass::consistent;
  const SolidSystem system = assemble(mesh, section);
  const Levels level = levels(mesh, up);
  std::vector<Triplet> tie;
  for (std::size_t a = 0; a < level.of_node.size(); ++a) tie.emplace_back(d * static_cast<Index>(a) + along, level.of_node[a], 1.0);
  Sparse t(system.stiffness.rows(), level.count);
  t.setFromTriplets(tie.begin(), tie.end());
  const Sparse k = t.transpose() * system.stiffness * t, m = t.transpose() * system.mass * t;

  // the bottom: sides whose nodes all lie at height 0
  std::vector<Triplet> dashpots;
  Vector incoming = Vector::Zero(level.count);
  for (const auto& nodes : mesh.cells) {
    std::size_t first = 0;
    for (const Cell side : info(cell).sides) {
      std::vector<int> on_side;
      bool bottom = true;
      for (int i = 0; i < info(side).nodes; ++i) {
        on_side.push_back(nodes[static_cast<std::size_t>(info(cell).side_nodes[first++])]);
        bottom &= std::abs(mesh.before[static_cast<std::size_t>(on_side.back())][up]) < 1e-9;
      }
      if (!bottom) continue;
      const AbsorbingFace face(side, on_side, mesh.nodes, {soil, 1, lumped});
      Matrix ce;
      face.form({nullptr, nullptr, &ce});
      const Vector drive = face.incident(Vec3::Unit(along));
      for (std::size_t a = 0; a < on_side.size(); ++a) {
        const Index row = d * static_cast<Index>(a) + along;
        incoming[level.of_node[static_cast<std::size_t>(on_side[a])]] += drive[row];
        for (std::size_t b = 0; b < on_side.size(); ++b)
          dashpots.emplace_back(level.of_node[static_cast<std::size_t>(on_side[a])], level.of_node[static_cast<std::size_t>(on_side[b])],
                                ce(row, d * static_cast<Index>(b) + along));
      }
    }
  }
  Sparse damping(level.count, level.count);
  damping.setFromTriplets(dashpots.begin(), dashpots.end());

  // average acceleration, about one element per step
  const double step = 0.5 * h / c, gone = 0.16 + 2 * height / c + 0.04;
  const Sparse effective = k + damping * (2 / step) + m * (4 / (step * step));
  const SparseLdlt factor(effective);
  Vector u = Vector::Zero(level.count), v = u, a = u;
  Column result;
  for (double time = step; time < gone + 0.2; time += step) {
    const Vector rest = incoming * pulse_rate(time) + m * (u * (4 / (step * step)) + v * (4 / step) + a) + damping * (u * (2 / step) + v);
    const Vector next = factor.solve(rest);
    const Vector a_next = (next - u) * (4 / (step * step)) - v * (4 / step) - a;
    v = (next - u) * (2 / step) - v;
    a = a_next;
    u = next;
    result.wrong = std::max(result.wrong, std::abs(u[level.count - 1] - 2 * pulse(time - height / c)) / 2);
    if (time > gone) result.left = std::max(result.left, u.cwiseAbs().maxCoeff());
  }
  return result;
}

TEST(SolidsWaves, IncomingWavesDoubleAtTheSurfaceAndLeave) {
  VERIFIES({"Waves in soil", "Incoming waves double at the surface and leave",
            "d'Alembert; Lysmer & Kuhlemeyer, J. Eng. Mech. Div. ASCE 95 (1969) 859-877"});
  struct Kind {
    Cell cell;
    bool lumped;
    int fine;
  };
  // linear cells, consistent and lumped; second-order ones, consistent
  for (const auto& [cell, lumped, fine] :
       {Kind{Cell::quad4, false, 256}, Kind{Cell::quad4, true, 256}, Kind{Cell::tri3, false, 256}, Kind{Cell::quad9, true, 128},
        Kind{Cell::quad8, false, 128}, Kind{Cell::tri6, false, 128}, Kind{Cell::hex8, false, 256}, Kind{Cell::hex8, true, 256},
        Kind{Cell::hex20, false, 128}, Kind{Cell::hex27, false, 128}, Kind{Cell::tet10, false, 128}, Kind{Cell::wedge15, false, 128}}) {
    const int d = info(cell).dimension;
    for (const int along : {0, d - 1}) {
      const Column coarse = run(cell, along, lumped, fine / 2), best = run(cell, along, lumped, fine);
      const std::string name = std::string(info(cell).name) + (lumped ? " lumped" : "") + (along == d - 1 ? " P" : " S");
      VERIFY_LE("largest error of the surface over the peak", "1", best.wrong, 1e-3) << name;
      VERIFY_GE("order of convergence", "1", std::log2(coarse.wrong / best.wrong), 1.9) << name;
      VERIFY_LE("motion that is left, over the peak", "1", best.left, 1e-4) << name;
    }
  }
}

/// Tractions per rate that the face asks for, along the normal and along the face.
std::pair<double, double> impedance(const ElasticMaterial& material) {
  const auto nodes = std::make_shared<const std::vector<Vec3>>(std::vector<Vec3>{{0, 0, 0}, {0, 1, 0}});
  const std::array<int, 2> numbers{0, 1};
  Matrix c;
  AbsorbingFace(Cell::line2, numbers, nodes, {material, 1, true}).form({nullptr, nullptr, &c});
  return {2 * c(0, 0), 2 * c(1, 1)};
}

/// Displacement amplitude, direction of travel and of motion of a plane wave; traction on the normal x, divided by i omega.
struct PlaneWave {
  Vec2 travel, motion;
  double speed;
  Vec2 traction(double lambda, double mu) const {
    const Vec2 n(1, 0);
    return -(lambda * motion.dot(travel) * n + mu * (motion * travel.dot(n) + travel * motion.dot(n))) / speed;
  }
};

TEST(SolidsWaves, ReflectionAtOtherAnglesIsThatOfThePlaneWaveAlgebra) {
  VERIFIES({"Waves in soil", "Reflection of a viscous boundary at other angles",
            "Lysmer & Kuhlemeyer, J. Eng. Mech. Div. ASCE 95 (1969) 859-877; tests/data/reference/lysmer_reflection.csv"});
  const Reference csv = reference("lysmer_reflection.csv");
  for (const auto& [nu, tag] : {std::pair{0.25, std::string("nu0.25")}, std::pair{1.0 / 3, std::string("nu0.333")}}) {
    const ElasticMaterial material{1e6, nu, 1500};
    const double vp = material.p_wave_speed(), vs = material.s_wave_speed();
    const auto [normal, tangential] = impedance(material);
    const auto rest = [&, along = normal, across = tangential](const PlaneWave& w) -> Vec2 {
      return w.traction(material.lame(), material.shear()) + Vec2(along * w.motion.x(), across * w.motion.y());
    };
    for (std::size_t row = 0; row < csv["theta_from_normal_deg"].size(); ++row) {
      const double theta = csv["theta_from_normal_deg"][row] * std::numbers::pi / 180;
      const double sine = std::sin(theta) * vs / vp;  // of the S wave that belongs to P at theta
      const PlaneWave in{{std::cos(theta), std::sin(theta)}, {std::cos(theta), std::sin(theta)}, vp};
      const PlaneWave p{{-std::cos(theta), std::sin(theta)}, {-std::cos(theta), std::sin(theta)}, vp};
      const PlaneWave s{{-std::sqrt(1 - sine * sine), sine}, {sine, std::sqrt(1 - sine * sine)}, vs};
      Matrix both(2, 2);
      both << rest(p), rest(s);
      const Vector amplitude = PartialLu(both).solve(Matrix(-rest(in)));
      if (std::abs(std::cos(theta)) < 1e-9) continue;  // grazing: no energy arrives
      const double energy =
          amplitude[0] * amplitude[0] + vs * std::sqrt(1 - sine * sine) / (vp * std::cos(theta)) * amplitude[1] * amplitude[1];
      VERIFY_NEAR("reflected P wave of an incident P wave", "1", std::abs(amplitude[0]), std::abs(csv["P_Rp_" + tag][row]), 1e-10) << row;
      VERIFY_NEAR("reflected S wave of an incident P wave", "1", std::abs(amplitude[1]), std::abs(csv["P_Rs_" + tag][row]), 1e-10) << row;
      VERIFY_NEAR("reflected energy of an incident P wave", "1", energy, csv["P_energy_" + tag][row], 1e-10) << row;
      // incoming S below the critical angle, where the reflected P wave still travels away
      const double p_sine = std::sin(theta) * vp / vs;
      if (p_sine < 0.999) {
        const double p_cosine = std::sqrt(1 - p_sine * p_sine);
        const PlaneWave s_in{{std::cos(theta), std::sin(theta)}, {-std::sin(theta), std::cos(theta)}, vs};
        const PlaneWave p_out{{-p_cosine, p_sine}, {-p_cosine, p_sine}, vp};
        const PlaneWave s_out{{-std::cos(theta), std::sin(theta)}, {std::sin(theta), std::cos(theta)}, vs};
        both << rest(p_out), rest(s_out);
        const Vector of_s = PartialLu(both).solve(Matrix(-rest(s_in)));
        VERIFY_NEAR("reflected P wave of an incident S wave", "1", std::abs(of_s[0]), std::abs(csv["S_Rp_" + tag][row]), 1e-10) << row;
        VERIFY_NEAR("reflected S wave of an incident S wave", "1", std::abs(of_s[1]), std::abs(csv["S_Rs_" + tag][row]), 1e-10) << row;
        VERIFY_NEAR("reflected energy of an incident S wave", "1",
                    of_s[1] * of_s[1] + vp * p_cosine / (vs * std::cos(theta)) * of_s[0] * of_s[0], csv["S_energy_" + tag][row], 1e-10)
            << row;
      }
      // SH: tangential dashpot alone, rho Vs (cos - 1)/(cos + 1)
      const double sh = (material.density * vs * std::cos(theta) - tangential) / (material.density * vs * std::cos(theta) + tangential);
      VERIFY_NEAR("reflected SH wave", "1", sh, csv["SH_amplitude_R"][row], 1e-10) << row;
    }
  }
}

}  // namespace
}  // namespace uplift::verification::solids_waves_test
