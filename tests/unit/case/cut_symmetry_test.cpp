#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "simple_meshes.h"
#include "unit/case/cut_support.h"

// A block on soil in one mesh, parted by a plane at an angle to its cells, that rocks and lifts off: mirrored, turned and in other units it
// does the same. Mesh, plane, gravity and ground motion are turned together.
namespace uplift::cut_symmetry_test {
namespace {

using namespace support;

/// Lengths and forces in these units of metres and newtons; turned by `angle` about `axis`, then mirrored at x = 0.
struct Frame {
  double length = 1, force = 1, angle = 0;
  Vec3 axis = Vec3(0, 0, 1);
  bool mirrored = false;

  Vec3 turned(const Vec3& v) const {
    const double c = std::cos(angle), s = std::sin(angle);
    Vec3 made = c * v + s * cross(axis, v) + (1 - c) * axis.dot(v) * axis;
    if (mirrored) made[0] = -made[0];
    return made;
  }
};

Mesh block(Cell cell, const Frame& frame) {
  const std::vector<double> x = uniform_lines(-1, 1, 4), up = uniform_lines(0, 3, 6);
  Mesh mesh = info(cell).dimension == 2 ? rectangle(x, up, cell) : box(x, uniform_lines(0, 1, 1), up, cell);
  for (Vec3& node : mesh.nodes) node = frame.length * frame.turned(node);
  if (!frame.mirrored) return mesh;
  for (CellBlock& each : mesh.blocks) {  // nodes in the order of the mirror
    const auto n = static_cast<std::size_t>(info(each.cell).nodes);
    for (std::size_t first = 0; first < each.nodes.size(); first += n) {
      const std::span<int> nodes(each.nodes.data() + first, n);
      if (each.cell == Cell::hex8)
        for (std::size_t k = 0; k < 4; ++k) std::swap(nodes[k], nodes[k + 4]);
      else if (each.cell == Cell::wedge6)
        for (std::size_t k = 0; k < 3; ++k) std::swap(nodes[k], nodes[k + 3]);
      else if (each.cell == Cell::tet4)
        std::swap(nodes[2], nodes[3]);
      else
        std::reverse(nodes.begin() + (each.cell == Cell::line2 ? 0 : 1), nodes.end());
    }
  }
  return mesh;
}

RunResult rocked(Cell cell, const Frame& frame) {
  const bool plane = info(cell).dimension == 2;
  const double l = frame.length, f = frame.force, pa = f / (l * l), density = f / (l * l * l * l);  // of 1 s
  const auto vector = [&](const Vec3& along) {
    const Vec3 v = frame.turned(plane ? along : Vec3(along[0], along[2], along[1]));
    return plane ? fmt::format("[{:.17g}, {:.17g}]", v[0], v[1]) : fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v[0], v[1], v[2]);
  };
  const Vec3 normal = Vec3(0.12, 1, 0).normalized();
  const Mesh mesh = block(cell, frame);
  std::string text = "title = \"block\"\n[mesh]\nfile = \"block.msh\"\n" + solid("volume", 5e7 * pa, 0.3, 1900 * density) +
                     solid("block", 2e9 * pa, 0.2, 2500 * density) + "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"" +
                     (plane ? "" : ", \"uz\"") + "]\n[gravity]\nacceleration = " + vector(Vec3(0, -9.81 * l, 0)) +
                     "\n[damping]\nalpha = 0.5\n[[function]]\nname = \"pulse\"\nshape = { type = \"half_sine\", duration = 0.3 }\n" +
                     "[[ground_acceleration]]\nfunction = \"pulse\"\ndirection = " + vector(Vec3(1, 0, 0)) +
                     fmt::format(
                         "\namplitude = {:.17g}\n[[interface]]\nname = \"base\"\ncut = {{ through = [\"volume\"], point = {}, "
                         "normal = {}, upper = \"block\" }}\n",
                         5.0 * l, vector(Vec3(0, 1.03 * l, 0)), vector(normal)) +
                     fmt::format("law = {{ type = \"springs\", K_n = {0:.17g}, K_t = {0:.17g}, tangential = \"bonded\" }}\n", 3e8 * pa / l);
  for (const char* quantity : {"ux", "uy", "uz"})
    if (!plane || std::string(quantity) != "uz")
      text +=
          fmt::format("[[output.history]]\nname = \"corner.{0}\"\nnode = \"mesh.{1}\"\nquantity = \"{0}\"\n", quantity, mesh.nodes.size());
  return run_on(text + "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 0.4\nstep = 5e-3\n", mesh);
}

void expect_same(Cell cell, const RunResult& original, const Frame& frame, const std::string& what) {
  const RunResult other = rocked(cell, frame);
  const bool plane = info(cell).dimension == 2;
  const auto motion = [&](const RunResult& of, std::size_t i) {
    return Vec3(history(of, "corner.ux")[i], history(of, "corner.uy")[i], plane ? 0 : history(of, "corner.uz")[i]);
  };
  double off = 0, size = 0;
  for (std::size_t i = 0; i < history(original, "corner.ux").size(); ++i) {
    const Vec3 expected = motion(original, i);
    off = std::max(off, (frame.length * frame.turned(expected) - motion(other, i)).norm() / frame.length);
    size = std::max(size, expected.norm());
  }
  constexpr double round_off = 1e-9;
  EXPECT_LT(off, round_off * size) << info(cell).name << " " << what;
  const double depth = plane ? frame.length : 1;  // plane models are 1 thick in any unit
  for (const auto& [column, unit] : std::vector<std::pair<const char*, double>>{{"base.axial", frame.force / depth},
                                                                                {"base.shear", frame.force / depth},
                                                                                {"base.moment", frame.force * frame.length / depth},
                                                                                {"base.uplifted_ratio", 1}}) {
    const auto one = history(original, column), two = history(other, column);
    double apart = 0, most = 0;
    for (std::size_t i = 0; i < one.size(); ++i)
      apart = std::max(apart, std::abs(std::abs(one[i]) - std::abs(two[i]) / unit)), most = std::max(most, std::abs(one[i]));
    EXPECT_GT(most, 0.2) << column;
    EXPECT_LT(apart, round_off * most) << info(cell).name << " " << what << " " << column;
  }
}

TEST(CutSymmetry, MirroredTurnedAndInOtherUnits) {
  constexpr double turn = 37 * std::numbers::pi / 180;
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::hex8}) {
    const RunResult original = rocked(cell, {});
    expect_same(cell, original, {.mirrored = true}, "mirrored");
    if (info(cell).dimension == 2)
      expect_same(cell, original, {1, 1, turn}, "turned");
    else
      expect_same(cell, original, {1, 1, turn, Vec3(1, 2, 3).normalized()}, "turned");
    expect_same(cell, original, {1e3, 1e-3}, "mm, kN");
    expect_same(cell, original, {1e3, 1}, "a thousand times as long");
    expect_same(cell, original, {1e-3, 1}, "a thousandth as long");
  }
}

}  // namespace
}  // namespace uplift::cut_symmetry_test
