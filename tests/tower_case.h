#pragma once

// The structure of the trust tests: a mass of 24 t on a column of 5 m over a footing that rests on nothing yet. An interface, gravity and
// stages make it a case.
namespace uplift::support {

inline constexpr const char* tower_structure = R"(
[nodes]
top = [0, 5]
base = [0, 0]
[[beam]]
name = "column"
nodes = ["base", "top"]
E = "20 GPa"
I = "0.2 m4"
[[mass]]
node = "top"
mass = 24000
[[rigid]]
name = "footing"
node = "base"
mass = 1e4
inertia = 7500
[[support]]
node = "base"
fixed = ["ux"]
[gravity]
acceleration = [0, -9.81]
)";

}  // namespace uplift::support
