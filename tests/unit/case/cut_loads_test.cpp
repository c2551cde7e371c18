#include <array>
#include <utility>

#include "text_support.h"
#include "unit/case/cut_support.h"

// Loads on the surface that the ground has in the plane of a cut, beside what stands on it.
namespace uplift::cut_loads_test {
namespace {

using namespace support;

constexpr double pressure = 8e4, slope_of_factor = 0.25;

/// A plane z = height + rise x, the ground below it, and a structure above it within these limits of x and y.
struct Place {
  double height, rise;
  std::array<double, 2> x{-0.7, 0.9}, y{-0.4, 0.65};
};

std::string cut_of(const Place& place, int dimension) {
  const double c = 1 / std::hypot(1, place.rise), s = place.rise * c;
  const std::string outline = fmt::format("x = [{}, {}]", place.x[0], place.x[1]);
  if (dimension == 2)
    return fmt::format("cut = {{ through = [\"volume\"], point = [0, {}], normal = [{}, {}], upper = \"raft\", {}, free = \"meadow\" }}\n",
                       place.height, -s, c, outline);
  return fmt::format(
      "cut = {{ through = [\"volume\"], point = [0, 0, {}], normal = [{}, 0, {}], upper = \"raft\", {}, y = [{}, {}], free = \"meadow\" "
      "}}\n",
      place.height, -s, c, outline, place.y[0], place.y[1]);
}

Mesh ground(Cell cell) {
  const auto x = uniform_lines(-2, 2, 8), y = uniform_lines(-1.5, 1.5, 5), z = uniform_lines(0, 2, 5);
  return info(cell).dimension == 2 ? rectangle(x, z, cell) : box(x, y, z, cell);
}

std::string model(const Place& place, int dimension, const std::string& loads, const std::string& interface) {
  return "title = \"meadow\"\n[mesh]\nfile = \"ground.msh\"\n" + solid("volume", 5e7, 0.3, 2000) + solid("raft", 3e10, 0.2, 2500) + loads +
         "[[interface]]\nname = \"base\"\n" + cut_of(place, dimension) + interface;
}

const std::string joint = "law = { type = \"elastic\", K_n = 1e9, K_t = 1e9 }\n";
std::string held(const std::string& group, int dimension) {
  return fmt::format("[[support]]\ngroup = \"{}\"\nfixed = [\"ux\", \"uy\"{}]\n", group, dimension == 3 ? ", \"uz\"" : "");
}

/// Integrals over the ground less the structure of f, f x, f y, f x^2, f x y with the factor f = 1 + x/4. In the plane y does not count.
struct Integrals {
  double one = 0, x = 0, y = 0;
  Integrals(const Place& place, int dimension) {
    add({-2, 2}, dimension == 2 ? std::array{0.0, 1.0} : std::array{-1.5, 1.5}, 1);
    add(place.x, dimension == 2 ? std::array{0.0, 1.0} : place.y, -1);
  }
  void add(std::array<double, 2> a, std::array<double, 2> b, double sign) {
    const auto power = [](std::array<double, 2> ends, int n) { return (std::pow(ends[1], n + 1) - std::pow(ends[0], n + 1)) / (n + 1); };
    one += sign * (power(a, 0) + slope_of_factor * power(a, 1)) * power(b, 0);
    x += sign * (power(a, 1) + slope_of_factor * power(a, 2)) * power(b, 0);
    y += sign * (power(a, 0) + slope_of_factor * power(a, 1)) * power(b, 1);
  }
};

/// Force and moment about the origin of the first load.
std::pair<Vec3, Vec3> sums_of_load(const BuiltCase& built) {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (std::size_t node = 0; node < built.model.nodes.size(); ++node) {
    Vec3 at_node = Vec3::Zero();
    for (int k = 0; k < built.model.space.dimension; ++k)
      at_node[k] = built.model.assembly.loads.front().coeff(built.model.space.unknowns() * static_cast<int>(node) + k);
    force += at_node, moment += cross(built.model.nodes[node].position, at_node);
  }
  return {force, moment};
}

const std::array<Place, 4> places{{{1.13, 0}, {1.2, 0}, {1.13, 0.2}, {1.2, 0.4}}};  // the second and the last one go through nodes

TEST(CutLoads, ResultantAndMomentsArePressureTimesSurface) {
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8})
    for (const Place& place : places) {
      const int d = info(cell).dimension;
      const std::string load = fmt::format(
          "[[load]]\ngroup = \"meadow\"\npressure = {}\nprofile = {{ along = \"x\", positions = [-2, 2], factors = [0.5, 1.5] }}\n",
          pressure);
      const Case read = read_on(model(place, d, held("bottom", d) + load, joint) + at_rest_stages, ground(cell));
      const BuiltCase built = build(read, RunSpec{});
      const auto [force, moment] = sums_of_load(built);
      // -p (-t, 0, 1) dx dy at (x, y, height + t x)
      const Integrals sum(place, d);
      const double t = place.rise, z = place.height * sum.one + t * sum.x, size = pressure * 12;
      const Vec3 expected = d == 2 ? Vec3(t * sum.one, -sum.one, 0) : Vec3(t * sum.one, 0, -sum.one);
      const Vec3 turned = d == 2 ? Vec3(0, 0, -(sum.x + t * z)) : Vec3(-sum.y, t * z + sum.x, -t * sum.y);
      EXPECT_NEAR((force - pressure * expected).norm(), 0, 1e-12 * size) << info(cell).name << " " << place.height << " " << t;
      EXPECT_NEAR((moment - pressure * turned).norm(), 0, 1e-12 * size) << info(cell).name << " " << place.height << " " << t;
    }
}

