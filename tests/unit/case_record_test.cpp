#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "uplift/analysis/case.h"
#include "uplift/io/toml.h"

// Records that drive a case: what they give to each use, against sums over their points; the moving frame against the absolute one; errors.
namespace uplift {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;

/// A folder that is removed at the end of a test.
class RecordCase : public testing::Test {
 protected:
  RecordCase() : folder_(fs::temp_directory_path() / ("uplift_record_" + std::to_string(getpid()))) { fs::create_directories(folder_); }
  ~RecordCase() override { fs::remove_all(folder_); }

  /// Two columns, s and m/s2: begins with a value that is not zero and ends with a velocity.
  std::vector<double> write_record(const std::string& name, double step, int count, double frequency) {
    std::vector<double> values;
    std::ofstream file(folder_ / name);
    file.precision(17);
    for (int i = 0; i < count; ++i) {
      const double t = step * i, window = std::sin(pi * (i + 8.0) / (count + 16.0));
      values.push_back(window * (2 * std::cos(2 * pi * frequency * t) + std::sin(2 * pi * 2.7 * frequency * t + 1)));
      file << t << " " << values.back() << "\n";
    }
    return values;
  }

  std::string name() const { return (folder_ / "case.toml").string(); }
  Case read(const std::string& text) const { return check_case(read_toml_text(text, name()), name()); }
  /// The error without the folder; empty when there is none.
  std::string refusal(const std::string& text) const {
    try {
      const Case file = read(text);
      build(file, runs_of_case(file).front());
    } catch (const InputError& error) {
      std::string said = error.what();
      for (std::size_t at; (at = said.find(folder_.string() + "/")) != said.npos;) said.erase(at, folder_.string().size() + 1);
      return said;
    }
    return {};
  }
  fs::path folder_;
};

/// A tower on a rigid footing, held by two joints to the ground.
std::string tower(const std::string& stage, const std::string& ground) {
  return R"(title = "tower"
[nodes]
top = [0, 6]
base = [0, 0]
left = [-1.5, 0]
right = [1.5, 0]
ground_left = [-1.5, 0]
ground_right = [1.5, 0]
[[beam]]
name = "column"
nodes = ["base", "top"]
E = 2e10
I = 0.05
A = 0.8
mass = "consistent"
density = 2500
damping_beta = 1e-3
[[mass]]
node = "top"
mass = 2e4
[[rigid]]
name = "footing"
node = "base"
slaves = ["left", "right"]
mass = 1e4
inertia = 7500
[[interface]]
name = "soil"
law = { type = "springs", K_n = 4e8, K_t = 2e8, tangential = "bonded" }
[interface.pairs]
upper = ["left", "right"]
lower = ["ground_left", "ground_right"]
area = 1.5
[gravity]
acceleration = [0, -9.81]
[output]
frames = 0
)" + ground +
         "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 3\n" + stage;
}

const std::string two_records = R"([[record]]
name = "ex"
file = "ex.txt"
unit = "m/s2"
[[record]]
name = "ey"
file = "ey.txt"
unit = "m/s2"
)";

const std::string moving_frame = two_records + R"([[support]]
node = "ground_left"
fixed = ["ux", "uy", "rz"]
[[support]]
node = "ground_right"
fixed = ["ux", "uy", "rz"]
[[ground_acceleration]]
direction = [1, 0]
function = "ex"
[[ground_acceleration]]
name = "up"
direction = [0, 1]
function = "ey"
)";

std::string absolute_frame() {
  std::string text = two_records;
  for (const std::string node : {"ground_left", "ground_right"}) {
    text += "[[support]]\nnode = \"" + node + "\"\nfixed = [\"rz\"]\n";
    for (const std::string axis : {"x", "y"})
      text += "[[motion]]\nname = \"" + node + axis + "\"\nnode = \"" + node + "\"\ndirection = \"u" + axis + "\"\nfunction = \"e" + axis +
              "\"\n";
  }
  return text;
}

/// What Newmark's formulas make of an acceleration, at the steps of a run: displacement, velocity, acceleration.
struct Ground {
  Ground(const std::vector<double>& values, double record_step, double step, double duration) {
    const long steps = std::lround(duration / step);
    double u = 0, v = 0, before = 0;
    for (long i = 0; i <= steps; ++i) {
      const double place = static_cast<double>(i) * step / record_step;
      const auto k = std::min(static_cast<std::size_t>(place + 1e-9), values.size() - 2);
      const double a = values[k] + (place - static_cast<double>(k)) * (values[k + 1] - values[k]);
      if (i > 0) {
        u += step * v + step * step / 4 * (before + a);
        v += step / 2 * (before + a);
      }
      before = a;
      motion[0].push_back(u);
      motion[1].push_back(v);
      motion[2].push_back(a);
    }
  }
  std::vector<double> motion[3];
};

using Column = Request::Kind;

bool depends_on_frame(Column kind) {
  return kind == Column::kinetic || kind == Column::external;
}

class MovingFrame : public RecordCase, public testing::WithParamInterface<std::pair<double, bool>> {};

TEST_P(MovingFrame, IsTheAbsoluteFrame) {
  const auto [step, bonded] = GetParam();
  constexpr double record_step = 0.02;
  const Ground grounds[] = {{write_record("ex.txt", record_step, 151, 1.3), record_step, step, 3},
                            {write_record("ey.txt", record_step, 151, 2.1), record_step, step, 3}};
  const std::string stage = "step = " + std::to_string(step) + "\n";
  std::vector<RunResult> results;
  std::vector<Space> spaces;
  for (const std::string& ground : {moving_frame, absolute_frame()}) {
    const Case file = read(tower(stage, ground));
    const Built built = build(file, runs_of_case(file)[bonded ? 1 : 0]);
    spaces.push_back(built.model.space);
    results.push_back(run(built.model, built.plan, built.behaviours));
    ASSERT_EQ(to_string(results.back().status), "completed") << results.back().reason;
  }
  const RunResult &moving = results[0], &absolute = results[1];
  if (!bonded) {
    EXPECT_GT(moving.max_uplifted_ratio.value, 0);
  }
  int compared = 0;
  for (std::size_t k = 0; k < moving.columns.size(); ++k) {
    const Request& column = moving.columns[k];
    if (depends_on_frame(column.kind)) continue;
    const auto other = std::ranges::find(absolute.columns, column.name, &Request::name);
    ASSERT_NE(other, absolute.columns.end()) << column.name;
    const std::vector<double>&one = moving.table[k + 1], &two = absolute.table[other - absolute.columns.begin() + 1];
    ASSERT_EQ(one.size(), two.size());
    const bool of_node = column.kind == Column::displacement || column.kind == Column::velocity || column.kind == Column::acceleration;
    const int axis = of_node ? column.unknown % spaces[0].unknowns() : 2;
    double size = column.kind == Column::residual ? moving.energy_scale : 0, worst = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
      const double carried = axis < 2 ? grounds[axis].motion[static_cast<int>(column.kind)][i] : 0;
      size = std::max({size, std::abs(one[i]), std::abs(carried)});
      worst = std::max(worst, std::abs(two[i] - one[i] - carried));
    }
    EXPECT_LE(worst, 1e-9 * size) << column.name;
    ++compared;
  }
  EXPECT_GT(compared, 12);
}

INSTANTIATE_TEST_SUITE_P(Steps, MovingFrame,
                         testing::Values(std::pair(0.02, true), std::pair(0.005, true), std::pair(0.0025, true), std::pair(0.0025, false)));

}  // namespace
}  // namespace uplift
