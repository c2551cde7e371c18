// A law of one's own: a joint that hardens under pressure, t = K d + L d^3 where it is closed, and a footing that rocks on it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <uplift.hpp>

namespace {

constexpr double stiffness = 80e6, hardening = 1e12, shear = 60e6;  // Pa/m, Pa/m3, Pa/m

// The normal component is the last one, and the energies are the work of the traction: the time integration derives the mean traction of
// the step from them, so that the energy balance closes.
void hardening_joint(const uplift::LawStep& s) {
  for (int i = 0; i < s.points; ++i) {
    const double slip = s.to[s.at(0, i)], closing = std::min(s.to[s.at(1, i)], 0.0), square = closing * closing;
    s.traction[s.at(0, i)] = shear * slip;
    s.traction[s.at(1, i)] = closing * (stiffness + hardening * square);
    s.slope[s.at(0, 0, i)] = shear;
    s.slope[s.at(1, 1, i)] = closing < 0 ? stiffness + 3 * hardening * square : 0;
    s.stored[i] = 0.5 * shear * slip * slip + square * (0.5 * stiffness + 0.25 * hardening * square);
  }
}

const char* const pier = R"(
title = "A pier on a joint of its own"
[nodes]
deck = [0, 17]
base = [0, 1]
[[beam]]
name = "column"
nodes = ["base", "deck"]
E = "30 GPa"
A = "3.8 m2"
I = "0.7 m4"
density = "2500 kg/m3"
[[mass]]
node = "deck"
mass = "600 t"
inertia = "6000 t m2"
[[rigid]]
name = "footing"
node = "base"
mass = "245 t"
inertia = "1080 t m2"
[[interface]]
name = "underside"
law = { type = "external", name = "hardening joint", K_n = "80 MPa/m", K_t = "60 MPa/m" }
footing = { body = "base", width = "7 m", thickness = "7 m", points = 41, offset = [0, -1] }
[[function]]
name = "pulse"
shape = { type = "ricker", frequency = "0.8 Hz", delay = "2 s" }
[[ground_acceleration]]
amplitude = "4 m/s2"
function = "pulse"
[gravity]
[[damping.rayleigh]]
frequency = "0.8 Hz"
ratio = 0.03
[[damping.rayleigh]]
frequency = "10 Hz"
ratio = 0.03
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = "6 s"
step = "2 ms"
)";

double largest(const uplift::Numbers& history) {
  double most = 0;
  for (const double value : history) most = std::max(most, std::abs(value));
  return most;
}

/// Largest eccentricity of the force under the footing as a share of half its width: 1 would be a footing that stands on its edge.
double largest_eccentricity(const uplift::Numbers& moment, const uplift::Numbers& axial, double width) {
  double most = 0;
  for (std::size_t i = 0; i < moment.size(); ++i)
    if (axial[i] < 0) most = std::max(most, std::abs(moment[i] / axial[i]) / (width / 2));
  return most;
}

}  // namespace

int main() {
  uplift::Case rocking = uplift::Case::parse(pier);
  rocking.set_law("hardening joint", hardening_joint);
  uplift::Options options;
  options.step_check = false;
  const uplift::Results results = rocking.run(options);
  std::printf("largest moment %.4g N m, eccentricity up to %.4f of half the width, uplifted up to %.4f of the area\n",
              largest(results["underside.moment"]), largest_eccentricity(results["underside.moment"], results["underside.axial"], 7),
              largest(results["underside.uplifted_ratio"]));
}
