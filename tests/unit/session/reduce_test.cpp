// Runs with a reduced model: equal to those of the whole model with a full basis, never energy from nothing with any other, refused where
// the structure has changed.
#include "uplift/session/reduce.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <utility>

#include "unit/session/reduced_support.h"
#include "uplift/dynamics/bulk.h"
#include "uplift/math/dense.h"
#include "uplift/model/wave_functions.h"
#include "uplift/reduction/projection.h"
#include "uplift/session/steps.h"

namespace uplift::reduce_test {
namespace {

/// A tower of `beams` beams with masses, 4 m wide at its base on springs with friction that may lift off, pushed by an earthquake of one
/// sine with growing amplitude.
std::string tower(int beams,
                  const std::string& damping = "rayleigh = [{ frequency = 1, ratio = 0.02 }, { frequency = 10, ratio = 0.02 }]") {
  std::string text = "title = \"tower\"\nbonded = false\n[nodes]\nn0 = [0, 0]\n", parts;
  for (int k = 1; k <= beams; ++k) {
    text += fmt::format("n{} = [0, {}]\n", k, 2.5 * k);
    parts += fmt::format(
        "[[beam]]\nname = \"b{0}\"\nnodes = [\"n{1}\", \"n{0}\"]\nE = 2e10\nI = 0.2\nA = 1\n[[mass]]\nnode = \"n{0}\"\nmass = {2}\ninertia "
        "= 500\n",
        k, k - 1, 4000 + 500 * k);
  }
  return text + parts +
         "[[rigid]]\nname = \"footing\"\nnode = \"n0\"\nmass = 1e4\ninertia = 2e4\n"
         "[[interface]]\nname = \"soil\"\nfooting = { body = \"n0\", width = 4, thickness = 2, points = 8, rule = \"midpoint\" }\n"
         "law = { type = \"springs\", K_n = 1e8, K_t = 5e7, tangential = \"coulomb\", friction = 0.6 }\n"
         "[gravity]\nacceleration = [0, -9.81]\n[[function]]\nname = \"shake\"\nshape = { type = \"ricker\", frequency = 1.5 }\n"
         "[[ground_acceleration]]\ndirection = [1, 0]\nfunction = \"shake\"\namplitude = 6\n[damping]\n" +
         damping + "\n[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 2\nstep = 2e-3\n[output]\nenergies = true\n";
}

LoadedCase loaded(const std::string& text) {
  return load_case_text(text, "case.toml", "test", MeshFiles::in_process);
}

BuiltCase built_of(const LoadedCase& read) {
  return build_run(read, runs_of_case(read.read).front());
}

constexpr double w = 60;  // rad/s

ReducedModel random_basis(const Model& model, Index size, unsigned seed) {
  return support::random_basis(model, w, size, seed);
}

RunResult run_reduced(const LoadedCase& read, const ReducedModel& reduced) {
  return support::run_reduced(built_of(read), reduced);
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

/// Columns within a share of their peaks, energies within that of the largest one.
void expect_same(const RunResult& reduced, const RunResult& full, double share) {
  ASSERT_EQ(reduced.table.size(), full.table.size());
  double energy = 0;
  for (std::size_t k = 1; k < full.table.size(); ++k)
    if (full.columns[k - 1].unit == "J") energy = std::max(energy, largest(full.table[k]));
  for (std::size_t k = 0; k < full.table.size(); ++k) {
    ASSERT_EQ(reduced.table[k].size(), full.table[k].size());
    const bool is_energy = k > 0 && full.columns[k - 1].unit == "J";
    const double size = is_energy ? energy : largest(full.table[k]);
    for (std::size_t i = 0; i < full.table[k].size(); ++i)
      ASSERT_NEAR(reduced.table[k][i], full.table[k][i], share * size + 1e-14)
          << (k == 0 ? "time" : full.columns[k - 1].name) << " row " << i;
  }
}

TEST(ReducedRun, WithAFullBasisIsTheRunOfTheWholeModel) {
  const LoadedCase read = loaded(tower(4));
  const BuiltCase built = built_of(read);
  const RunResult full = run(built.model, built.plan, built.behaviours);
  ASSERT_EQ(full.status, RunStatus::completed) << full.reason;
  ASSERT_GT(full.max_uplifted_ratio.value, 0.3);
  const RunResult reduced = run_reduced(read, random_basis(built.model, built.model.free(), 1));
  ASSERT_EQ(reduced.status, RunStatus::completed) << reduced.reason;
  expect_same(reduced, full, 1e-10);
}

TEST(ReducedRun, KeepsTheStaticStateInAnyBasis) {
  const LoadedCase read = loaded(tower(3));
  const BuiltCase built = built_of(read);
  const RunResult full = run(built.model, built.plan, built.behaviours), reduced = run_reduced(read, random_basis(built.model, 2, 3));
  for (std::size_t k = 1; k < full.table.size(); ++k)
    EXPECT_NEAR(reduced.table[k].front(), full.table[k].front(), 1e-9 * std::max(1e-6, largest(full.table[k]))) << full.columns[k - 1].name;
  ASSERT_EQ(reduced.load_steps.size(), full.load_steps.size());
  EXPECT_EQ(reduced.load_steps, full.load_steps);
}

TEST(ReducedRun, NeverCreatesEnergyWhateverTheBasis) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const LoadedCase read = loaded(tower(2 + static_cast<int>(seed % 3)));
    const BuiltCase built = built_of(read);
    const Index size = 1 + static_cast<Index>(seed) % (built.model.free() - 1);
    const RunResult reduced = run_reduced(read, random_basis(built.model, size, seed));
    ASSERT_EQ(reduced.status, RunStatus::completed) << "seed " << seed << ": " << reduced.reason;
    // of the external work, which is small where a basis hardly moves; the balance is a difference of stored energies, which are not
    double stored = 0;
    for (std::size_t k = 1; k < reduced.table.size(); ++k)
      if (reduced.columns[k - 1].unit == "J") stored = std::max(stored, largest(reduced.table[k]));
    // each step rounds them by some 1e-15, up or down, by more or less with other kernels of BLAS
    const double walk = 1e-15 * std::max(10.0, 3 * std::sqrt(static_cast<double>(reduced.counts.steps))) * stored;
    const double round_off = 1e-10 * reduced.energy_scale + walk;
    EXPECT_LE(reduced.energy_created, round_off) << "seed " << seed;
    EXPECT_LE(reduced.energy_lost, round_off) << "seed " << seed;
  }
}

std::string refusal(const std::string& text, const ReducedModel& reduced) {
  const LoadedCase read = loaded(text);
  BuiltCase built = built_of(read);
  RunResult result;
  try {
    begin_reduced(reduced, {}, built, {}, result);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(ReducedRun, IsRefusedForAnotherStructureAndForOneThatChanges) {
  const BuiltCase built = built_of(loaded(tower(2)));
  const ReducedModel reduced = random_basis(built.model, 4, 1);
  const std::string given = tower(2);
  EXPECT_EQ(refusal(given, reduced), "");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = given;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  EXPECT_EQ(refusal(with("step = 2e-3", "step = 1e-3"), reduced), "");
  EXPECT_EQ(refusal(with("friction = 0.6", "friction = 0.3"), reduced), "");
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"E = 2e10", "E = 2.0001e10"},
                                 {"mass = 4500", "mass = 4501"},
                                 {"ratio = 0.02", "ratio = 0.021"},
                                 {"width = 4", "width = 4.1"}})
    EXPECT_NE(refusal(with(from, to), reduced).find("have changed since `uplift reduce`"), std::string::npos) << to;
  // Other functions and sizes of the loads, even in another direction that they span, but no load that the basis was not made for.
  const std::string push = "[[load]]\nname = \"push\"\nnode = \"n2\"\n", shaken = push + "function = \"shake\"\nforce = ";
  EXPECT_EQ(refusal(with("amplitude = 6", "amplitude = -60"), reduced), "");
  EXPECT_EQ(refusal(with("[damping]", push + "force = [0, 1e3]\n[damping]"), reduced), "");  // constant: part of the static state
  EXPECT_NE(refusal(with("[damping]", shaken + "[1e3, 0]\n[damping]"), reduced)
                .find("found one that does not represent the answer to the load \"push\""),
            std::string::npos);
  const ReducedModel both = random_basis(built_of(loaded(with("[damping]", shaken + "[1e3, 0]\n[damping]"))).model, 4, 1);
  EXPECT_EQ(refusal(with("[damping]", shaken + "[-7, 0]\n[damping]"), both), "");
  EXPECT_EQ(refusal(given, both), "");
  EXPECT_NE(refusal(with("[damping]", shaken + "[0, 1e3]\n[damping]"), both), "");
  EXPECT_NE(refusal(with("type = \"dynamic\"", "type = \"dynamic\"\np_delta = true"), reduced).find("p_delta"), std::string::npos);
}

