#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "text_support.h"
#include "tower_case.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

// A tower whose ground is moved by records, and the files of these.
namespace uplift {

using support::replaced;
namespace fs = std::filesystem;

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
      const double t = step * i, window = std::sin(std::numbers::pi * (i + 8.0) / (count + 16.0));
      values.push_back(window *
                       (2 * std::cos(2 * std::numbers::pi * frequency * t) + std::sin(2 * std::numbers::pi * 2.7 * frequency * t + 1)));
      file << t << " " << values.back() << "\n";
    }
    return values;
  }

  std::string name() const { return (folder_ / "case.toml").string(); }
  Case read(const std::string& text) const { return check_case(read_toml_text(text, name()), name()); }
  /// The error without the folder, or "accepted".
  std::string refusal(const std::string& text) const {
    std::string said = support::refusal_of([&] {
      const Case file = read(text);
      build(file, runs_of_case(file).front());
    });
    for (std::size_t at; (at = said.find(folder_.string() + "/")) != said.npos;) said.erase(at, folder_.string().size() + 1);
    return said;
  }
  fs::path folder_;
};

/// A tower on a rigid footing, held by two joints to the ground.
inline std::string tower(const std::string& stage, const std::string& ground) {
  const support::Tower column{.height = "6",
                              .inertia = "0.05",
                              .mass = "mass = 2e4",
                              .footing = "slaves = [\"left\", \"right\"]\nmass = 1e4\ninertia = 7500",
                              .nodes = "left = [-1.5, 0]\nright = [1.5, 0]\nground_left = [-1.5, 0]\nground_right = [1.5, 0]",
                              .beam = "A = 0.8\nmass = \"consistent\"\ndensity = 2500\ndamping_beta = 1e-3",
                              .held = false};
  return "title = \"tower\"" + column.text() + R"([[interface]]
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

inline const std::string two_records = R"([[record]]
name = "ex"
file = "ex.txt"
unit = "m/s2"
[[record]]
name = "ey"
file = "ey.txt"
unit = "m/s2"
)";

inline const std::string moving_frame = two_records + R"([[support]]
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

inline const std::string quick = "step = 0.02\n";

/// Line of the first place of a text.
inline int line_of(const std::string& text, const std::string& what) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(what)), '\n'));
}

}  // namespace uplift
