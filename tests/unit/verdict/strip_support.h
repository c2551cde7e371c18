#pragma once
#include <algorithm>
#include <cmath>

#include "unit/verdict/verdict_support.h"
#include "uplift/run/interface_viewer.h"

// A rigid strip on Winkler springs.
namespace uplift::winkler_strip {

inline constexpr double width = 3, modulus = 2e8, dead_load = 1e6, theta_u = dead_load / (modulus * width * width / 2);  // W/(2 k b^2)

/// W b = 1.5 MN m.
inline std::string strip(const std::string& more = "", const std::string& points = "4001",
                         const std::string& cohesion = ", cohesion = \"20 kPa\"") {
  return R"(title = "strip"
[nodes]
base = [0, 0]
[[rigid]]
name = "footing"
node = "base"
mass = 1e4
inertia = 7500
[[interface]]
name = "soil"
footing = { body = "base", width = 3, points = )" +
         points + R"( }
law = { type = "springs", K_n = 2e8, K_t = 1e8, tangential = "coulomb", friction = 0.6)" +
         cohesion + R"( }
[[load]]
node = "base"
force = [0, -1e6]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.1
step = 0.01
)" + more;
}

/// What the strip looks like at a rotation, in units of theta_u: the plane that carries the weight, by the closed form.
inline InterfaceView turned(const BuiltCase& built, double ratio) {
  const Interface& interface = built.model.interfaces.front();
  const int n = interface.batch.points, normal = interface.batch.normal();
  const double theta = ratio * theta_u, contact = ratio > 1 ? width / std::sqrt(ratio) : width;
  State state;
  state.displacement = Vector::Zero(built.model.free());
  state.opening = state.force = Vector::Zero(interface.rows());
  for (int i = 0; i < n; ++i) {
    const double x = interface.position[static_cast<std::size_t>(i)].x();
    const double gap = ratio > 1 ? theta * (x + width / 2 - contact) : theta * x - dead_load / (modulus * width);
    state.opening[normal + i] = gap;
    state.force[normal + i] = modulus * std::min(gap, 0.0) * interface.area[i];
  }
  state.mean_force = state.force;
  std::vector<InterfaceView> views;
  InterfaceViewer(built.model, 1e-9, {}).look(state, views);
  return views.front();
}

}  // namespace uplift::winkler_strip
