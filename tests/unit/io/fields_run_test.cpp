#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "uplift/base/file.h"
#include "uplift/io/fields/run.h"
#include "uplift/io/hdf5/hdf5.h"
#include "uplift/io/text/toml.h"

// Fields of runs, read back from HDF5 and judged by the states that an observer of the test's own has seen.
namespace uplift::fields_run_test {
namespace {

namespace fs = std::filesystem;

/// A raft in a soil box, its bottom and its walls in one interface, pushed sideways by its weight and a pulse.
std::string case_text(const std::string& cell, const std::string& quadrature, const std::string& fields) {
  return R"(
title = "embedded raft"
[mesh.soil_box]
cell = ")" +
         cell + R"("
embedment = 1
[mesh.soil_box.soil]
width = 16
size = 2
layers = [{ thickness = 4, size = 1 }]
[mesh.soil_box.raft]
width = 6
height = 2
size = 1
[[solid]]
group = "soil_1"
E = 5e7
poisson = 0.3
density = 1900
[[solid]]
group = "raft"
E = 2e10
poisson = 0.2
density = 2500
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[support]]
group = "soil_left"
fixed = ["ux"]
[[support]]
group = "soil_right"
fixed = ["ux"]
[[interface]]
name = "joint"
surface = { group = "interface", lower = ["soil_1"], quadrature = ")" +
         quadrature + R"(" }
law = { type = "springs", K_n = 1e9, K_t = 1e9, tangential = "bonded" }
[gravity]
acceleration = [0, -10]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.1 }
[[load]]
name = "pulse"
group = "raft_top"
force = [2e5, 1e5]
function = "pulse"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.05
step = 0.005
[output.fields]
)" + fields;
}

/// A run with its fields, and copies of all states.
class Written {
 public:
  explicit Written(const std::string& text)
      : place_(fs::temp_directory_path() / ("uplift-field-run-" + std::to_string(::getpid()))),
        read(check_case(read_toml_text(text, "case.toml"), "case.toml", {})),
        built(build(read, runs_of_case(read).front())) {
    ResultFolder folder((place_ / "r").string());
    FieldRun fields(read, built, folder);
    result = run(built.model, built.plan, built.behaviours, {}, [&](const Snapshot& snapshot) {
      fields.see(snapshot);
      states.push_back(snapshot.state);
    });
    fields.finish(result);
    frames = fields.frames();
    folder.finish();
  }
  ~Written() { fs::remove_all(place_); }
  Written(const Written&) = delete;
  Written& operator=(const Written&) = delete;
  std::string file(const std::string& name) const { return (place_ / "r" / name).string(); }

 private:
  fs::path place_;

 public:
  Case read;
  BuiltCase built;
  RunResult result;
  std::vector<State> states;
  int frames = 0;
};

class FieldsOfARun : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(FieldsOfARun, InterfaceCarriesWhatItsJointsCarry) {
  const auto [cell, quadrature] = GetParam();
  const Written written(case_text(cell, quadrature, "format = \"xdmf\"\nprecision = \"float64\"\nevery = 2\n"));
  ASSERT_EQ(written.result.status, RunStatus::completed) << written.result.reason;
  EXPECT_EQ(written.frames, 6);
  const Hdf5Reader file = Hdf5Reader::open(written.file("fields/run.h5"));
  ASSERT_EQ(file.children("/frames").size(), 6u);
  const bool quadratic = std::string(cell) == "quad8";
  const std::string type = quadratic ? "line3" : "line2", mesh = "/mesh/interfaces";
  const auto points = file.numbers(mesh + "/points");
  const auto nodes = file.integers(mesh + "/" + type + "/nodes"), side = file.integers(mesh + "/" + type + "/side");
  const std::size_t width = quadratic ? 3 : 2;
  const std::vector<double> share = quadratic ? std::vector{1. / 6, 1. / 6, 4. / 6} : std::vector{.5, .5};  // exact for this degree

