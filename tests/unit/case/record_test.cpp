#include "unit/case/record_support.h"
#include "unit/motion/files.h"
#include "uplift/motion/generate.h"
#include "uplift/motion/spectrum.h"

// Records that time_load a case: what they give to each use, against sums over their points; the moving frame against the absolute one;
// errors.
namespace uplift::record_test {
namespace {

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

/// The work of the ground and the kinetic energy are those of the unknowns, which move with the ground or do not.
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
    const BuiltCase built = build(file, runs_of_case(file)[bonded ? 1 : 0]);
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

/// a = 1, 3, -1 m/s2 every 0.5 s; integrals by hand.
TEST(MotionHistories, IntegrateExactlyAndGoOnAfterTheEnd) {
  Motion motion;
  motion.step = 0.5;
  motion.values = {1, 3, -1};
  const auto history = std::make_shared<const MotionHistory>(std::make_shared<const Motion>(motion));
  struct Expected {
    double time, acceleration, velocity, displacement;
  };
  for (const Expected& each : {Expected{-0.1, 0, 0, 0},
                               {0, 1, 0, 0},
                               {0.25, 2, 0.375, 1.0 / 24},
                               {0.5, 3, 1, 5.0 / 24},
                               {1, -1, 1.5, 11.0 / 12},
                               {2, 0, 1.5, 11.0 / 12 + 1.5}}) {
    EXPECT_NEAR(history->at(MotionKind::acceleration, each.time), each.acceleration, 1e-15) << each.time;
    EXPECT_NEAR(history->at(MotionKind::velocity, each.time), each.velocity, 1e-15) << each.time;
    EXPECT_NEAR(history->at(MotionKind::displacement, each.time), each.displacement, 1e-15) << each.time;
    const MotionFunction moved(history, MotionKind::displacement, 0.01), pushed(history, MotionKind::acceleration, 0.01);
    EXPECT_NEAR(moved.value(each.time), each.displacement + (each.time < 0 ? -0.01 : 0.01 * (each.acceleration - 1)), 1e-15);
    EXPECT_NEAR(moved.rate(each.time), each.velocity, 1e-15);
    EXPECT_NEAR(moved.acceleration(each.time), each.acceleration, 1e-15);
    EXPECT_EQ(pushed.value(each.time), history->at(MotionKind::acceleration, each.time));
    EXPECT_EQ(pushed.acceleration(each.time), 0);
  }
  EXPECT_NEAR(MotionFunction(history, MotionKind::acceleration).rate(0.7), -8, 1e-14);
}

/// Of a velocity the displacement follows by integration, and it goes on with its last value.
TEST(MotionHistories, KeepAVelocityAsItIs) {
  Motion motion;
  motion.kind = MotionKind::velocity;
  motion.step = 0.1;
  motion.values = {0.5, 1, 0.25};
  const auto history = std::make_shared<const MotionHistory>(std::make_shared<const Motion>(motion));
  EXPECT_NEAR(history->at(MotionKind::velocity, 0.05), 0.75, 1e-15);
  EXPECT_NEAR(history->at(MotionKind::displacement, 0.2), 0.075 + 0.0625, 1e-15);
  EXPECT_NEAR(history->at(MotionKind::displacement, 0.4), 0.1375 + 0.05, 1e-15);
  EXPECT_FALSE(history->gives(MotionKind::acceleration));
  EXPECT_NEAR(MotionFunction(history, MotionKind::displacement, 1.0).value(0.2), 0.1375, 1e-15);
}

TEST_F(RecordCase, NamesWhatIsWrong) {
  write_record("ex.txt", 0.02, 51, 1);
  write_record("ey.txt", 0.02, 51, 1);
  const std::string good = tower(quick, moving_frame);
  EXPECT_EQ(refusal(good), "accepted");
  const auto says = [&](const std::string& text, const std::string& marker, const std::string& rest) {
    EXPECT_EQ(refusal(text), "case.toml:" + std::to_string(line_of(text, marker)) + ": " + rest);
  };
  const std::string unknown = replaced(good, "function = \"ey\"", "function = \"eyy\"");
  says(unknown, "function = \"eyy\"",
       "ground_acceleration[1].function: expected the name of a function or record, found \"eyy\" (did you mean \"ey\"?)");
  const std::string missing = replaced(good, "file = \"ey.txt\"", "file = \"north.at2\"");
  says(missing, "file = \"north.at2\"", "record[1].file: expected a file, found no file \"north.at2\"");
  const std::string misspelt = replaced(good, "file = \"ey.txt\"", "file = \"eyy.txt\"");
  says(misspelt, "file = \"eyy.txt\"", "record[1].file: expected a file, found no file \"eyy.txt\" (did you mean \"ey.txt\"?)");
  const std::string turned = tower(quick, replaced(absolute_frame(), "direction = \"ux\"", "direction = \"rz\""));
  says(replaced(turned, "fixed = [\"rz\"]", "fixed = [\"ux\"]"), "function = \"ex\"",
       "motion[0].function: expected a function (a record is a motion: no load, no rotation), found the record \"ex\"");
  const std::string loaded = good + "[[load]]\nnode = \"top\"\nforce = [1, 0]\nfunction = \"ex\" # load\n";
  says(loaded, "function = \"ex\" # load",
       "load[0].function: expected a function (a record is a motion: no load, no rotation), found the record \"ex\"");
  const std::string twice = good + "[[function]]\nname = \"ey\"\nshape = \"constant\"\n";
  says(twice, "name = \"ey\"",
       "record[1].name: expected a name that no other function or record has, found \"ey\", which line " +
           std::to_string(line_of(twice, "[[function]]") + 1) + " uses already");
}

/// Three components of one file, two of them called the same: a name or a number says which one.
TEST_F(RecordCase, TakesOneComponentOfAFile) {
  const sample::Written first = sample::csmip_v2(sample::tone(60, 30), 0.02, 0), third = sample::csmip_v2(sample::tone(60, 10), 0.02, 0);
  const sample::Written up = sample::csmip_v2(sample::tone(60, -20), 0.02, 0);
  std::ofstream(folder_ / "three.v2") << first.text << replaced(up.text, "Chan  1:  360 Deg", "Chan  2:  Up") << third.text;
  const auto with = [](const std::string& x, const std::string& y) {
    const auto record = [](const std::string& name, const std::string& key) {
      return "[[record]]\nname = \"" + name + "\"\nfile = \"three.v2\"\n" + key + "\n";
    };
    return tower(quick, replaced(moving_frame, two_records, record("ex", x) + record("ey", y)));
  };
  const Case file = read(with("component = \"3\"", "component = \"Up\""));
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_DOUBLE_EQ(file.records[0].motion().values[i], 0.01 * third.numbers[i]);
    EXPECT_DOUBLE_EQ(file.records[1].motion().values[i], 0.01 * up.numbers[i]);
  }
  EXPECT_EQ(file.records[0].motion().component, "360 Deg");
  const auto says = [&](const std::string& x, const std::string& rest) {
    const std::string said = refusal(with(x, "component = \"Up\""));
    EXPECT_NE(said.find(rest), std::string::npos) << said;
  };
  const std::string all = R"("1" ("360 Deg"), "2" ("Up") or "3" ("360 Deg"))";
  says("", "record[0]: expected component, one of " + all + " in this file, found none");
  says("component = \"360 Deg\"",
       "record[0].component: expected a number: one of " + all + ", found \"360 Deg\", which several are called");
  says("component = \"4\"", "record[0].component: expected one of " + all + ", found \"4\"");
}

TEST_F(RecordCase, WarnsOfStepsThatDoNotFit) {
  write_record("ex.txt", 0.02, 301, 1);
  const std::string ground = replaced(moving_frame, "function = \"ey\"", "function = \"ex\"");
  write_record("ey.txt", 0.02, 301, 1);
  const auto said = [&](const std::string& step, const std::string& words) {
    const Case file = read(tower("step = " + step + "\n", ground));
    const RunSpec spec = runs_of_case(file).front();
    const std::vector<std::string> all = warnings(file, spec, build(file, spec));
    return std::ranges::count_if(all, [&](const std::string& each) { return each.find(words) != each.npos; });
  };
  EXPECT_EQ(said("0.005", "of the record \"ex\""), 0);
  EXPECT_EQ(said("0.04", "is coarser than that of the record \"ex\" (20.0 ms)"), 1);
  EXPECT_EQ(said("0.008", "is no whole fraction of that of the record \"ex\" (20.0 ms)"), 1);
  EXPECT_EQ(said("0.005", "the record \"ex\" lasts 6.00 s, the dynamic stages 3.00 s"), 1);
  EXPECT_EQ(said("0.005", "stops with a jerk"), 0);
  const double last = write_record("ex.txt", 0.02, 101, 1).back();
  EXPECT_EQ(said("0.005", fmt::format("the record \"ex\" ends at 2.00 s with {:.3f} m/s², and the run goes on to 3.00 s", last)), 1);
}

/// A prescribed displacement drifts away with the velocity that is left.
TEST_F(RecordCase, WarnsOfADrift) {
  std::ofstream(folder_ / "ex.txt") << "0 0\n0.02 1\n0.04 1\n0.06 0\n";
  std::ofstream(folder_ / "ey.txt") << "0 0\n0.02 1\n0.04 -1\n0.06 0\n";
  const Case file = read(tower(quick, absolute_frame()));
  const RunSpec spec = runs_of_case(file).front();
  const std::vector<std::string> all = warnings(file, spec, build(file, spec));
  const auto drifts = [&](const std::string& name) {
    const std::string words = "the record \"" + name + "\" ends with a velocity of 40.0 mm/s";
    return std::ranges::count_if(all, [&](const std::string& each) { return each.find(words) != each.npos; });
  };
  EXPECT_EQ(drifts("ex"), 1);
  EXPECT_EQ(drifts("ey"), 0);
}

const std::string box = R"(title = "soil"
bonded = false
[mesh.soil_box]
cell = "quad4"
[mesh.soil_box.soil]
width = 4
size = 1
layers = [{ thickness = 4, size = 1 }]
[mesh.soil_box.block]
width = 2
height = 1
size = 1
[[solid]]
group = "soil_1"
shear_wave_speed = 200
poisson = 0.3
density = 1900
[[solid]]
group = "block"
E = 2e9
poisson = 0.2
density = 2000
[[absorbing]]
group = "soil_bottom"
incident = { wave = "SV", kind = "outcrop", velocity = 3, function = "ex" }
[[stage]]
type = "dynamic"
duration = 1
step = 0.01
[[record]]
name = "ex"
file = "ex.txt"
unit = "m/s2"
)";