/// A block on soil with absorbing faces, in a wave whose velocity is a Ricker wavelet of this frequency [Hz].
std::string block_on_soil(double frequency) {
  return fmt::format(
      "title = \"block\"\nbonded = false\n[mesh.soil_box.soil]\nwidth = 24\nsize = 2\n"
      "[[mesh.soil_box.soil.layers]]\nthickness = 6\nsize = 2\n[mesh.soil_box.block]\nwidth = 4\nheight = 8\nsize = 2\n"
      "[[solid]]\ngroup = \"soil_1\"\nshear_wave_speed = 200\npoisson = 0.3\ndensity = 2000\n"
      "[[solid]]\ngroup = \"block\"\nE = 2e9\npoisson = 0.2\ndensity = 400\n"
      "[[support]]\ngroup = \"soil_bottom\"\nfixed = [\"ux\", \"uy\"]\nstages = \"static\"\n"
      "[[absorbing]]\ngroup = \"soil_bottom\"\n"
      "incident = {{ wave = \"SV\", kind = \"outcrop\", velocity = 0.5, function = \"pulse\", name = \"wave\" }}\n"
      "[[absorbing]]\ngroup = \"soil_left\"\nfree_field = true\n[[absorbing]]\ngroup = \"soil_right\"\nfree_field = true\n"
      "[[interface]]\nname = \"base\"\nsurface = {{ group = \"interface\", lower = [\"soil_1\"] }}\n"
      "law = {{ type = \"springs\", K_n = 2e9, tangential = \"bonded\" }}\n"
      "[gravity]\nacceleration = [0, -9.81]\n[[function]]\nname = \"pulse\"\nshape = {{ type = \"ricker\", frequency = {} }}\n"
      "[damping]\nrayleigh = [{{ frequency = 1, ratio = 0.03 }}, {{ frequency = 8, ratio = 0.03 }}]\n"
      "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 2\nstep = 5e-3\n",
      frequency);
}

