// The scheme of filtered energy decay in random models: the energy balance closes under prescribed motion, on yielding soil, with Coulomb
// friction in space, on whole foundations and with P-Delta, for joints from k F_ii = 1e-2 to 1e3
// (foundations: to 10).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <random>

#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

namespace uplift::energy_decay_models_test {
namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double uniform(double least, double most) { return std::uniform_real_distribution<double>(least, most)(engine_); }
  double decades(double least, double most) { return std::pow(10.0, uniform(std::log10(least), std::log10(most))); }
  bool chance(double p) { return uniform(0, 1) < p; }
  const char* of(std::initializer_list<const char*> list) {
    return list.begin()[std::uniform_int_distribution<std::size_t>(0, list.size() - 1)(engine_)];
  }

 private:
  std::mt19937_64 engine_;
};

/// A joint with friction; `pressure` [Pa] is the mean pressure at rest.
std::string law(Draw& draw, const std::string& type, double stiffness, double pressure) {
  std::string text = fmt::format("law = {{ type = \"{}\", K_n = {:.6g}, K_t = {:.6g}, tangential = \"coulomb\", friction = {:.3g}", type,
                                 stiffness, stiffness * draw.uniform(0.2, 0.8), draw.uniform(0.2, 0.7));
  if (type != "springs") {
    // the softening branch is four times as long as the elastic one
    const double strength = pressure * draw.uniform(0.05, 0.3);
    text += fmt::format(", F_u = {:.6g}, G_f = {:.6g}", strength, 4 * strength * strength / stiffness);
  }
  if (type == "sdm") text += fmt::format(", F_c = {:.6g}", -0.01 * pressure);
  return text + " }\n";
}

std::string stages(double step, int steps, double rho, bool p_delta) {
  return fmt::format(
      "[[stage]]\ntype = \"static\"\nsteps = 4\n[[stage]]\ntype = \"dynamic\"\nstep = {:.6g}\nduration = {:.6g}\n"
      "scheme = {{ type = \"energy_decay\", rho = {:.3g} }}\n{}[energy]\ncreated_limit = 1e9\n[output]\nframes = 0\n",
      step, step * steps, rho, p_delta ? "p_delta = true\n" : "");
}

/// A model as text, but for the stiffness of its joint [Pa/m].
struct Drawn {
  std::function<std::string(double)> text;
  std::string words;
  double ratio = 0;  // k F_ii that its joint is to have
};

struct Ran {
  RunResult result;
  double ratio = 0;
};