  const State& last = written.states.back();
  Vec3 wanted = Vec3::Zero(), found = Vec3::Zero();
  double squeezed = 0, squeezed_found = 0;
  int first = 0;
  for (const Interface& joint : written.built.model.interfaces) {  // of base and walls
    for (int i = 0; i < joint.batch.points; ++i) {
      const double nx = joint.normal[static_cast<std::size_t>(i)][0], ny = joint.normal[static_cast<std::size_t>(i)][1];
      const double t = last.mean_force[first + i], n = last.mean_force[first + joint.batch.points + i];
      wanted += Vec3(t * ny + n * nx, n * ny - t * nx, 0);  // t = (ny, -nx)
      squeezed -= n;
    }
    first += joint.rows();
  }
  const std::string frame = "/frames/000005/interfaces/points/";
  const auto traction = file.numbers(frame + "traction"), pressure = file.numbers(frame + "pressure");
  for (std::size_t c = 0; c < side.size(); ++c) {
    if (side[c] == 1) continue;
    const auto at = [&](std::size_t a) { return static_cast<std::size_t>(nodes[c * width + a]); };
    const double length = std::hypot(points[3 * at(1)] - points[3 * at(0)], points[3 * at(1) + 1] - points[3 * at(0) + 1]);
    for (std::size_t a = 0; a < width; ++a) {
      for (std::size_t k = 0; k < 3; ++k) found[static_cast<Index>(k)] += share[a] * length * traction[3 * at(a) + k];
      squeezed_found += share[a] * length * pressure[at(a)];
    }
  }
  EXPECT_GT(squeezed, 1e5);
  EXPECT_LT((found - wanted).norm(), 1e-9 * squeezed);
  EXPECT_NEAR(squeezed_found, squeezed, 1e-9 * squeezed);
}

INSTANTIATE_TEST_SUITE_P(CellsAndQuadratures, FieldsOfARun,
                         testing::Combine(testing::Values("quad4", "quad8"), testing::Values("nodal", "gauss")));

class FieldsOfNodalJoints : public testing::TestWithParam<const char*> {};