/// The function of the wave, times a factor.
struct Times final : TimeFunction {
  Times(double by, std::shared_ptr<const TimeFunction> function) : factor(by), of(std::move(function)) {}
  double value(double time) const override { return factor * of->value(time); }
  double rate(double time) const override { return factor * of->rate(time); }
  double acceleration(double time) const override { return factor * of->acceleration(time); }
  double factor;
  std::shared_ptr<const TimeFunction> of;
};

TEST(FreeFieldOfAWave, UnderItsOwnMotionIsItselfAndIsLinear) {
  const BuiltCase built = built_of(loaded(block_on_soil(2)));
  ASSERT_EQ(built.model.time_load_tables.size(), 2U);
  const auto load = std::ranges::find(built.model.time_loads, "wave", &TimeLoad::name);
  ASSERT_NE(load, built.model.time_loads.end());
  for (const TimeLoadTable& table : built.model.time_load_tables) {
    const auto* own = dynamic_cast<const WaveFunctions*>(table.functions.get());
    ASSERT_NE(own, nullptr);
    EXPECT_EQ(own->load(), "wave");
    const auto same = own->under(load->function, 5e-3, 2), other = own->under(std::make_shared<Times>(-3, load->function), 5e-3, 2);
    Vector expected, found;
    own->values(0.7025, expected);
    const double size = expected.norm();
    EXPECT_GT(size, 1e-2);
    for (const double time : {0.0, 0.4, 0.7025, 1.9}) {
      own->values(time, expected);
      same->values(time, found);
      EXPECT_EQ((found - expected).cwiseAbs().maxCoeff(), 0) << time;
      other->values(time, found);
      EXPECT_LE((found + 3 * expected).norm(), 1e-12 * size) << time;
    }
  }
}