/// An outcrop moves twice as much as the wave that comes in: half of three times the velocity of the record.
TEST_F(RecordCase, GivesAnIncidentWaveItsVelocity) {
  const std::vector<double> values = write_record("ex.txt", 0.02, 51, 1);
  const Case file = read(box);
  const BuiltCase built = build(file, runs_of_case(file).front());
  const auto time_load = std::ranges::find(built.model.time_loads, "incident wave", &TimeLoad::name);
  ASSERT_NE(time_load, built.model.time_loads.end());
  double velocity = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) velocity += 0.01 * (values[i - 1] + values[i]);
    EXPECT_NEAR(time_load->function->value(0.02 * static_cast<double>(i)), 1.5 * velocity, 1e-13);
  }
  ASSERT_EQ(built.motions.size(), 1u);
  EXPECT_EQ(built.motions[0].kind, MotionKind::velocity);
  EXPECT_EQ(built.motions[0].history->motion()->name, "ex");
}

std::string generated(const std::string& name, const std::string& options) {
  return "[[record]]\nname = \"" + name + "\"\ngenerate = { target = { type = \"rg_1_60\", pga = 2 }, " + options + " }\n";
}

const std::string short_motion = "duration = 4, step = 0.02, from = 1.5, to = 10";

/// Records with one seed are drawn together; every reading gives the same.
TEST_F(RecordCase, GeneratesIndependentComponents) {
  const std::string text = tower(
      quick,
      replaced(moving_frame, two_records, generated("ex", short_motion + ", seed = 10") + generated("ey", short_motion + ", seed = 10")));
  const Case file = read(text), again = read(text);
  const Motion &ex = file.records[0].motion(), &ey = file.records[1].motion();
  ASSERT_EQ(ex.values.size(), 201u);
  EXPECT_EQ(ex.step, 0.02);
  EXPECT_EQ(ex.values, again.records[0].motion().values);
  EXPECT_LE(std::abs(correlation(ex.values, ey.values)), 0.16);
  // 2.61 times the peak acceleration at 9 Hz, 3.13 times at 2.5 Hz (Regulatory Guide 1.60, table I, 5 %)
  const Spectrum reached = response_spectra(ex.values, ex.step, {2.5, 9}, {0.05}, Spectrum::Kind::psa).front();
  EXPECT_GE(reached.values[0], 0.9 * 3.13 * 2);
  EXPECT_GE(reached.values[1], 0.9 * 2.61 * 2);
  EXPECT_LE(reached.values[1], 1.25 * 2.61 * 2);
  EXPECT_EQ(ex.name, "ex");
  EXPECT_TRUE(input_files(file).empty());
}

