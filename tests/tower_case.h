#pragma once
#include <string>

// The structure of many tests: a mass on a column of 5 m over a footing that rests on nothing yet. An interface, loads and stages make it a
// case. Each test states what it changes.
namespace uplift::support {

struct Tower {
  std::string height = "5", young = "\"20 GPa\"", inertia = "\"0.2 m4\"";     // values of keys
  std::string mass = "mass = 24000", footing = "mass = 1e4\ninertia = 7500";  // lines of [[mass]] and [[rigid]]
  std::string nodes = {}, beam = {};                                          // further lines of [nodes] and [[beam]]
  bool held = true;                                                           // the footing cannot move sideways

  std::string text() const {
    const auto lines = [](const std::string& more) { return more.empty() ? more : more + "\n"; };
    return "\n[nodes]\ntop = [0, " + height + "]\nbase = [0, 0]\n" + lines(nodes) +
           "[[beam]]\nname = \"column\"\nnodes = [\"base\", \"top\"]\nE = " + young + "\nI = " + inertia + "\n" + lines(beam) +
           "[[mass]]\nnode = \"top\"\n" + mass + "\n[[rigid]]\nname = \"footing\"\nnode = \"base\"\n" + footing + "\n" +
           (held ? "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n" : "");
  }
};

/// Weight of all masses.
inline constexpr const char* weight = "[gravity]\nacceleration = [0, -9.81]\n";

}  // namespace uplift::support