/// The same block on nine pairs of nodes, shaken into rocking; pictures at 37 instants.
std::string rocking_block(const std::string& bottom, const std::string& tangential) {
  std::string text = block_on_soil(1.5);
  const auto replace = [&](const std::string& from, const std::string& to) { text.replace(text.find(from), from.size(), to); };
  const std::size_t first = text.find("[[absorbing]]");
  text.erase(first, text.find("[[interface]]") - first);
  replace("stages = \"static\"\n", bottom);
  replace("height = 8\nsize = 2", "height = 8\nsize = 0.5");
  replace("tangential = \"bonded\"", tangential);
  replace("duration = 2\n", "duration = 1.5\n");
  return text +
         "[[ground_acceleration]]\ndirection = [1, 0]\nfunction = \"pulse\"\namplitude = 4\n[output]\nenergies = true\nframes = 37\n";
}

// Rows that are independent of each other, and more coordinates than a full matrix of the unknowns that they touch may have. Pictures,
// sixteen at a time, are those of the whole model, too.
TEST(ReducedRun, OnManyIndependentRowsAFullBasisIsTheRunOfTheWholeModel) {
  for (const bool absorbing : {false, true}) {
    const std::string bottom = absorbing ? "stages = \"static\"\n[[absorbing]]\ngroup = \"soil_bottom\"\n" : "";
    std::optional<ReducedModel> basis;
    for (const char* tangential : {"K_t = 1e9, tangential = \"bonded\"", "K_t = 1e9, tangential = \"coulomb\", friction = 0.6"}) {
      const LoadedCase read = loaded(rocking_block(bottom, tangential));
      const BuiltCase built = built_of(read);
      ASSERT_GT(built.model.free(), 64);
      ASSERT_GE(built.model.rows(), 18);
      const RunResult full = run(built.model, built.plan, built.behaviours);
      ASSERT_EQ(full.status, RunStatus::completed) << full.reason;
      EXPECT_GT(full.max_uplifted_ratio.value, 0.2) << tangential;
      if (!basis) basis = random_basis(built.model, built.model.free(), 1);
      const RunResult reduced = run_reduced(read, *basis);
      ASSERT_EQ(reduced.status, RunStatus::completed) << reduced.reason;
      expect_same(reduced, full, 1e-10);
      ASSERT_GE(full.frames.size(), 37U);
      ASSERT_EQ(reduced.frames.size(), full.frames.size());
      double most = 0;
      for (const Frame& frame : full.frames) most = std::max(most, frame.displacement.cwiseAbs().maxCoeff());
      for (std::size_t k = 0; k < full.frames.size(); ++k) {
        ASSERT_EQ(reduced.frames[k].displacement.size(), full.frames[k].displacement.size()) << k;
        EXPECT_LE((reduced.frames[k].displacement - full.frames[k].displacement).cwiseAbs().maxCoeff(), 1e-10 * most) << tangential << k;
      }
    }
  }
}

// A basis belongs to the structure, not to the motion with which it was made.
TEST(ReducedCase, HoldsForAnotherWaveThanThatOfTheCase) {
  const std::optional<ReducedModel> reduced = reduce_case(loaded(block_on_soil(0.3)), {.frequency = 50, .target = 1e-4}, {});
  ASSERT_TRUE(reduced);
  EXPECT_LT(2 * reduced->vectors.cols(), reduced->vectors.rows());
  const LoadedCase other = loaded(block_on_soil(3));
  const BuiltCase built = built_of(other);
  const RunResult full = run(built.model, built.plan, built.behaviours), part = run_reduced(other, *reduced);
  EXPECT_GT(full.max_opening.value, 1e-3);
  EXPECT_NEAR(part.max_opening.value, full.max_opening.value, 1e-2 * full.max_opening.value);
  EXPECT_NEAR(part.max_base_moment.value, full.max_base_moment.value, 1e-2 * std::abs(full.max_base_moment.value));
}