TEST(CutLoads, TractionAndForceHaveTheAreaOfTheSurface) {
  const double area = (4 - 1.6) * std::hypot(1, 0.2);  // of the third place
  for (const char* what : {"traction = [3, -5]", "force = [3, -5]"}) {
    const Case read =
        read_on(model(places[2], 2, held("bottom", 2) + "[[load]]\ngroup = \"meadow\"\n" + what + "\n", joint) + at_rest_stages,
                ground(Cell::quad4));
    const BuiltCase built = build(read, RunSpec{});
    const Vec3 sum = sums_of_load(built).first, expected = what[0] == 't' ? Vec3(3 * area, -5 * area, 0) : Vec3(3, -5, 0);
    EXPECT_NEAR((sum - expected).norm(), 0, 1e-12 * expected.norm()) << what;
  }
}

TEST(CutLoads, UniformPressureOnEverySideIsUniformStrain) {
  // The ground under one pressure p from all sides, that of the water under the raft included: strain -p (1 + nu)(1 - 2 nu)/E in the plane,
  // -p (1 - 2 nu)/E in space, wherever the plane cuts the cells. The raft is held, and the joint carries nothing.
  const std::string wet = fmt::format("water = {{ head = {} }}\nlaw = {{ type = \"elastic\", K_n = 1e-6, K_t = 1e-6 }}\n", pressure / 9810);
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::hex8})
    for (const Place& place : places) {
      const int d = info(cell).dimension;
      const double strain = -pressure * (d == 2 ? 1.3 * 0.4 : 0.4) / 5e7;
      std::string loads = held("top", d);
      for (const char* group : {"left", "right", "meadow", "front", "back"})
        if (d == 3 || (group[0] != 'f' && group[0] != 'b'))
          loads += fmt::format("[[load]]\nname = \"on {0}\"\ngroup = \"{0}\"\npressure = {1}\n", group, pressure);
      loads += fmt::format("[[support]]\ngroup = \"bottom\"\nfixed = [\"{}\"]\n", d == 2 ? "uy" : "uz");
      loads += fmt::format("[[support]]\nnode = \"mesh.1\"\nfixed = [\"ux\"{}]\n", d == 2 ? "" : ", \"uy\"");
      if (d == 3) loads += "[[support]]\nnode = \"mesh.9\"\nfixed = [\"uy\"]\n";  // at the other end of the edge
      const std::string zero = d == 2 ? "" : "-1.5, ";
      const std::string text =
          model(place, d, loads, wet) + fmt::format("[[output.history]]\nname = \"along\"\nat = [2, {0}0]\nquantity = \"ux\"\n", zero) +
          fmt::format("[[output.history]]\nname = \"up\"\nat = [1, {0}0.4]\nquantity = \"{1}\"\n", zero, d == 2 ? "uy" : "uz") +
          at_rest_stages;
      const RunResult result = run_on(text, ground(cell));
      EXPECT_NEAR(at_rest(result, "along"), 4 * strain, 4e-12 * std::abs(strain)) << info(cell).name << " " << place.height;
      EXPECT_NEAR(at_rest(result, "up"), 0.4 * strain, 4e-12 * std::abs(strain)) << info(cell).name << " " << place.height;
    }
}

TEST(CutLoads, NamesAreSaidToBeWrongAtTheirLine) {
  const std::string text = model(places[0], 2, held("bottom", 2) + "[[load]]\ngroup = \"meadow\"\npressure = 1\n", joint) + at_rest_stages;
  const auto refusal = [&](const std::string& from, const std::string& to) {
    return refusal_of([&] { build(read_on(replaced(text, from, to), ground(Cell::quad4)), RunSpec{}); });
  };
  const std::string taken = refusal("free = \"meadow\"", "free = \"left\""), none = refusal("x = [-0.7, 0.9], ", "");
  EXPECT_NE(taken.find("free: expected a new name, found \"left\""), std::string::npos) << taken;
  EXPECT_NE(none.find("none: the structure covers all of the plane"), std::string::npos) << none;
}

}  // namespace
}  // namespace uplift::cut_loads_test
