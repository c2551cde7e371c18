// Rigid tensionless bases on Winkler beds in space: a disc whose joints are the faces of a mesh, and a rectangle
// turned about both axes. References by quadrature made here: the pressure is k (w + r . x)+, w such that it carries the load W.
#include <gtest/gtest.h>

#include "manual.h"
#include "mesh_support.h"

namespace uplift::verification::mesh_footing_test {
namespace {

constexpr double bed = 2e8, weight = 1e6;  // Pa/m, N

/// f(lower) < 0 < f(upper).
double root_of(const std::function<double(double)>& f, double lower, double upper) {
  for (int i = 0; i < 200; ++i) {
    const double middle = (lower + upper) / 2;
    (f(middle) < 0 ? lower : upper) = middle;
  }
  return (lower + upper) / 2;
}

double simpson(const std::function<double(double)>& f, double from, double to, int pieces = 2000) {
  double sum = f(from) + f(to);
  for (int i = 1; i < pieces; ++i) sum += (i % 2 ? 4 : 2) * f(from + (to - from) * i / pieces);
  return sum * (to - from) / (3 * pieces);
}

// ---- disc ----

struct DiscAnswer {
  double moment = 0, uplifted = 0, toe = 0;  // N m, 1, Pa
};

/// Disc of radius 1 turned by theta: p = k theta (x - c)+.
DiscAnswer exact_disc(double theta) {
  // x = cos t: no root in the integrand
  const auto over = [&](double c, int power) {
    const double end = c <= -1 ? pi : std::acos(std::min(c, 1.0));
    return simpson([&](double t) { return bed * theta * (std::cos(t) - c) * std::pow(std::cos(t), power) * 2 * std::sin(t) * std::sin(t); },
                   0, end);
  };
  const double c = root_of([&](double line) { return weight - over(line, 0); }, -weight / (pi * bed * theta) - 1, 1);
  DiscAnswer exact;
  exact.moment = over(c, 1);
  exact.toe = bed * theta * (1 - c);
  if (c > -1) exact.uplifted = 1 - (std::acos(c) - c * std::sqrt(1 - c * c)) / pi;
  return exact;
}

/// Two flat layers of a disc, the lower one held, the upper one rigid; the joint between them is the bed.
DiscAnswer disc(Cell cell, const char* quadrature, int cells, double theta) {
  const std::vector<double> across = uniform_lines(-1, 1, cells);
  const auto part_at = [](int, int, int k) { return k; };
  const auto face = [](int part, Direction, int other) { return std::string(part == 0 && other == 1 ? "interface" : ""); };
  Mesh mesh = with_cells(grid({across, across, {-0.1, 0, 0.1}}, part_at, {"ground", "raft"}, face), cell);
  for (Vec3& x : mesh.nodes) {  // rings of the square become circles; mid-side nodes too
    const double r = std::hypot(x.x(), x.y()), ring = std::max(std::abs(x.x()), std::abs(x.y()));
    if (r > 0) x.x() *= ring / r, x.y() *= ring / r;
  }
  // opening appends a double of every node of the joint
  std::vector<int> body = nodes_where(mesh, [](const Vec3& x) { return x.z() > 1e-9; });
  const auto joint = static_cast<int>(nodes_of(mesh, mesh.groups.at("interface")).size()), before = static_cast<int>(mesh.nodes.size());
  for (int i = 0; i < joint; ++i) body.push_back(before + i);
  std::string text = "title = \"disc\"\n[mesh]\nfile = \"disc.msh\"\n[nodes]\nmaster = [0, 0, 0.2]\n";
  for (const char* part : {"ground", "raft"}) text += fmt::format("[[solid]]\ngroup = \"{}\"\nE = 1e9\npoisson = 0.2\ndensity = 1\n", part);
  text += fmt::format(
      "[[rigid]]\nname = \"raft\"\nnode = \"master\"\nslaves = {}\nmass = 1e4\ninertia = 1e4\n[[support]]\ngroup = \"ground\"\nfixed = "
      "[\"ux\", \"uy\", \"uz\"]\n[[support]]\nnode = \"master\"\nfixed = [\"ux\", \"uy\", \"rx\", \"rz\"]\n[[function]]\nname = "
      "\"held\"\nshape = {{ type = \"constant\" }}\n[[motion]]\nnode = \"master\"\ndirection = \"ry\"\namplitude = {:.17g}\nfunction = "
      "\"held\"\n[[interface]]\nname = \"bed\"\nsurface = {{ group = \"interface\", lower = [\"ground\"], quadrature = \"{}\" }}\nlaw = {{ "
      "type "
      "= \"springs\", K_n = {}, tangential = \"none\" }}\n[[load]]\nnode = \"master\"\nforce = [0, 0, {}]\n[[stage]]\ntype = "
      "\"static\"\nsteps = 1\n[[stage]]\ntype = \"dynamic\"\nduration = 1e-7\nstep = 1e-7\n[energy]\ncreated_limit = "
      "1e9\n[limits]\nrotation "
      "= 1\n[output]\nframes = 0\n",
      names_of(body), theta, quadrature, bed, -weight);
  const MeshRun run = run_mesh(text, mesh);
  EXPECT_TRUE(run.completed()) << run.result.reason;
  EXPECT_NEAR(run["bed.axial"][0], -weight, 1e-9 * weight);
  // the diagonals of triangles are not symmetric to the x axis
  if (info(info(cell).linear).corners == 8) EXPECT_LT(std::abs(run["bed.moment_1"][0]), 1e-9 * weight);
  return {run["bed.moment_2"][0], run["bed.uplifted_ratio"][0], run["bed.max_pressure"][0]};
}

// Claim: the quadrature of this file gives the table: 30 % of the area uplifted at theta/theta_u = 2.473383 with M/M_u = 1.874109,
// p_toe/p_mean = 3.264103; M_u = W R/4 at theta_u = W/(pi R^3 k). This checks the reference, not the program.
TEST(MeshFooting, TheQuadratureGivesTheTableOfTheDisc) {
  VERIFIES({"Footings", "Disc on a Winkler bed, quadrature of the reference", "Closed forms M_u = WR/4 and a published table"});
  const double theta_u = weight / (pi * bed);
  const DiscAnswer a = exact_disc(2.473383 * theta_u), first = exact_disc(theta_u);
  VERIFY_NEAR("moment at the beginning of uplift", "N m", first.moment, weight / 4, 1e-6 * weight);
  VERIFY_NEAR("moment over M_u at 30 % uplift", "1", a.moment / (weight / 4), 1.874109, 1e-6);
  VERIFY_NEAR("uplifted share", "1", a.uplifted, 0.3, 1e-6);
  VERIFY_NEAR("toe pressure over mean pressure", "1", a.toe / (weight / pi), 3.264103, 1e-6);
}

// Claim: the disc by joints on the faces of a mesh of every kind, both quadratures: moment 1e-2 with 16 faces over the diameter and
// order 2 with straight edges (they miss a part of the area of order h^2), 2e-3 with curved ones (where the edge of the contact cuts the
// faces decides, no order).
TEST(MeshFooting, DiscOfFaceJoints) {
  VERIFIES({"Footings", "Disc of face joints on a Winkler bed", "Quadrature of k (w + θx)+ over the disc"});
  const double theta_u = weight / (pi * bed);
  for (const double ratio : {0.7, 2.473383, 5.0}) {
    const DiscAnswer exact = exact_disc(ratio * theta_u);
    for (const auto& [cell, quadrature] : {std::pair{Cell::hex8, "nodal"},
                                           {Cell::hex8, "gauss"},
                                           {Cell::wedge6, "nodal"},
                                           {Cell::wedge6, "gauss"},
                                           {Cell::hex27, "nodal"},
                                           {Cell::hex20, "gauss"},
                                           {Cell::wedge15, "gauss"}}) {
      SCOPED_TRACE(fmt::format("{} {} {}", info(cell).name, quadrature, ratio));
      std::vector<double> size, error;
      for (const int cells : {4, 8, 16}) {
        const DiscAnswer found = disc(cell, quadrature, cells, ratio * theta_u);
        size.push_back(1.0 / cells), error.push_back(std::abs(found.moment / exact.moment - 1));
        VERIFY_LT("error of the uplifted share", "1", std::abs(found.uplifted - exact.uplifted), 0.5 / (cells * cells))
            << cells << ": " << found.uplifted - exact.uplifted;
        if (cells == 16 && std::string(quadrature) == "nodal") VERIFY_NEAR("toe pressure", "Pa", found.toe, exact.toe, 0.02 * exact.toe);
      }
      RecordProperty(fmt::format("{}_{}_{}", info(cell).name, quadrature, static_cast<int>(10 * ratio)),
                     fmt::format("{:.1e} {:.1e} {:.1e} order {:.2f}", error[0], error[1], error[2], order(size, error)));
      const bool curved = info(cell).linear != cell;
      VERIFY_LT("relative error of the moment, 16 faces", "1", error.back(), curved ? 2e-3 : 1e-2);
      if (!curved) verified_case.curve(fmt::format("{} {} {:.2g}", info(cell).name, quadrature, ratio), size, error);
      if (!curved) VERIFY_GT("order of convergence, straight edges", "1", order(size, error), 1.6);
    }
  }
}

// ---- rectangle ----

struct RectangleAnswer {
  double about_x = 0, about_y = 0;  // N m: of the pressure on the ground, -int y p and int x p
};

constexpr double length_x = 6, length_y = 4;  // m

/// Pressure k (w - turn_x y + turn_y x)+ on the rectangle, carrying the weight.
RectangleAnswer exact_rectangle(double turn_x, double turn_y) {
  const double a = length_x / 2, b = length_y / 2;
  // int (c + s x)+ x^power dx from -a to a, closed form
  const auto inner = [&](double c, int power) {
    const double zero = std::clamp(-c / turn_y, -a, a);
    const auto primitive = [&](double x) { return power == 0 ? c * x + turn_y * x * x / 2 : c * x * x / 2 + turn_y * x * x * x / 3; };
    return turn_y > 0 ? primitive(a) - primitive(zero) : primitive(zero) - primitive(-a);
  };
  const auto load = [&](double w) { return bed * simpson([&](double y) { return inner(w - turn_x * y, 0); }, -b, b, 20000); };
  const double w =
      root_of([&](double value) { return load(value) - weight; }, -a * std::abs(turn_y) - b * std::abs(turn_x), weight / (bed * a * b));
  return {-bed * simpson([&](double y) { return y * inner(w - turn_x * y, 0); }, -b, b, 20000),
          bed * simpson([&](double y) { return inner(w - turn_x * y, 1); }, -b, b, 20000)};
}

RectangleAnswer rectangle_footing(const char* rule, int points, double turn_x, double turn_y) {
  std::string text =
      "title = \"rectangle\"\n[nodes]\nbase = [0, 0, 0]\n[[rigid]]\nname = \"raft\"\nnode = \"base\"\nmass = 1e4\ninertia = "
      "1e4\n[[support]]\n"
      "node = \"base\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n[[function]]\nname = \"held\"\nshape = { type = \"constant\" }\n";
  for (const auto& [word, value] : {std::pair{"rx", turn_x}, std::pair{"ry", turn_y}})
    text += fmt::format("[[motion]]\nname = \"{}\"\nnode = \"base\"\ndirection = \"{}\"\namplitude = {:.17g}\nfunction = \"held\"\n", word,
                        word, value);
  text += fmt::format(
      "[[interface]]\nname = \"bed\"\nfooting = {{ body = \"base\", width = {}, length = {}, points = {}, points_across = {}, rule = "
      "\"{}\" "
      "}}\nlaw = {{ type = \"springs\", K_n = {}, tangential = \"none\" }}\n[[load]]\nnode = \"base\"\nforce = [0, 0, {}]\n[[stage]]\ntype "
      "= "
      "\"static\"\nsteps = 1\n[[stage]]\ntype = \"dynamic\"\nduration = 1e-7\nstep = 1e-7\n[energy]\ncreated_limit = "
      "1e9\n[limits]\nrotation "
      "= 1\n[output]\nframes = 0\n",
      length_x, length_y, points, points, rule, bed, -weight);
  const MeshRun run = run_mesh(text, {});
  EXPECT_TRUE(run.completed()) << run.result.reason;
  EXPECT_NEAR(run["bed.axial"][0], -weight, 1e-9 * weight);
  return {run["bed.moment_1"][0], run["bed.moment_2"][0]};
}

// Claim: rectangle 6 x 4 m turned about both axes: both moments with their signs, 1e-2 with 24 cells a side, order 2 (nodal and midpoint
// rules).
TEST(MeshFooting, RectangleTurnedAboutBothAxes) {
  VERIFIES({"Footings", "Rectangle turned about both axes", "Quadrature of k (w − θ_x y + θ_y x)+ over the rectangle"});
  // closed: M_x = k L_x L_y^3/12 turn_x
  const double small = 1e-6;
  VERIFY_NEAR("moment about x in full contact, closed form", "N m", exact_rectangle(small, small).about_x,
              bed * length_x * std::pow(length_y, 3) / 12 * small, 1e-9 * weight);
  VERIFY_NEAR("moment about y in full contact, closed form", "N m", exact_rectangle(small, small).about_y,
              bed * length_y * std::pow(length_x, 3) / 12 * small, 1e-9 * weight);
  const double unit = weight / (bed * length_x * length_y * length_x / 2);
  for (const auto& [turn_x, turn_y] :
       {std::pair{1.5 * unit, 1.0 * unit}, std::pair{-3 * unit, 2.5 * unit}, std::pair{0.4 * unit, -4 * unit}}) {
    const RectangleAnswer exact = exact_rectangle(turn_x, turn_y);
    for (const char* rule : {"nodal", "midpoint"}) {
      std::vector<double> size, error;
      for (const int cells : {6, 12, 24}) {
        const RectangleAnswer found = rectangle_footing(rule, cells + (rule[0] == 'n'), turn_x, turn_y);
        size.push_back(1.0 / cells);
        error.push_back(std::hypot(found.about_x - exact.about_x, found.about_y - exact.about_y) /
                        std::hypot(exact.about_x, exact.about_y));
      }
      RecordProperty(fmt::format("{}_{:.1f}_{:.1f}", rule, turn_x / unit, turn_y / unit),
                     fmt::format("{:.1e} {:.1e} {:.1e} order {:.2f}", error[0], error[1], error[2], order(size, error)));
      VERIFY_LT("relative error of the moments, 24 cells", "1", error.back(), 1e-2) << rule;
      verified_case.curve(fmt::format("{} {:.1f} {:.1f}", rule, turn_x / unit, turn_y / unit), size, error);
      VERIFY_NEAR("order of convergence", "1", order(size, error), 2, 0.4) << rule;
    }
  }
}

}  // namespace
}  // namespace uplift::verification::mesh_footing_test