// Vertical shaking moves the axis of a symmetric block up and down alone: an error relative to its motion to the sides, which is round-off,
// would be that of nothing.
TEST(ReducedCase, AFloorThatSymmetryKeepsAtRestInOneDirectionHasATransferError) {
  std::string text = block_on_soil(3);
  const std::size_t first = text.find("stages = \"static\"");
  text.erase(first, text.find("[[interface]]") - first);
  text +=
      "[[ground_acceleration]]\ndirection = [1, 0]\nfunction = \"pulse\"\n"
      "[[ground_acceleration]]\ndirection = [0, 1]\nfunction = \"pulse\"\n"
      "[[output.floor_spectrum]]\nname = \"top\"\nat = [0, 8]\ndirection = [1, 0]\n";
  const std::optional<ReducedModel> reduced = reduce_case(loaded(text), {.size = 30}, {});
  ASSERT_TRUE(reduced);
  EXPECT_GT(reduced->transfer_error, 0);
  EXPECT_LT(reduced->transfer_error, 1e-2);
}

TEST(ReducedCase, IsChosenByItsTransferErrorAndCloseToTheWholeModel) {
  const LoadedCase read = loaded(tower(12));
  ReduceOptions options{.target = 1e-4, .controls = 3, .least_scale = 0.8, .most_scale = 1.2};
  const std::optional<ReducedModel> reduced = reduce_case(read, options, {});
  ASSERT_TRUE(reduced);
  EXPECT_LE(reduced->transfer_error, 1e-4);
  EXPECT_LT(reduced->vectors.cols(), reduced->vectors.rows());
  ASSERT_TRUE(reduced->controls);
  EXPECT_EQ(reduced->controls->runs, 3);
  EXPECT_EQ(reduced->controls->different, 0);
  EXPECT_LT(reduced->controls->opening, 0.01);
  EXPECT_LT(reduced->controls->moment, 0.02);
  EXPECT_LT(reduced->controls->history, 0.02);
  EXPECT_GT(reduced->controls->slip, 0);
  EXPECT_LT(reduced->controls->slip, 0.02);
  EXPECT_NEAR(reduced->controls->confidence(), 1 - 0.95 * 0.95 * 0.95, 1e-15);

  options.controls = 0, options.size = 3;
  const std::optional<ReducedModel> small = reduce_case(read, options, {});
  ASSERT_TRUE(small);
  EXPECT_EQ(small->vectors.cols(), 3);
  EXPECT_GT(small->transfer_error, reduced->transfer_error);
}

// 80 rows are loaded all together, by random bells.
TEST(ReducedCase, OfManyRowsIsCloseToTheWholeModel) {
  std::string text = tower(12);
  const std::string few = "points = 8", many = "points = 40";
  text.replace(text.find(few), few.size(), many);
  const LoadedCase read = loaded(text);
  ASSERT_EQ(built_of(read).model.rows(), 80);
  const std::optional<ReducedModel> reduced = reduce_case(read, {.target = 1e-4, .controls = 2, .least_scale = 0.8, .most_scale = 1.2}, {});
  ASSERT_TRUE(reduced);
  EXPECT_LE(reduced->transfer_error, 1e-4);
  EXPECT_LT(reduced->vectors.cols(), reduced->vectors.rows());
  ASSERT_TRUE(reduced->controls);
  EXPECT_EQ(reduced->controls->different, 0);
  EXPECT_LT(reduced->controls->opening, 0.01);
  EXPECT_LT(reduced->controls->moment, 0.02);
  EXPECT_LT(reduced->controls->history, 0.02);
  EXPECT_LT(reduced->controls->slip, 0.02);
}