Ran run_with(const Drawn& drawn, double stiffness, bool only_ratio) {
  const Case read = check_case(read_toml_text(drawn.text(stiffness), "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  Ran ran;
  for (const Stage& stage : built.plan.stages)
    if (stage.type == Stage::Type::dynamics) ran.ratio = stiffness_ratios(built.model, stage, *built.plan.solver).front().most;
  if (!only_ratio) ran.result = run(built.model, built.plan, built.behaviours);
  return ran;
}

const std::vector<double>& column(const RunResult& result, const std::string& name) {
  for (std::size_t k = 0; k < result.columns.size(); ++k)
    if (result.columns[k].name == name) return result.table[k + 1];
  throw std::out_of_range(name);
}

/// Runs `count` models and checks the energy balance of each: nothing is created, and what the filters dissipate never falls.
void check_models(const char* title, int count, double limit, const std::function<Drawn(Draw&)>& draw_model) {
  int completed = 0, uplifted = 0;
  long steps = 0, iterations = 0, retries = 0;
  double worst = 0, most_lost = 0;
  for (int k = 0; k < count; ++k) {
    const std::uint64_t seed = 20261100 + static_cast<std::uint64_t>(k);
    Draw draw(seed);
    const Drawn drawn = draw_model(draw);
    SCOPED_TRACE(fmt::format("{}, seed {}: {}, k F_ii {:.2g}", title, seed, drawn.words, drawn.ratio));
    const double guess = 1e8;
    const Ran ran = run_with(drawn, guess * drawn.ratio / run_with(drawn, guess, true).ratio, false);
    const RunResult& result = ran.result;
    EXPECT_NEAR(ran.ratio, drawn.ratio, 1e-3 * drawn.ratio);
    double residual = 0, least = 0, previous = 0, before = 0;
    for (const double value : column(result, "energy.residual")) residual = std::max(residual, std::abs(value));
    for (const double value : column(result, "energy.algorithmic")) least = std::min(least, value - previous), previous = value;
    EXPECT_LE(residual, limit * result.energy_scale) << to_string(result.status) << ": " << result.reason;
    EXPECT_GE(least, -1e-13 * result.energy_scale) << "the filters only dissipate";
    least = 0, before = 0;
    for (const double value : column(result, "energy.interface_dissipated")) least = std::min(least, value - before), before = value;
    EXPECT_GE(least, -1e-13 * result.energy_scale) << "the joint only dissipates";
    completed += result.status == RunStatus::completed;
    uplifted += result.max_uplifted_ratio.value > 0.1;
    worst = std::max(worst, residual / result.energy_scale);
    most_lost = std::max(most_lost, previous / result.energy_scale);
    steps += result.counts.steps, iterations += result.counts.iterations, retries += result.counts.retries;
    if (result.status != RunStatus::completed)
      fmt::print("  seed {}: {}, k F_ii {:.2g}: {} {}\n", seed, drawn.words, drawn.ratio, to_string(result.status), result.reason);
  }
  fmt::print("{}: residual {:.1e} of the work, up to {:.2g} % dissipated by the filters, {:.2f} iterations a step, {} retries\n", title,
             worst, 100 * most_lost, static_cast<double>(iterations) / static_cast<double>(steps), retries);
  EXPECT_GE(completed, 9 * count / 10) << "of " << count;
  EXPECT_GE(uplifted, count / 2) << "of " << count;
}

// ---- a tower on a footing in space ----

/// A foundation with the vertical stiffness k [N/m]: uplift alone, or yielding that settles and sliding.
std::string foundation(Draw& draw, double k, double width, double length, double weight) {
  const bool disc = draw.chance(0.3);
  std::string text = fmt::format("[[foundation]]\nname = \"soil\"\nbody = \"base\"\nwidth = {:.6g}\n{}", width,
                                 disc ? "shape = \"disc\"\n" : fmt::format("length = {:.6g}\n", length));
  text += fmt::format("model = {{ type = \"macro_element\", shape_number = {}, K_v = {:.6g}, K_h = {:.6g}, K_r = {:.6g}, K_t = {:.6g}",
                      draw.of({"4", "6", "8", "5.3"}), k, k * draw.uniform(0.3, 1.2), k * width * width / 12 * draw.uniform(0.8, 3),
                      k * width * width / 8);
  if (!disc) text += fmt::format(", K_r2 = {:.6g}", k * length * length / 12 * draw.uniform(0.8, 3));
  if (draw.chance(0.3)) return text + " }\n";
  const double service = weight * draw.uniform(2, 6);
  text += fmt::format(", V_s = {:.6g}", service);
  if (draw.chance(0.5)) text += fmt::format(", V_u = {:.6g}, w_ref = {:.3g}", service * draw.uniform(1.1, 2), 1e-3 * width);
  if (draw.chance(0.7)) text += fmt::format(", friction_angle = {:.3g}", draw.uniform(0.3, 0.7));
  return text + " }\n";
}

/// Three pulses within the first 400 steps. `joint`: on springs or a softening law, else on a foundation.
Drawn tower_in_space(Draw& draw, bool p_delta, int steps = 400, bool joint = true) {
  const double height = draw.uniform(5, 20), width = draw.uniform(3, 8), mass = draw.decades(2e4, 1e6), step = draw.decades(5e-4, 5e-3);
  const double frequency = draw.uniform(1, 6), stiffness = std::pow(2 * M_PI * frequency, 2) * mass * std::pow(height, 3) / 3;
  const double pressure = 9.81 * 1.5 * mass / (width * width), pull = draw.uniform(0.4, 1.2) * 9.81 * width / height;
  const double rho = draw.chance(0.7) ? 0.5 : draw.uniform(0, 0.95);
  const std::string type = draw.of({"springs", "springs", "sdm", "exponential"});
  std::string text = fmt::format(
      "title = \"tower\"\n[nodes]\nbase = [0, 0, 0]\ntop = [0, 0, {0:.6g}]\n[[beam]]\nname = \"shaft\"\nnodes = [\"base\", \"top\"]\n"
      "E = 1\nA = {1:.6g}\nI_y = {2:.6g}\nI_z = {3:.6g}\nJ = {2:.6g}\nelements = 2\n"
      "[[mass]]\nnode = \"top\"\nmass = {4:.6g}\ninertias = [{5:.6g}, {5:.6g}, {5:.6g}]\n"
      "[[rigid]]\nname = \"raft\"\nnode = \"base\"\nmass = {6:.6g}\ninertias = [{7:.6g}, {7:.6g}, {8:.6g}]\n"
      "[gravity]\nacceleration = [0, 0, -9.81]\n",
      height, 50 * stiffness / (height * height), stiffness, stiffness * draw.uniform(0.6, 1.6), mass, mass * draw.uniform(0.5, 4),
      0.5 * mass, mass * width * width / 24, mass * width * width / 12);
  for (const auto& [name, direction] : {std::pair{"x", "[1, 0, 0]"}, {"y", "[0, 1, 0]"}, {"z", "[0, 0, 1]"}})
    text += fmt::format(
        "[[function]]\nname = \"{0}\"\nshape = {{ type = \"ricker\", frequency = {1:.4g} }}\n"
        "[[ground_acceleration]]\nname = \"quake {0}\"\ndirection = {2}\namplitude = {3:.4g}\nfunction = \"{0}\"\n",
        name, draw.uniform(2, 5) / (step * 400), direction, pull * draw.uniform(0.3, 1));
  text += stages(step, steps, rho, p_delta) + (p_delta ? "[limits]\nrotation = 1\n" : "");
  const std::string interface =
      fmt::format("[[interface]]\nname = \"soil\"\nfooting = {{ body = \"base\", width = {:.4g}, length = {:.4g}, ", width,
                  width * draw.uniform(0.6, 1.4)) +
      fmt::format("points = {}, points_across = 5, azimuth = {:.3g} }}\n", 5 + static_cast<int>(draw.uniform(0, 4)), draw.uniform(0, 1));
  const Draw beginning = draw;
  const auto whole = [=](double k) {
    Draw again = beginning;
    if (!joint) return text + foundation(again, k, width, 1.2 * width, 9.81 * 1.5 * mass);
    return text + interface + law(again, type, k, pressure);
  };
  return {whole, fmt::format("{}, step {:.2g} s, rho {:.2g}", joint ? type : "foundation", step, rho),
          draw.decades(1e-2, joint ? 1e3 : 10)};
}

TEST(EnergyDecayModels, FoundationsInSpace) {
  check_models("foundations", 40, 1e-10, [](Draw& draw) { return tower_in_space(draw, draw.chance(0.3), 400, false); });
}

TEST(EnergyDecayModels, CoulombFrictionInSpace) {
  check_models("friction in space", 30, 1e-10, [](Draw& draw) { return tower_in_space(draw, false); });
}

TEST(EnergyDecayModels, TenThousandSteps) {
  check_models("ten thousand steps", 6, 1e-10, [](Draw& draw) { return tower_in_space(draw, draw.chance(0.5), 10000); });
}

TEST(EnergyDecayModels, PDelta) {
  check_models("P-Delta", 30, 1e-10, [](Draw& draw) { return tower_in_space(draw, true); });
}

// ---- a block on soil, in plane strain ----

/// `cohesion` [Pa] of the soil; 0: elastic. Either the bottom moves or a force pushes the block.
Drawn block_on_soil(Draw& draw, double cohesion, bool moved) {
  const double young = draw.decades(3e7, 3e8), step = draw.decades(5e-4, 4e-3), rho = draw.chance(0.7) ? 0.5 : draw.uniform(0, 0.95);
  const int steps = 200;
  const double pressure = 6 * 1500 * 9.81, length = draw.uniform(0.3, 0.6) * step * steps;
  const std::string type = draw.of({"springs", "springs", "sdm", "bilinear"});
  std::string text = fmt::format(
      "title = \"block\"\n[mesh.soil_box.soil]\nwidth = 12\nsize = 1.5\n[[mesh.soil_box.soil.layers]]\nthickness = 4\nsize = 1\n"
      "[mesh.soil_box.block]\nwidth = 3\nheight = 6\nsize = 1\n"
      "[[solid]]\ngroup = \"soil_1\"\nE = {:.6g}\npoisson = 0.3\ndensity = 1900\n",
      young);
  if (cohesion > 0)
    text += fmt::format(
        "plasticity = {{ type = \"drucker_prager\", cohesion = {:.6g}, friction_angle = 0.4, dilatancy_angle = {:.3g}, fit = "
        "\"plane_strain\" }}\n",
        cohesion, draw.uniform(0.05, 0.4));
  text += fmt::format(
      "[[solid]]\ngroup = \"block\"\nE = 2e9\npoisson = 0.2\ndensity = 1500\n"
      "[[support]]\ngroup = \"soil_bottom\"\nfixed = [{}]\n"
      "[gravity]\nacceleration = [0, -9.81]\n[damping]\nbeta = {:.3g}\n"
      "[[function]]\nname = \"pulse\"\nshape = {{ type = \"half_sine\", duration = {:.6g} }}\n",
      moved ? "\"uy\"" : "\"ux\", \"uy\"", draw.decades(1e-6, 1e-3), length);
  if (moved) {
    text +=
        fmt::format("[[motion]]\nname = \"base\"\ngroup = \"soil_bottom\"\ndirection = \"ux\"\namplitude = {:.4g}\nfunction = \"pulse\"\n",
                    draw.uniform(3, 10) * length * length);
  } else {
    text += fmt::format("[[load]]\nname = \"push\"\ngroup = \"block_top\"\nforce = [{:.6g}, 0]\nfunction = \"pulse\"\n",
                        draw.uniform(0.3, 1) * 3 * pressure);
  }
  text += stages(step, steps, rho, false) + "[[interface]]\nname = \"base\"\nsurface = { group = \"interface\", lower = [\"soil_1\"] }\n";
  const Draw beginning = draw;
  const auto whole = [text, beginning, type, pressure](double k) {
    Draw again = beginning;
    return text + law(again, type, k, pressure);
  };
  return {whole, fmt::format("{}, step {:.2g} s, rho {:.2g}", type, step, rho), draw.decades(1e-2, 1e3)};
}

TEST(EnergyDecayModels, PrescribedMotion) {
  check_models("prescribed motion", 20, 1e-10, [](Draw& draw) { return block_on_soil(draw, 0, true); });
}

TEST(EnergyDecayModels, YieldingSoil) {
  check_models("yielding soil", 8, 1e-10, [](Draw& draw) { return block_on_soil(draw, draw.decades(2e4, 6e4), false); });
}

// ---- damping of what the step resolves ----

/// Damping ratio of a mass of 1 t on a spring of the structure or on a joint in contact, from its velocity over 40 periods.
double damping_ratio(bool joint, int steps_per_period) {
  const double frequency = 1, stiffness = std::pow(2 * M_PI * frequency, 2) * 1000, step = 1.0 / steps_per_period;
  const int periods = 40;
  std::string text =
      "title = \"oscillator\"\n[nodes]\nfoot = [0, 0]\n[[mass]]\nnode = \"foot\"\nmass = 1000\n[[support]]\nnode = \"foot\"\n"
      "fixed = [\"ux\", \"rz\"]\n[gravity]\nacceleration = [0, -9.81]\n[[interface]]\nname = \"joint\"\n"
      "pairs = { upper = [\"foot\"], area = 1 }\n";
  // the joint carries the mass, or nothing beside a spring that carries it
  text += fmt::format("law = {{ type = \"springs\", K_n = {:.17g}, tangential = \"none\" }}\n", joint ? stiffness : 1e-6 * stiffness);
  if (!joint) text += fmt::format("[[spring]]\nnodes = [\"foot\"]\ndirection = [0, 1]\nstiffness = {:.17g}\n", stiffness);
  text += fmt::format(
      "[[initial]]\nnode = \"foot\"\nvelocity = [0, 0.01]\n[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = {}\n"
      "step = {:.17g}\nscheme = \"energy_decay\"\n[output]\nframes = 0\nhistory = [{{ node = \"foot\", quantity = \"vy\" }}]\n",
      periods, step);
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const BuiltCase built = build(read, runs_of_case(read).front());
  const RunResult result = run(built.model, built.plan, built.behaviours);
  EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
  const std::vector<double>& velocity = column(result, "foot.vy");
  // z^2 - p z + q = 0 with the pair of eigenvalues of the motion: least squares of v_(n+1) = p v_n - q v_(n-1), after the filters settled
  double aa = 0, ab = 0, bb = 0, ac = 0, bc = 0;
  for (std::size_t i = 200; i + 1 < velocity.size(); ++i) {
    const double before = velocity[i - 1], now = velocity[i], after = velocity[i + 1];
    aa += now * now, ab -= now * before, bb += before * before, ac += now * after, bc -= before * after;
  }
  const double q = (aa * bc - ab * ac) / (aa * bb - ab * ab);
  return -std::log(q) / 2 / (2 * M_PI / steps_per_period);
}

/// Damping ratio of the method of Jansen, Whiting & Hulbert for y' = i omega y, from its own coefficients (alpha_m, alpha_f, gamma): the
/// linear part of the scheme has the same eigenvalues.
double damping_of_jansen(double rho, double theta) {
  const double alpha_m = (3 - rho) / (2 * (1 + rho)), alpha_f = 1 / (1 + rho), gamma = 0.5 + alpha_m - alpha_f;
  const std::complex<double> z(0, theta), pivot = alpha_m - gamma * alpha_f * z;
  // rate after the step = (c y + d rate)/pivot,   y after the step = y + (1 - gamma) rate + gamma (rate after the step)
  const std::complex<double> c = z / pivot, d = (alpha_f * (1 - gamma) * z - (1 - alpha_m)) / pivot;
  const std::complex<double> a = 1.0 + gamma * c, b = 1 - gamma + gamma * d;
  const std::complex<double> half = 0.5 * (a + d), root = std::sqrt(half * half - (a * d - b * c));
  const double largest = std::max(std::abs(half + root), std::abs(half - root));
  return -std::log(largest) / theta;
}

TEST(EnergyDecayModels, ModesThatTheStepResolvesAreHardlyDamped) {
  for (const int steps : {50, 20})
    for (const bool joint : {false, true}) {
      const double found = damping_ratio(joint, steps), expected = damping_of_jansen(0.5, 2 * M_PI / steps);
      fmt::print("{} steps a period, {}: {:.5f} % of critical, Jansen {:.5f} %\n", steps, joint ? "joint in contact" : "spring",
                 100 * found, 100 * expected);
      if (steps == 50) EXPECT_LT(found, 1e-4);
      EXPECT_NEAR(found, expected, 0.01 * expected);
    }
}

}  // namespace
}  // namespace uplift::energy_decay_models_test