TEST_P(FieldsOfNodalJoints, LipsPartByTheOpening) {
  const std::string cell = GetParam(), quadrature = "nodal";
  const Written written(case_text(cell, quadrature, "format = \"xdmf\"\nprecision = \"float64\"\nevery = 10\n"));
  const Hdf5Reader file = Hdf5Reader::open(written.file("fields/run.h5"));
  const bool quadratic = cell == "quad8";
  const std::string type = quadratic ? "line3" : "line2", mesh = "/mesh/interfaces", frame = "/frames/000001/interfaces/points/";
  const auto points = file.numbers(mesh + "/points");
  const auto nodes = file.integers(mesh + "/" + type + "/nodes");
  const std::size_t width = quadratic ? 3 : 2;
  const auto opening = file.numbers(frame + "opening"), slip = file.numbers(frame + "slip"), u = file.numbers(frame + "displacement");
  double moved = 0;
  for (std::size_t c = 0; c < nodes.size() / width; c += 2)  // lower and upper side, one after the other
    for (std::size_t a = 0; a < width; ++a) {
      const auto lower = static_cast<std::size_t>(nodes[c * width + a]), upper = static_cast<std::size_t>(nodes[(c + 1) * width + a]);
      const auto first = static_cast<std::size_t>(nodes[c * width]), second = static_cast<std::size_t>(nodes[c * width + 1]);
      const double dx = points[3 * second] - points[3 * first], dy = points[3 * second + 1] - points[3 * first + 1];
      const double length = std::hypot(dx, dy), normal_x = dy / length, normal_y = -dx / length;
      for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(points[3 * lower + k], points[3 * upper + k]);
      const double x = u[3 * upper] - u[3 * lower], y = u[3 * upper + 1] - u[3 * lower + 1];
      moved = std::max(moved, std::hypot(x, y));
      EXPECT_NEAR(opening[lower], x * normal_x + y * normal_y, 1e-15);
      EXPECT_EQ(opening[lower], opening[upper]);
      EXPECT_NEAR(slip[3 * lower], x - (x * normal_x + y * normal_y) * normal_x, 1e-15);
      EXPECT_NEAR(slip[3 * lower + 1], y - (x * normal_x + y * normal_y) * normal_y, 1e-15);
    }
  EXPECT_GT(moved, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Cells, FieldsOfNodalJoints, testing::Values("quad4", "quad8"));

TEST(FieldRun, NodesMoveAsInTheStates) {
  const Written written(case_text("quad4", "nodal", "format = \"xdmf\"\nevery = 5\ngroups = [\"raft\"]\n"));
  const Hdf5Reader file = Hdf5Reader::open(written.file("fields/run.h5"));
  EXPECT_EQ(file.children("/mesh"), (std::vector<std::string>{"interfaces", "raft"}));
  const auto points = file.numbers("/mesh/raft/points"), u = file.numbers("/frames/000001/raft/points/displacement");
  const auto v = file.numbers("/frames/000001/raft/points/velocity");
  const State& state = written.states.at(6);  // the end of the static stage, the beginning, five steps
  EXPECT_NEAR(state.time, 0.025, 1e-12);
  const Model& model = written.built.model;
  const auto last_node = static_cast<int>(model.nodes.size()) - 1;  // the upper side's, a corner of the raft
  const auto& corner = model.nodes.back().position;
  int met = 0;
  for (std::size_t i = 0; i < points.size() / 3; ++i) {
    if (points[3 * i] != corner[0] || points[3 * i + 1] != corner[1]) continue;
    ++met;
    const int stride = model.full_unknowns() / static_cast<int>(model.nodes.size());
    for (int k = 0; k < 2; ++k) {
      const auto c = 3 * i + static_cast<std::size_t>(k);
      EXPECT_EQ(u[c], static_cast<float>(model.full(stride * last_node + k, state.displacement, 0, state.time)));
      EXPECT_EQ(v[c], static_cast<float>(model.full(stride * last_node + k, state.velocity, 1, state.time)));
    }
  }
  EXPECT_EQ(met, 1);
}

TEST(FieldRun, BeamsOfAGroupAreABlockAndMoveWithTheSolidsBelow) {
  const std::string beam = "[[beam]]\nname = \"lid\"\ngroup = \"raft_top\"\nE = 3e10\nI = 0.02\nA = 0.3\n";
  const std::string options = "format = \"xdmf\"\nprecision = \"float64\"\nevery = 5\n";
  {
    const Written written(case_text("quad4", "nodal", options) + beam);
    ASSERT_EQ(written.result.status, RunStatus::completed) << written.result.reason;
    const Hdf5Reader file = Hdf5Reader::open(written.file("fields/run.h5"));
    EXPECT_EQ(file.integers("/mesh/raft_top/line2/nodes").size(), 2u * 6);
    const std::string frame = "/frames/000002/";
    EXPECT_EQ(file.children(frame + "raft_top/points").size(), 3u);  // no stress
    const auto places = file.numbers("/mesh/raft_top/points"), solid = file.numbers("/mesh/raft/points");
    int met = 0;
    for (const char* quantity : {"displacement", "velocity", "acceleration"}) {
      const auto on_beam = file.numbers(frame + "raft_top/points/" + quantity), on_raft = file.numbers(frame + "raft/points/" + quantity);
      for (std::size_t i = 0; i < places.size(); i += 3)
        for (std::size_t j = 0; j < solid.size(); j += 3) {
          if (places[i] != solid[j] || places[i + 1] != solid[j + 1]) continue;
          ++met;
          for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(on_beam[i + k], on_raft[j + k]);
          EXPECT_NE(on_beam[i + 1], 0);
        }
    }
    EXPECT_EQ(met, 3 * 7);
  }
  const Written chosen(case_text("quad4", "nodal", options + "groups = [\"raft_top\"]\n") + beam);
  EXPECT_EQ(Hdf5Reader::open(chosen.file("fields/run.h5")).children("/mesh"), (std::vector<std::string>{"interfaces", "raft_top"}));
}

// ---- in space ----

constexpr const char* sides_in_space = R"(
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy", "uz"]
[[support]]
group = "soil_left"
fixed = ["ux"]
[[support]]
group = "soil_right"
fixed = ["ux"]
[[support]]
group = "soil_front"
fixed = ["uy"]
[[support]]
group = "soil_back"
fixed = ["uy"]
)";