TEST_F(RecordCase, RefusesRecordsFromNowhereAndFromTwoPlaces) {
  write_record("ex.txt", 0.02, 51, 1);
  const auto says = [&](const std::string& text, const std::string& marker, const std::string& rest) {
    EXPECT_EQ(refusal(text), "case.toml:" + std::to_string(line_of(text, marker)) + ": " + rest);
  };
  const auto with = [](const std::string& records) { return tower(quick, replaced(moving_frame, two_records, records)); };
  says(with("[[record]] # none\nname = \"ex\"\n"), "[[record]] # none", "record[0]: expected either file or generate, found neither");
  says(with(generated("ex", short_motion) + "file = \"ex.txt\"\n"), "generate = {",
       "record[0].generate: expected either file or generate, found both");
  says(with(generated("ex", short_motion) + "unit = \"g\"\n"), "unit = \"g\"",
       "record[0].unit: expected a key of generate, found unit, which is for files");
  says(with(generated("ex", short_motion + ", seed = 4") + generated("ey", "duration = 5, step = 0.02, from = 1.5, to = 10, seed = 4")),
       "duration = 5",
       "record[1].generate.seed: expected a seed of its own (the record \"ex\" has this one with other times or another band), found 4");
  const std::string unit = "[[record]]\nname = \"ex\"\nfile = \"ex.txt\"\nunit = \"furlong\"\n";
  EXPECT_EQ(refusal(with(unit)).find("case.toml:" + std::to_string(line_of(with(unit), "furlong")) + ": record[0].unit: expected "), 0u);
}

}  // namespace
}  // namespace uplift::record_test
