// Patch tests through interfaces on meshes: two elastic blocks that meet in a joint whose faces are distorted,
// under uniform traction p: jump p/K everywhere, total p L/E + p/K; an inclined joint shares the traction into p cos^2 and p sin cos.
#include <gtest/gtest.h>

#include "manual.h"
#include "mesh_support.h"
#include "uplift/mesh/cell_shapes.h"

namespace uplift::verification::mesh_patch_test {
namespace {

constexpr double young = 5e7, poisson = 0.3, normal_stiffness = 2e9, shear_stiffness = 7e8, pressure = 1e5, side = 2, height = 2;

/// Two blocks, side x (side x) height in all, 3 (x 3) x 4 cells, nodes moved inside the block and along its sides; edges stay straight.
/// `slope`: the joint rises by it per m of x, and everything else with it.
Mesh blocks(Cell cell, double distortion, double slope) {
  const bool plane = info(cell).dimension == 2;
  const int up = plane ? 1 : 2;
  const std::vector<double> across = uniform_lines(0, side, 3), upwards = uniform_lines(0, height, 4);
  const Grid lines{across, plane ? upwards : across, plane ? std::vector<double>{} : upwards};
  const auto part_at = [&](int, int j, int k) { return (plane ? j : k) < 2 ? 0 : 1; };
  const auto face = [](int part, Direction direction, int other) -> std::string {
    if (part == 0 && other == 1) return "interface";
    return other < 0 ? std::string(name_of(direction)) : "";
  };
  const Cell linear = info(cell).linear;
  Mesh mesh = with_cells(grid(lines, part_at, {"lower", "upper"}, face), linear);
  for (Vec3& x : mesh.nodes) {
    const Vec3 old = x;
    const auto wave = [&](double a, double b, double c) {
      return distortion * std::sin(a * old.x() + b * old[plane ? 0 : 1] + c * old[up] + a);
    };
    const auto inside = [&](int axis, double length) { return old[axis] > 1e-9 && old[axis] < length - 1e-9; };
    if (inside(0, side)) x.x() += wave(2, 5, 3);
    if (!plane && inside(1, side)) x.y() += wave(7, 3, 2);
    const bool joint = std::abs(old[up] - height / 2) < 1e-9;  // the joint stays plane
    if (inside(up, height) && !joint) x[up] += wave(3, 4, 8);
    x[up] += slope * (x.x() - side / 2) * (1 - std::abs(x[up] - height / 2) / (height / 2));
  }
  return with_cells(std::move(mesh), cell);
}

std::string patch_text(Cell cell, const char* quadrature) {
  const int d = info(cell).dimension;
  std::string out = "title = \"patch\"\n[mesh]\nfile = \"patch.msh\"\n";
  for (const char* part : {"lower", "upper"})
    out += fmt::format("[[solid]]\ngroup = \"{}\"\nE = {}\npoisson = {}\ndensity = 1000\n{}", part, young, poisson,
                       d == 2 ? "plane = \"stress\"\n" : "");
  out += fmt::format("[[support]]\ngroup = \"bottom\"\nfixed = [\"{}\"]\n", d == 2 ? "uy" : "uz");
  return out +
         fmt::format(
             "[[interface]]\nname = \"joint\"\nsurface = {{ group = \"interface\", lower = [\"lower\"], quadrature = \"{}\" }}\nlaw = {{ "
             "type = \"elastic\", K_n = {}, tangential = \"bonded\", K_t = {} }}\n[[load]]\nname = \"pull\"\ngroup = \"top\"\ntraction = "
             "{}\n[[stage]]\ntype = \"static\"\nsteps = 1\n[[stage]]\ntype = \"dynamic\"\nduration = 1e-9\nstep = 1e-9\n[energy]\n"
             "created_limit = 1e9\n[output]\nframes = 0\nautomatic = false\n",
             quadrature, normal_stiffness, shear_stiffness, triple(pressure * (d == 2 ? Vec3(0, 1, 0) : Vec3(0, 0, 1)), d));
}

struct PatchError {
  double normal = 0, shear = 0, top = 0;  // relative
};

PatchError patch(Cell cell, const char* quadrature, double distortion, double slope) {
  const int d = info(cell).dimension, up = d - 1;
  const Mesh mesh = blocks(cell, distortion, slope);
  std::string text = patch_text(cell, quadrature);
  // the corner of the bottom stays, the next one does not turn about it
  const auto corner = [&](double x) {
    return nodes_where(mesh, [&](const Vec3& p) { return (p - Vec3(x, 0, 0)).norm() < 1e-9; }).front() + 1;
  };
  text += fmt::format("[[support]]\nnode = \"mesh.{}\"\nfixed = [\"ux\"{}]\n", corner(0), d == 3 ? ", \"uy\"" : "");
  if (d == 3) text += fmt::format("[[support]]\nnode = \"mesh.{}\"\nfixed = [\"uy\"]\n", corner(side));
  std::vector<int> top = nodes_where(mesh, [&](const Vec3& x) { return x[up] > height - 1e-9; });
  int points = 0;
  const MeshRun run = run_mesh(text, mesh, [&](BuiltCase& built) {
    points = built.model.interfaces.front().batch.points;
    for (int c = 0; c < d; ++c)
      for (int i = 0; i < points; ++i) {
        Request request;
        request.kind = Request::Kind::opening;
        request.name = fmt::format("o{}.{}", c, i);
        request.point = i;
        request.component = c;
        built.plan.requests.push_back(request);
      }
    for (const int node : top) {
      Request request;
      request.name = fmt::format("top.{}", node);
      request.unknown = built.model.space.unknowns() * node + up;
      built.plan.requests.push_back(request);
    }
  });
  EXPECT_TRUE(run.completed()) << run.result.reason;
  const double cosine = 1 / std::hypot(1, slope), sine = slope * cosine;
  const double normal = pressure * cosine * cosine / normal_stiffness, shear = pressure * sine * cosine / shear_stiffness;
  const double total = pressure * height / young + normal * cosine + shear * sine;
  PatchError error;
  for (int i = 0; i < points; ++i) {
    error.normal = std::max(error.normal, std::abs(run[fmt::format("o{}.{}", up, i)][0] / normal - 1));
    // along the steepest tangent, the first one (the x axis projected on the face)
    error.shear = std::max(error.shear, std::abs(run[fmt::format("o0.{}", i)][0] - shear) / normal);
    if (d == 3) error.shear = std::max(error.shear, std::abs(run[fmt::format("o1.{}", i)][0]) / normal);
  }
  for (const int node : top) error.top = std::max(error.top, std::abs(run[fmt::format("top.{}", node)][0] / total - 1));
  return error;
}

class MeshPatch : public testing::TestWithParam<Cell> {};
INSTANTIATE_TEST_SUITE_P(Cells, MeshPatch,
                         testing::Values(Cell::tri3, Cell::tri6, Cell::quad4, Cell::quad8, Cell::quad9, Cell::tet4, Cell::tet10,
                                         Cell::wedge6, Cell::wedge15, Cell::hex8, Cell::hex20, Cell::hex27),
                         [](const auto& tested) { return std::string(uplift::info(tested.param).name); });

// Claim: uniform traction through a joint on any distorted mesh: 1e-10 for the jump at every point and the motion of the top.
TEST_P(MeshPatch, UniformTractionThroughADistortedJoint) {
  VERIFIES({"Joint elements", "Patch test through a distorted joint", "Uniform state: openings p/K, top motion pL/E + p/K"});
  const Cell cell = GetParam();
  for (const char* quadrature : {"gauss", "nodal"}) {
    const PatchError error = patch(cell, quadrature, 0.12, 0);
    RecordProperty(quadrature, fmt::format("{:.1e} {:.1e} {:.1e}", error.normal, error.shear, error.top));
    VERIFY_LT("relative error of the opening", "1", error.normal, 1e-10) << quadrature;
    VERIFY_LT("shear opening over the normal one", "1", error.shear, 1e-10) << quadrature;
    VERIFY_LT("relative error of the motion of the top", "1", error.top, 1e-10) << quadrature;
  }
}

// Claim: without distortion the nodal rule is exact on every face: 1e-10.
TEST_P(MeshPatch, UniformTractionThroughARegularJoint) {
  VERIFIES(
      {"Joint elements", "Patch test through a regular joint, nodal quadrature", "Uniform state: openings p/K, top motion pL/E + p/K"});
  const PatchError error = patch(GetParam(), "nodal", 0, 0);
  VERIFY_LT("relative error of the opening", "1", error.normal, 1e-10);
  VERIFY_LT("shear opening over the normal one", "1", error.shear, 1e-10);
  VERIFY_LT("relative error of the motion of the top", "1", error.top, 1e-10);
}

// Claim: a joint inclined by 30 degrees and distorted shares the traction: p cos^2 across, p sin cos along it: 1e-10.
TEST_P(MeshPatch, InclinedJointSharesTheTraction) {
  VERIFIES({"Joint elements", "Patch test through an inclined and distorted joint", "Mohr: p cos² across the joint, p sin cos along it"});
  const PatchError error = patch(GetParam(), "gauss", 0.08, std::tan(pi / 6));
  VERIFY_LT("relative error of the opening", "1", error.normal, 1e-10);
  VERIFY_LT("error of the shear opening over the normal opening", "1", error.shear, 1e-10);
  VERIFY_LT("relative error of the motion of the top", "1", error.top, 1e-10);
}

}  // namespace
}  // namespace uplift::verification::mesh_patch_test
