#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "simple_meshes.h"
#include "support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"
#include "uplift/mesh/mesh.h"

// What the verification cases with meshes share: a case as text with a mesh made here, run as a user would run it.
namespace uplift::verification {

using std::numbers::pi;

/// The result of a run with its model.
struct MeshRun {
  BuiltCase built;
  RunResult result;
  bool completed() const { return result.status == RunStatus::completed; }
  /// A column by its name; throws std::out_of_range without it.
  const std::vector<double>& operator[](const std::string& name) const {
    for (std::size_t k = 0; k < result.columns.size(); ++k)
      if (result.columns[k].name == name) return result.table[k + 1];
    std::string names;
    for (const Request& request : result.columns) names += " " + request.name;
    throw std::out_of_range("no column " + name + " among" + names);
  }
  const std::vector<double>& time() const { return result.table.front(); }
  double peak(const std::string& name) const {
    double largest = 0;
    for (const double value : (*this)[name]) largest = std::max(largest, std::abs(value));
    return largest;
  }
};

/// `change` may put what a case file does not say (initial velocities of all nodes) into the model that is ready to run.
inline MeshRun run_mesh(const std::string& text, const Mesh& mesh, const std::function<void(BuiltCase&)>& change = {}) {
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml",
                               [&](const std::string&, const Where&, const std::string&) { return mesh; });
  MeshRun made{build(read, RunSpec{}), {}};
  made.built.plan.frames = 0;
  if (change) change(made.built);
  made.result = run(made.built.model, made.built.plan, made.built.behaviours);
  return made;
}

/// "[1, 2]" or "[1, 2, 3]".
inline std::string triple(const Vec3& v, int dimension) {
  return dimension == 2 ? fmt::format("[{:.17g}, {:.17g}]", v.x(), v.y()) : fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v.x(), v.y(), v.z());
}

/// Nodes for which something holds, ascending.
inline std::vector<int> nodes_where(const Mesh& mesh, const std::function<bool(const Vec3&)>& on) {
  std::vector<int> found;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if (on(mesh.nodes[i])) found.push_back(static_cast<int>(i));
  return found;
}

/// Names of nodes of the mesh in a case file: "mesh.1", ... as a list.
inline std::string names_of(const std::vector<int>& nodes) {
  std::string list = "[";
  for (std::size_t i = 0; i < nodes.size(); ++i) list += fmt::format("{}\"mesh.{}\"", i ? ", " : "", nodes[i] + 1);
  return list + "]";
}

/// Text with a piece replaced; fails without it.
inline std::string with(std::string text, const std::string& old, const std::string& fresh) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, text.npos) << old;
  return text.replace(at, old.size(), fresh);
}

/// Sum of y exp(-i w t) dt: the Fourier integral of a history that begins and ends at rest.
inline std::complex<double> fourier(const std::vector<double>& time, const std::vector<double>& y, double omega) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < y.size(); ++i) sum += y[i] * std::polar(1.0, -omega * time[i]);
  return sum * (time[1] - time[0]);
}

/// Ricker wavelet of unit peak at 1.5/f.
inline double ricker(double frequency, double time) {
  const double a = std::pow(pi * frequency * (time - 1.5 / frequency), 2);
  return (1 - 2 * a) * std::exp(-a);
}

}  // namespace uplift::verification