/// Soil and a body of that name on it, in space, with a bonded joint between them, at rest.
std::string text_in_space(const std::string& box, const std::string& body, const std::string& density, const std::string& quadrature,
                          const std::string& gravity) {
  return "title = \"in space\"\nbonded = false\n" + box + R"(
[[solid]]
group = "soil_1"
E = 5e7
poisson = 0.3
density = 1900
[[solid]]
group = ")" +
         body + R"("
E = 2e9
poisson = 0.3
density = )" +
         density + R"(
[[interface]]
name = "joint"
surface = { group = "interface", lower = ["soil_1"], quadrature = ")" +
         quadrature + R"(" }
law = { type = "elastic", K_n = 1e9, K_t = 7e8, tangential = "bonded" }
[gravity]
acceleration = )" +
         gravity + R"(
[[stage]]
type = "static"
[output.fields]
format = "xdmf"
precision = "float64"
)" + sides_in_space;
}

class RaftInSpace : public testing::TestWithParam<const char*> {};

/// A raft of 6 x 4 x 2 m, half of it in the soil, under a slanted gravity: whatever the soil does, the joint carries its mass times
/// gravity.
TEST_P(RaftInSpace, JointCarriesTheWeight) {
  const std::string box = R"(
[mesh.soil_box]
embedment = 1
[mesh.soil_box.soil]
width = 12
length = 10
size = 3
layers = [{ thickness = 3, size = 1 }]
[mesh.soil_box.raft]
width = 6
length = 4
height = 2
size = 2
)";
  const Written written(text_in_space(box, "raft", "2500", GetParam(), "[3, 1, -10]"));
  ASSERT_EQ(written.result.status, RunStatus::completed) << written.result.reason;
  ASSERT_EQ(written.frames, 1);
  const Hdf5Reader file = Hdf5Reader::open(written.file("fields/run.h5"));
  const std::string mesh = "/mesh/interfaces", frame = "/frames/000000/";
  const auto points = file.numbers(mesh + "/points"), traction = file.numbers(frame + "interfaces/points/traction");
  const auto nodes = file.integers(mesh + "/quad4/nodes"), side = file.integers(mesh + "/quad4/side");
  Vec3 total = Vec3::Zero();
  for (std::size_t c = 0; c < side.size(); ++c) {
    if (side[c] == 1) continue;
    const auto first = [&](std::size_t a) { return 3 * static_cast<std::size_t>(nodes[4 * c + a]); };
    const auto corner = [&](std::size_t a) { return Vec3(points[first(a)], points[first(a) + 1], points[first(a) + 2]); };
    const double area = (corner(1) - corner(0)).norm() * (corner(3) - corner(0)).norm();  // rectangles
    for (std::size_t a = 0; a < 4; ++a) total += area / 4 * Vec3(traction[first(a)], traction[first(a) + 1], traction[first(a) + 2]);
  }
  const double mass = 2500. * 6 * 4 * 2;
  EXPECT_LT((total - mass * Vec3(3, 1, -10)).norm(), 1e-7 * 10 * mass);

  const auto places = file.numbers("/mesh/raft/points"), u = file.numbers(frame + "raft/points/displacement");
  const Model& model = written.built.model;
  const Vector full = model.full(written.states.back().displacement, 0, 0);
  int met = 0;
  for (std::size_t i = 0; i < places.size() / 3; ++i)
    for (const int node : written.built.facts[0].upper) {
      const Vec3& at = model.nodes[static_cast<std::size_t>(node)].position;
      if (at != Vec3(places[3 * i], places[3 * i + 1], places[3 * i + 2])) continue;
      ++met;
      for (int k = 0; k < 3; ++k) EXPECT_EQ(u[3 * i + static_cast<std::size_t>(k)], full[model.space.unknowns() * node + k]);
    }
  EXPECT_GE(met, 4);
}