// The ground moves the footing of this tower, which flies where the interface is open, with all of the tower: such an answer is a motion
// of the basis already, and what round-off leaves of it must take no coordinate from the answers that deform the tower.
TEST(ReducedCase, TakesNoCoordinatesForTheRoundOffOfRigidAnswers) {
  const std::optional<ReducedModel> reduced = reduce_case(loaded(tower(12)), {.size = 20, .controls = 2}, {});
  ASSERT_TRUE(reduced);
  EXPECT_EQ(reduced->rigid, 3);
  ASSERT_TRUE(reduced->controls);
  EXPECT_LT(reduced->controls->opening, 1e-4);
  EXPECT_LT(reduced->controls->moment, 1e-4);
  EXPECT_LT(reduced->controls->history, 1e-4);
}

// Every row of an interface keeps its own flexibility, however few coordinates follow; here that of the block on its inertia at a tenth
// of the frequency and of the soil under it.
TEST(ReducedCase, KeepsTheFlexibilityOfEveryRow) {
  const BuiltCase built = built_of(loaded(block_on_soil(3)));
  const Model& model = built.model;
  const Sparse b = stack_interfaces(model);
  const double frequency = 25, slow = 0.2 * std::numbers::pi * frequency;
  const Sparse a = model.stiffness + slow * slow * model.mass;
  const auto flexibility = [](const Matrix& stiffness, const Matrix& rows) -> Matrix {
    return rows * Cholesky(stiffness).solve(Matrix(rows.transpose()));
  };
  const Matrix whole = flexibility(a, b);
  for (const int beside : {10, 25}) {
    const int size = 6 + static_cast<int>(b.rows()) + beside;  // block and soil are loose
    const std::optional<ReducedModel> reduced = reduce_case(loaded(block_on_soil(3)), {.frequency = frequency, .size = size}, {});
    ASSERT_TRUE(reduced);
    const Matrix& v = reduced->vectors;
    ASSERT_EQ(v.cols(), size);
    const Matrix part = flexibility(v.transpose() * (a * v), b * v);
    EXPECT_LT((part - whole).cwiseAbs().maxCoeff(), 1e-9 * whole.cwiseAbs().maxCoeff()) << size;
  }
}

TEST(ReducedModelFile, IsReadAsWrittenAndRefusedWithAnyBitFlippedOrCutAnywhere) {
  ReducedModel written;
  written.version = "1", written.matrices = "ab", written.frequency = 25, written.energy_frequency = w, written.transfer_error = 1e-3;
  written.vectors = Matrix::Random(5, 3);
  written.loads = Matrix::Random(5, 2);
  written.controls.emplace();
  written.controls->runs = 59, written.controls->opening = 0.01, written.controls->slip = 0.03;
  const std::string bytes = write_reduced_model(written);
  std::string why;
  const std::optional<ReducedModel> read = read_reduced_model(bytes, why);
  ASSERT_TRUE(read) << why;
  EXPECT_TRUE(read->vectors == written.vectors);
  EXPECT_TRUE(read->loads == written.loads);
  EXPECT_EQ(read->matrices, "ab");
  ASSERT_TRUE(read->controls);
  EXPECT_EQ(read->controls->opening, 0.01);
  EXPECT_EQ(read->controls->slip, 0.03);
  EXPECT_NEAR(read->controls->confidence(), 0.9515, 5e-5);  // Wilks
  std::mt19937 random(1);
  std::uniform_int_distribution<std::size_t> any_byte(0, bytes.size() - 1);
  for (int i = 0; i < 1000; ++i) {
    std::string changed = bytes;
    changed[any_byte(random)] ^= static_cast<char>(1 << (i % 8));
    ASSERT_FALSE(read_reduced_model(changed, why)) << i;
    ASSERT_FALSE(why.empty());
  }
  for (std::size_t size = 0; size < bytes.size(); ++size) ASSERT_FALSE(read_reduced_model(std::string_view(bytes).substr(0, size), why));
}

}  // namespace
}  // namespace uplift::reduce_test
