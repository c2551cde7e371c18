// Rigid bodies pressed into elastic ground that is meshed. A rigid body's nodes face nodes of the ground without friction and without
// tension (constraints). References (Johnson, Contact Mechanics, 1985): flat strip on the half-plane with uplift,
// line and point contact of Hertz (section 6), stiffness of discs on the half-space (section 8). Meshes of finite size stand for
// half-spaces: the strip's soil reaches to 30 b (fixed below, rollers at the sides), the disc's to 60 R (fixed: it makes K_v 2/(60 pi) = 1
// % stiffer), the contacts' to 30 a and 20 a.
#include <gtest/gtest.h>

#include "manual.h"
#include "punch_support.h"

namespace uplift::verification::mesh_punch_test {
namespace {

// ---- strip ----

constexpr double half_width = 1, strip_load = 1e5;  // m, N/m

struct StripAnswer {
  double moment, uplifted;
};

/// Rigid strip on a mass of 60 x 30 m, `cells` elements under it, turned by `ratio` theta_u.
StripAnswer strip(int cells, double ratio) {
  const double h = 2 * half_width / cells, far = 30;
  const Mesh mesh = rectangle(refined_lines(-far, -half_width, half_width, far, h, 6, 1.3),
                              downwards(refined_lines(0, 0, 2 * h, far, h, 6, 1.3)), Cell::quad4);
  const std::vector<int> touching = nodes_where(mesh, [](const Vec3& x) { return x.y() > -1e-9 && std::abs(x.x()) < half_width + 1e-9; });
  EXPECT_EQ(static_cast<int>(touching.size()), cells + 1);
  Punch punch;
  punch.supports = fixed("bottom", "\"ux\", \"uy\"") + fixed("left", "\"ux\"") + fixed("right", "\"ux\"");
  punch.master = "\"ux\"";
  const double modulus = punch.young / (1 - punch.poisson * punch.poisson), theta_u = 2 * strip_load / (pi * modulus * half_width);
  punch.extra = fmt::format(
      "[[function]]\nname = \"held\"\nshape = {{ type = \"constant\" }}\n[[motion]]\nnode = \"master\"\ndirection = \"rz\"\namplitude = "
      "{:.17g}\nfunction = \"held\"\n[[load]]\nnode = \"master\"\nforce = [0, {:.17g}]\n",
      ratio * theta_u, -strip_load);
  const MeshRun run = run_mesh(punch_text(punch, mesh, touching, h), mesh);
  EXPECT_TRUE(run.completed()) << run.result.reason;
  EXPECT_NEAR(run["foot.axial"][0], -strip_load, 1e-8 * strip_load);
  return {std::abs(run["foot.moment"][0]), run["foot.uplifted_ratio"][0]};
}

// Claim: rigid smooth strip on the elastic half-plane: M_u = W b/2, theta_u = 2 W/(pi E* b); M/M_u = theta/theta_u up to 1 (so the rocking
// stiffness is pi G b^2/(2 (1 - nu)), section 8) and 2 - theta_u/theta beyond, contact ratio theta_u/theta (one element). 2 % on the finest
// mesh, order 1 (the pressure is singular at the edges).
TEST(MeshPunch, StripOnTheHalfPlane) {
  VERIFIES({"Rigid bodies on elastic ground", "Rocking strip on the elastic half-plane",
            "Johnson, Contact Mechanics (1985), section 2.8: M_u = Wb/2, θ_u = 2W/(πE*b), 2 − θ_u/θ"});
  for (const double ratio : {0.5, 1.5, 3.0}) {
    std::vector<double> size, error;
    for (const int cells : {32, 64, 128}) {
      const StripAnswer found = strip(cells, ratio);
      const double exact = strip_load * half_width / 2 * (ratio < 1 ? ratio : 2 - 1 / ratio);
      size.push_back(1.0 / cells), error.push_back(std::abs(found.moment / exact - 1));
      VERIFY_NEAR("share in contact", "1", 1 - found.uplifted, std::min(1.0, 1 / ratio), 2.0 / cells) << ratio;
    }
    RecordProperty(fmt::format("ratio_{}", ratio),
                   fmt::format("{:.2e} {:.2e} {:.2e} order {:.2f}", error[0], error[1], error[2], order(size, error)));
    VERIFY_LT("relative error of the moment, 128 elements", "1", error.back(), 0.02) << ratio;
    verified_case.curve(fmt::format("rotation {} θ_u", ratio), size, error);
    VERIFY_GT("order of convergence", "1", order(size, error), 0.8) << ratio;
  }
}

// ---- Hertz ----

constexpr double radius = 0.1, steel = 210e9, nu = 0.3;  // m, Pa, 1

struct Contact {
  double half_width = 0, peak = 0;  // m, Pa
};

/// The gap r^2/(2 R) below a sphere as a table up to a distance [m].
std::string sphere_gap(double to) {
  std::string positions, gaps;
  constexpr int count = 200;
  for (int k = 0; k <= count; ++k) {
    const double r = to * k / count;
    positions += fmt::format("{}{:.17g}", k ? ", " : "", r), gaps += fmt::format("{}{:.17g}", k ? ", " : "", r * r / (2 * radius));
  }
  return fmt::format("gap_profile = {{ along = \"distance\", centre = [0, 0, 0], positions = [{}], gaps = [{}] }}\n", positions, gaps);
}

/// Cylinder (2D) or sphere (a quarter, 3D) under the load [N], `cells` elements over the exact half width a.
Contact hertz(int dimension, double load, double a, int cells, double growth) {
  const double h = a / cells, far = (dimension == 2 ? 30 : 20) * a;
  const bool plane = dimension == 2;
  const double fine = h * std::ceil(1.2 * cells);
  const std::vector<double> across = refined_lines(plane ? -far : 0, plane ? -fine : 0, fine, far, h, far / 3, growth);
  const std::vector<double> depth = downwards(refined_lines(0, 0, plane ? fine / 2 : 2 * h, far, h, far / 3, growth));
  const Mesh mesh = plane ? rectangle(across, depth, Cell::quad4) : box(across, across, depth, Cell::hex8);
  const std::vector<int> touching = nodes_where(
      mesh, [&](const Vec3& x) { return x[dimension - 1] > -1e-12 && std::abs(x.x()) < fine + 1e-9 && (plane || x.y() < fine + 1e-9); });
  Punch punch;
  punch.young = steel;
  punch.supports = plane ? fixed("bottom", "\"ux\", \"uy\"")
                         : fixed("bottom", "\"ux\", \"uy\", \"uz\"") + fixed("left", "\"ux\"") + fixed("front", "\"uy\"");
  punch.master = plane ? "\"ux\", \"rz\"" : "\"ux\", \"uy\", \"rx\", \"ry\", \"rz\"";
  punch.height = radius;
  punch.extra =
      fmt::format("[[load]]\nnode = \"master\"\nforce = {}\n", triple(plane ? Vec3(0, -load, 0) : Vec3(0, 0, -load / 4), dimension));
  const double cell = plane ? h : h * h;
  if (plane) {  // the cylinder as it is drawn, the sphere from a table
    punch.gap = "gap = \"geometry\"\n";
    punch.drawn_above = [](const Vec3& x) { return x.x() * x.x() / (2 * radius); };
  } else {
    punch.gap = sphere_gap(std::sqrt(2.0) * (fine + h));
  }
  const MeshRun run = run_mesh(punch_text(punch, mesh, touching, cell), mesh, watch_tractions);
  EXPECT_TRUE(run.completed()) << run.result.reason;
  // int x^2 p = P a^2/4 (line), int r^2 p = 2/5 P a^2 (sphere): a from the moment of the pressure, not from counting nodes
  double sum = 0, moment = 0;
  Contact found;
  for (std::size_t i = 0; i < touching.size(); ++i) {
    const Vec3 x = mesh.nodes[static_cast<std::size_t>(touching[i])];
    const double force = -run[fmt::format("p{}", i)][0] * cell, share = plane ? 1 : (x.x() < 1e-12 ? 0.5 : 1) * (x.y() < 1e-12 ? 0.5 : 1);
    sum += force;
    moment += force * (x.x() * x.x() + (plane ? 0 : x.y() * x.y()));
    found.peak = std::max(found.peak, force / (cell * share));
  }
  EXPECT_NEAR(sum, plane ? load : load / 4, 1e-8 * load);
  found.half_width = std::sqrt(moment / sum * (plane ? 4 : 2.5));
  return found;
}

// Claim: rigid cylinder R = 0.1 m on E = 210e9 Pa, nu = 0.3, P' = 3.5e7 N/m: a = sqrt(4 P' R/(pi E*)) = 4.39440551e-3 m, p0 = 2 P'/(pi a) =
// 5.07046789e9 Pa: 1 % with ten elements over a, order 1 or better.
TEST(MeshPunch, LineContactOfHertz) {
  VERIFIES({"Rigid bodies on elastic ground", "Line contact of Hertz", "Johnson, Contact Mechanics (1985), section 4.2"});
  const double load = 3.5e7, modulus = steel / (1 - nu * nu), a = std::sqrt(4 * load * radius / (pi * modulus)), p0 = 2 * load / (pi * a);
  VERIFY_NEAR("half width, closed form", "m", a, 4.39440551e-3, 1e-11);
  VERIFY_NEAR("peak pressure, closed form", "Pa", p0, 5.07046789e9, 10);
  std::vector<double> size, error;
  for (const int cells : {5, 10, 20}) {
    const Contact found = hertz(2, load, a, cells, 1.3);
    size.push_back(1.0 / cells), error.push_back(std::abs(found.half_width / a - 1));
    RecordProperty(fmt::format("cells_{}", cells), fmt::format("a {:.2e} p0 {:.2e}", found.half_width / a - 1, found.peak / p0 - 1));
    if (cells < 10) continue;
    VERIFY_NEAR("half width", "m", found.half_width, a, 0.01 * a) << cells;
    VERIFY_NEAR("peak pressure", "Pa", found.peak, p0, 0.01 * p0) << cells;
  }
  verified_case.curve("half width", size, error);
  VERIFY_GT("order of convergence of the half width", "1", order(size, error), 0.8);
}

// Claim: the same cylinder as a mesh of its own, drawn above the ground it touches in one line (`surface` with two groups, gap =
// "geometry"): a and p0 of Hertz within 1 % with ten elements over a.
TEST(MeshPunch, LineContactOfACylinderThatIsDrawn) {
  VERIFIES({"Rigid bodies on elastic ground", "Line contact of a cylinder that is meshed",
            "Hertz: Johnson, Contact Mechanics (1985), section 4.2"});
  const double load = 3.5e7, modulus = steel / (1 - nu * nu), a = std::sqrt(4 * load * radius / (pi * modulus)), p0 = 2 * load / (pi * a);
  constexpr int cells = 10;
  const double h = a / cells, fine = h * std::ceil(1.2 * cells), far = 30 * a;
  std::vector<double> depth = downwards(refined_lines(0, 0, fine / 2, far, h, far / 3, 1.3));
  const int layers = static_cast<int>(depth.size()) - 1;
  depth.insert(depth.end(), {h, 2 * h});  // an empty row, then the cylinder
  const std::vector<double> across = refined_lines(-far, -fine, fine, far, h, far / 3, 1.3);
  const auto part = [&](int i, int j, int) {
    const double x = (across[static_cast<std::size_t>(i)] + across[static_cast<std::size_t>(i) + 1]) / 2;
    return j < layers ? 0 : j > layers && std::abs(x) < fine ? 1 : -1;
  };
  const auto face = [&](int of, Direction direction, int other) -> std::string {
    return other < 0 ? (of == 0 ? "ground_" : "cylinder_") + std::string(name_of(direction)) : "";
  };
  Mesh mesh = grid({across, depth, {}}, part, {"ground", "cylinder"}, face);
  for (Vec3& x : mesh.nodes) {
    if (std::abs(x.y() - h) < 1e-9 * h) x.y() = x.x() * x.x() / (2 * radius);
    if (std::abs(x.y() - 2 * h) < 1e-9 * h) x.y() = radius / 2;
  }
  // the ground's top is wider than the cylinder: the middle of it is a group of its own
  Group& under = mesh.groups["under"];
  under.dimension = 1;
  for (const CellId cell : mesh.groups["ground_top"].cells)
    if (std::abs(
            (mesh.nodes[static_cast<std::size_t>(mesh.cell(cell)[0])] + mesh.nodes[static_cast<std::size_t>(mesh.cell(cell)[1])]).x()) /
            2 <
        fine)
      under.cells.push_back(cell);
  const std::string text = fmt::format(
      "title = \"cylinder\"\n[mesh]\nfile = \"cylinder.msh\"\n[[solid]]\ngroup = \"ground\"\nE = 210e9\npoisson = 0.3\ndensity = 1000\n"
      "[[solid]]\ngroup = \"cylinder\"\nE = 210e9\npoisson = 0.3\ndensity = 1000\n{}[nodes]\nmaster = [0, {:.17g}]\n"
      "[[rigid]]\nname = \"cylinder\"\nnode = \"master\"\ngroup = \"cylinder\"\n"
      "[[support]]\nnode = \"master\"\nfixed = [\"ux\", \"rz\"]\n[[load]]\nnode = \"master\"\nforce = [0, {:.17g}]\n"
      "[[interface]]\nname = \"foot\"\nsurface = {{ lower_group = \"under\", upper_group = \"cylinder_bottom\" }}\ngap = \"geometry\"\n"
      "law = \"unilateral\"\n[[stage]]\ntype = \"static\"\nsteps = 1\n",
      fixed("ground_bottom", "\"ux\", \"uy\""), radius / 2, -load);
  const MeshRun run = run_mesh(text, mesh, watch_tractions);
  ASSERT_TRUE(run.completed()) << run.result.reason;
  const Interface& foot = run.built.model.interfaces.front();
  double sum = 0, moment = 0, peak = 0;
  for (int i = 0; i < foot.batch.points; ++i) {
    const double pressure = -run[fmt::format("p{}", i)].back(), x = foot.position[static_cast<std::size_t>(i)].x();
    sum += pressure * foot.area[i], moment += pressure * foot.area[i] * x * x, peak = std::max(peak, pressure);
  }
  VERIFY_NEAR("total force", "N/m", sum, load, 1e-8 * load);
  RecordProperty("errors", fmt::format("a {:.2e} p0 {:.2e}", 2 * std::sqrt(moment / sum) / a - 1, peak / p0 - 1));
  VERIFY_NEAR("half width", "m", 2 * std::sqrt(moment / sum), a, 0.01 * a);
  VERIFY_NEAR("peak pressure", "Pa", peak, p0, 0.01 * p0);
}

// Claim: rigid sphere R = 0.1 m, P = 1e4 N: a = (3 P R/(4 E*))^(1/3) = 1.48124803e-3 m, p0 = 3 P/(2 pi a^2) = 2.17613489e9 Pa: 2 % with ten
// elements over a.
TEST(MeshPunch, PointContactOfHertz) {
  VERIFIES({"Rigid bodies on elastic ground", "Point contact of Hertz", "Johnson, Contact Mechanics (1985), section 4.2"});
  const double load = 1e4, modulus = steel / (1 - nu * nu), a = std::cbrt(3 * load * radius / (4 * modulus)),
               p0 = 3 * load / (2 * pi * a * a);
  VERIFY_NEAR("radius of the contact, closed form", "m", a, 1.48124803e-3, 1e-11);
  VERIFY_NEAR("peak pressure, closed form", "Pa", p0, 2.17613489e9, 10);
  const Contact found = hertz(3, load, a, 10, 2);
  RecordProperty("sphere", fmt::format("a {:.2e} p0 {:.2e}", found.half_width / a - 1, found.peak / p0 - 1));
  VERIFY_NEAR("radius of the contact", "m", found.half_width, a, 0.02 * a);
  VERIFY_NEAR("peak pressure", "Pa", found.peak, p0, 0.02 * p0);
}

// ---- discs ----

constexpr double coarsening = 1.7;  // of the cells away from the edge of the disc

/// Cells that shrink towards the edge of the disc from both sides, the smallest 1/cells^2 of its radius: `cells` of them inside, then
/// growing outwards to `far`.
std::vector<double> radii(int cells, double far) {
  std::vector<double> lines;
  for (int k = 0; k <= cells; ++k) lines.push_back(1 - std::pow(1 - static_cast<double>(k) / cells, 2));
  for (double h = 1 - lines[lines.size() - 2]; lines.back() < far; h *= coarsening) lines.push_back(std::min(far, lines.back() + h));
  return lines;
}

/// A quarter of the half-space as a cylinder: rings of a square grid become circles, one of them the edge of the disc (radius 1).
Mesh quarter_space(int cells) {
  const double far = 60;
  const std::vector<double> across = radii(cells, far);
  std::vector<double> depths{0};
  for (double h = 1 - across[static_cast<std::size_t>(cells) - 1]; depths.back() < far; h *= coarsening)
    depths.push_back(std::min(far, depths.back() + h));
  Mesh mesh = box(across, across, downwards(depths), Cell::hex8);
  const auto place = [&](double x) { return static_cast<double>(std::ranges::lower_bound(across, x - 1e-9) - across.begin()); };
  for (Vec3& x : mesh.nodes) {
    const double i = place(x.x()), j = place(x.y()), ring = across[static_cast<std::size_t>(std::max(i, j))];
    const double angle = i == j ? pi / 4 : i > j ? pi / 4 * j / i : pi / 2 - pi / 4 * i / j;
    x.x() = ring * std::cos(angle), x.y() = ring * std::sin(angle);
  }
  return mesh;
}

enum class Motion { vertical, horizontal, rocking };

/// Stiffness of a rigid disc of radius 1 on the half-space, from a quarter of it.
double disc_stiffness(int cells, Motion motion, double young, double poisson) {
  const Mesh mesh = quarter_space(cells);
  const std::vector<int> touching = nodes_where(mesh, [](const Vec3& x) { return x.z() > -1e-9 && std::hypot(x.x(), x.y()) < 1 + 1e-9; });
  EXPECT_EQ(static_cast<int>(touching.size()), (cells + 1) * (cells + 1));
  Punch punch;
  punch.young = young;
  punch.poisson = poisson;
  const bool even = motion == Motion::vertical;
  punch.supports = fixed("left", even ? "\"ux\"" : "\"uy\", \"uz\"") + fixed("front", "\"uy\"");
  for (const char* side : {"bottom", "right", "back"}) punch.supports += fixed(side, "\"ux\", \"uy\", \"uz\"");
  const char* free = even ? "uz" : motion == Motion::horizontal ? "ux" : "ry";
  for (const char* word : {"ux", "uy", "uz", "rx", "ry", "rz"})
    if (std::string(word) != free) punch.master += fmt::format("{}\"{}\"", punch.master.empty() ? "" : ", ", word);
  punch.height = 0.01;
  punch.extra = "[[load]]\nnode = \"master\"\n";
  punch.extra += even ? "force = [0, 0, -1e4]\n" : motion == Motion::horizontal ? "force = [1e4, 0, 0]\n" : "moments = [0, 1e4, 0]\n";
  // far stiffer than the ground in the direction of the motion, nothing (1e-9) across: smooth
  const double stiff = young * 1e5, soft = young * 1e-9;
  punch.law = motion == Motion::horizontal
                  ? fmt::format("{{ type = \"elastic\", K_n = {:.17g}, tangential = \"bonded\", K_t = {:.17g} }}", soft, stiff)
                  : fmt::format("{{ type = \"elastic\", K_n = {:.17g}, tangential = \"none\" }}", stiff);
  const std::string text = punch_text(punch, mesh, touching, 1.0 / (cells * cells)) +
                           fmt::format("[[output.history]]\nname = \"moved\"\nnode = \"master\"\nquantity = \"{}\"\n", free);
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml",
                               [&](const std::string&, const Where&, const std::string&) { return mesh; });
  BuiltCase built = build(read, RunSpec{});
  built.plan.stages.resize(1);  // equilibrium is all that is asked for
  const int unknown = std::ranges::find(built.plan.requests, "moved", &Request::name)->unknown;
  double moved = 0;
  const RunResult result = run(built.model, built.plan, built.behaviours, {},
                               [&](const Snapshot& snapshot) { moved = built.model.full(snapshot.state.displacement, 0, 0)[unknown]; });
  EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
  return 4 * 1e4 / std::abs(moved);
}

// Claim: smooth rigid disc on the half-space: K_v = 4 G R/(1 - nu), K_h = 8 G R/(2 - nu), K_r = 8 G R^3/(3 (1 - nu)): too stiff on every
// mesh, within 5 % with five cells over the radius that shrink towards its edge, where the pressure is singular. Soil to 60 R: its far
// boundary alone makes K_v 2/(60 pi) = 1 % stiffer.
TEST(MeshPunch, DiscOnTheHalfSpace) {
  VERIFIES({"Rigid bodies on elastic ground", "Stiffness of a disc on the half-space",
            "4GR/(1 − ν), 8GR/(2 − ν), 8GR³/(3(1 − ν)): Richart, Hall & Woods, Vibrations of Soils and Foundations (1970)"});
  const double young = 1e8, poisson = 0.3, shear = young / (2 * (1 + poisson));
  struct Kind {
    Motion motion;
    const char* name;
    double exact;
  };
  for (const auto& [motion, name, exact] : {Kind{Motion::vertical, "K_v", 4 * shear / (1 - poisson)},
                                            {Motion::horizontal, "K_h", 8 * shear / (2 - poisson)},
                                            {Motion::rocking, "K_r", 8 * shear / (3 * (1 - poisson))}}) {
    std::vector<double> error;
    for (const int cells : {3, 5}) error.push_back(disc_stiffness(cells, motion, young, poisson) / exact - 1);
    RecordProperty(name, fmt::format("{:.3e} {:.3e}", error[0], error[1]));
    VERIFY_GT("relative error of the stiffness, finer mesh (too stiff)", "1", error[1], 0) << name;
    VERIFY_LT("relative error of the stiffness, finer mesh", "1", error[1], 0.05) << name;
    VERIFY_LT("relative error, finer mesh, compared with 0.8 times that of the coarser one", "1", error[1], 0.8 * error[0]) << name;
  }
}

}  // namespace
}  // namespace uplift::verification::mesh_punch_test