INSTANTIATE_TEST_SUITE_P(Quadratures, RaftInSpace, testing::Values("nodal", "gauss"));

TEST(FieldRun, StressOfAConfinedColumnInSpaceIsItsWeight) {
  const std::string box = R"(
[mesh.soil_box]
cell = "hex20"
[mesh.soil_box.soil]
width = 2
length = 2
size = 1
layers = [{ thickness = 2, size = 1 }]
[mesh.soil_box.block]
width = 2
height = 2
size = 1
[[support]]
group = "block_left"
fixed = ["ux"]
[[support]]
group = "block_right"
fixed = ["ux"]
[[support]]
group = "block_front"
fixed = ["uy"]
[[support]]
group = "block_back"
fixed = ["uy"]
)";
  const Written written(text_in_space(box, "block", "700", "nodal", "[0, 0, -10]"));
  ASSERT_EQ(written.result.status, RunStatus::completed) << written.result.reason;
  const Hdf5Reader file = Hdf5Reader::open(written.file("fields/run.h5"));
  const double block_weight = 700 * 10 * 2;  // Pa
  for (const std::string name : {"soil_1", "block"}) {
    const auto places = file.numbers("/mesh/" + name + "/points"), stress = file.numbers("/frames/000000/" + name + "/points/stress");
    ASSERT_EQ(stress.size(), 2 * places.size());
    for (std::size_t i = 0; i < places.size() / 3; ++i) {
      const double z = places[3 * i + 2], down = name == "block" ? -7000 * (2 - z) : -block_weight + 19000 * z, across = 3. / 7 * down;
      const double wanted[6] = {across, across, down, 0, 0, 0};
      for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(stress[6 * i + c], wanted[c], 1e-6 * block_weight) << name << " at z = " << z;
    }
  }
  for (const double pressure : file.numbers("/frames/000000/interfaces/points/pressure"))
    EXPECT_NEAR(pressure, block_weight, 1e-6 * block_weight);
}

TEST(FieldRun, ANumberThatIsNotFiniteIsNotedAndNotWritten) {
  const fs::path place = fs::temp_directory_path() / ("uplift-field-nan-" + std::to_string(::getpid()));
  const Case read = check_case(read_toml_text(case_text("quad4", "nodal", "format = \"vtu\"\n"), "case.toml"), "case.toml", {});
  const BuiltCase built = build(read, runs_of_case(read).front());
  {
    ResultFolder folder((place / "r").string());
    FieldRun fields(read, built, folder);
    RunResult result = run(built.model, built.plan, built.behaviours, {}, [&](const Snapshot& snapshot) {
      State damaged = snapshot.state;
      if (snapshot.step == 3 || snapshot.step == 4) damaged.displacement[7] = std::nan("");
      fields.see({damaged, snapshot.stepper, snapshot.so_far, snapshot.stage, snapshot.step, snapshot.last, snapshot.forces});
    });
    fields.finish(result);
    EXPECT_EQ(fields.frames(), 11 - 2);
    ASSERT_EQ(result.notes.size(), 1u);
    EXPECT_TRUE(result.notes[0].starts_with("2 frames of the fields were left out: field \"displacement [m]\" of block \""))
        << result.notes[0];
    EXPECT_TRUE(result.notes[0].ends_with("at t = 0.015 s")) << result.notes[0];
    folder.finish();
  }
  const std::string list = read_file((place / "r/fields/run.pvd").string());
  EXPECT_EQ(list.find("timestep=\"0.015"), std::string::npos);
  for (const auto& entry : fs::recursive_directory_iterator(place / "r/fields"))
    if (entry.path().extension() == ".vtu") {
      EXPECT_NE(list.find(entry.path().filename().string()), std::string::npos) << entry.path();
    }
  fs::remove_all(place);
}

}  // namespace
}  // namespace uplift::fields_run_test
