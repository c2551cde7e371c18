// What a run that came to its end may hide: second-order effects, pressures without a bound, noise, floors that the bonded run lacks.
#include <algorithm>
#include <cmath>
#include <deque>

#include "tower_case.h"
#include "unit/verdict/verdict_support.h"
#include "uplift/case/advice/swaying_solids.h"
#include "uplift/verdict/compare_motions.h"
#include "uplift/verdict/edge_warnings.h"
#include "uplift/verdict/second_order.h"
#include "uplift/verdict/verdict.h"

namespace uplift::doubtful_results_test {
namespace {

using namespace support;

constexpr double gravity = 9.81, top_mass = 24000, footing_mass = 1e4, total = (top_mass + footing_mass) * gravity;  // m/s2, kg, N

const std::string law = "law = { type = \"springs\", K_n = 1e9, K_t = 1e8 }\n";

/// Whether a warning of `check` says this.
bool warned(const std::string& text, const std::string& of) {
  const Case file = check_case(read_toml_text(text, "case.toml"), "case.toml");
  const RunSpec spec = runs_of_case(file).front();
  return std::ranges::any_of(warnings(file, spec, build(file, spec)), [&](const std::string& each) { return each.find(of) != each.npos; });
}

/// A mass of 24 t on a column of 5 m over a footing of 3 m and 10 t.
std::string tower(const std::string& driven, const std::string& p_delta = "", const std::string& soil = law, const Tower& changed = {}) {
  return "title = \"tower\"\n" + changed.text() + weight +
         "[[interface]]\nname = \"soil\"\nfooting = { body = \"base\", width = 3, points = 11 }\n" + soil +
         "[[function]]\nname = \"f\"\nshape = { type = \"half_sine\", duration = 1 }\n" + driven +
         "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 1\nstep = 0.01\n" + p_delta;
}
const std::string shaken = "[[ground_acceleration]]\nfunction = \"f\"\n";
const std::string pushed = "[[load]]\nnode = \"top\"\nforce = [1e4, 0]\nfunction = \"f\"\n";

/// A run that reaches a base moment and a drift of the top at its second instant.
RunResult reaching(const BuiltCase& built, double moment, double drift, double open = 0) {
  const auto now = [](double m, double share) { return view_of({.axial = -total, .moment = m}, share); };
  RunResult run = run_of({now(0, 0), now(moment, open), now(0, 0)}, 0.5);
  Request top;
  top.kind = Request::Kind::displacement;
  top.name = "top.ux", top.unit = "m", top.unknown = built.top_sway();
  run.columns = {top};
  run.table = {{0, 0.5, 1}, {0, drift, 0}};
  run.peaks = {{"top.ux", "m", drift, 0.5}};
  for (std::size_t k = 0; k < built.plan.combined.size(); ++k)
    run.combined.push_back({.value = drift, .time = 0.5, .least = {std::min(drift, 0.0)}, .most = {std::max(drift, 0.0)}, .known = true});
  run.max_base_moment = {"", "N m", moment, 0.5};
  run.max_uplifted_ratio = {"", "1", open, 0.5};
  run.end_time = 1;
  run.energy_scale = 1;
  return run;
}

SecondOrderMoment effects_of(const BuiltCase& built, const RunResult& run) {
  const std::optional<SecondOrderMoment> found = second_order_of(built, run, numbers_of(built, run, nullptr));
  EXPECT_TRUE(found);
  return found.value_or(SecondOrderMoment());
}

/// By hand: the top mass alone, and half of a mass at half of the height; the footing does not sway.
TEST(SecondOrderEffects, SwayingWeight) {
  EXPECT_NEAR(swaying_weight(built_of(tower(shaken))), top_mass * gravity, 1e-6);
  Tower changed;
  changed.nodes = "middle = [0, 2.5]";
  const std::string another =
      "[[beam]]\nname = \"arm\"\nnodes = [\"base\", \"middle\"]\nE = 1e10\nI = 0.1\n[[mass]]\nnode = \"middle\"\nmass = 1e4\n";
  EXPECT_NEAR(swaying_weight(built_of(tower(another + shaken, "", law, changed))), (top_mass + 0.5 * 1e4) * gravity, 1e-6);
}

/// A rigid block of 24 m whose master is at its foot: the weight is at the centre, half as high as the top, or at the top itself.
TEST(SecondOrderEffects, TheWeightOfABodyIsAtItsCentre) {
  const auto block = [](const std::string& slaves) {
    return "title = \"block\"\n[nodes]\nfoot = [0, 0]\nhigh = [0, 24]\n[[rigid]]\nnode = \"foot\"\n" + slaves +
           "mass = 72000\ninertia = 1e6\ncentre = [0, 12]\n[[interface]]\nname = \"soil\"\nfooting = { body = \"foot\", width = 6, points "
           "= 5 }\n" +
           law + weight + "[[stage]]\ntype = \"static\"\n";
  };
  EXPECT_NEAR(swaying_weight(built_of(block("slaves = [\"high\"]\n"))), 72000 * gravity / 2, 1e-6);
  const std::string held = "[[support]]\nnode = \"high\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n";
  EXPECT_NEAR(swaying_weight(built_of(block("") + held)), 72000 * gravity, 1e-6);
}

/// S = 333.54 kN x 1.5 m = 500.31 kN m. Under M = 400 kN m 100.31 kN m are left. W d with W = 235.44 kN: 35.3 kN m at 0.15 m is 8.8 % of
/// M; 94.2 kN m at 0.4 m, 23.5 %; 117.7 kN m at 0.5 m is more than what is left; 259.0 kN m at 1.1 m more than half of S.
TEST(SecondOrderEffects, ByHand) {
  const BuiltCase built = built_of(tower(shaken));
  const SecondOrderMoment little = effects_of(built, reaching(built, 4e5, 0.15));
  EXPECT_NEAR(little.moment(), 0.15 * top_mass * gravity, 1e-6);
  EXPECT_NEAR(little.ratio(), 0.08829, 1e-5);
  EXPECT_NEAR(little.least_left, 1.5 * total - 4e5, 1e-3);
  EXPECT_NEAR(little.stabilising, 1.5 * total, 1e-3);
  EXPECT_FALSE(little.counts());
  EXPECT_EQ(little.warning() + little.clause(), "");
  const SecondOrderMoment more = effects_of(built, reaching(built, 4e5, 0.4));
  EXPECT_TRUE(more.counts() && !more.exceeds_what_is_left());
  EXPECT_NE(more.warning().find("94.2 kN m (235 kN x 0.400 m), 24 % of the base moment;"), std::string::npos) << more.warning();
  EXPECT_EQ(more.clause(), "");
  const SecondOrderMoment beyond = effects_of(built, reaching(built, 4e5, 0.5));
  EXPECT_TRUE(beyond.exceeds_what_is_left() && !beyond.overturns()) << "the ground moves, and the base gives way";
  EXPECT_NE(beyond.warning().find("more than the 100 kN m that are left"), std::string::npos) << beyond.warning();
  EXPECT_TRUE(effects_of(built, reaching(built, 4e5, 1.1)).overturns());
}

/// A tower that stands nearly upright: 5 N m, which an eccentricity of 15 micrometres makes of the weight, beside S = 500 kN m. W d of a
/// sway of 0.1 mm is 23.5 N m, five times as much, and 5e-5 of S.
TEST(SecondOrderEffects, ABaseThatNothingTiltsHasNone) {
  const BuiltCase built = built_of(tower(shaken));
  const SecondOrderMoment upright = effects_of(built, reaching(built, 5, 1e-4));
  EXPECT_NEAR(upright.ratio(), 1e-4 * top_mass * gravity / 5, 1e-6);
  EXPECT_FALSE(upright.counts()) << upright.warning();
  EXPECT_TRUE(effects_of(built, reaching(built, 5, 1e-3)).counts()) << "235 N m are more than 1e-4 of S";
}

/// A force does not give way: what is left decides.
TEST(SecondOrderEffects, AForceOverturns) {
  const BuiltCase built = built_of(tower(pushed));
  EXPECT_FALSE(effects_of(built, reaching(built, 4e5, 0.4)).overturns());
  const RunResult run = reaching(built, 4e5, 0.5);
  EXPECT_TRUE(effects_of(built, run).overturns());
  const Verdict verdict = judge(built, run, nullptr);
  EXPECT_TRUE(verdict.headline.ends_with("; second-order effects, which are left out, would overturn it")) << verdict.headline;
}

TEST(SecondOrderEffects, NothingIsLeftOutWithPDelta) {
  const BuiltCase built = built_of(tower(shaken, "p_delta = true\n"));
  const RunResult run = reaching(built, 4e5, 1.1);
  EXPECT_FALSE(second_order_of(built, run, numbers_of(built, run, nullptr)));
}

/// A block of solids, 2 m x 10 m, on springs.
std::string block_of_solids(const std::string& p_delta, const std::string& more = "") {
  return "title = \"block\"\nbonded = false\n[mesh.soil_box.soil]\nwidth = 6\n[[mesh.soil_box.soil.layers]]\nthickness = 1\nsize = 1\n"
         "[mesh.soil_box.block]\nwidth = 2\nheight = 10\nsize = 1\n[[solid]]\ngroup = \"soil_1\"\nE = 1e12\npoisson = 0.3\n"
         "density = 1900\n[[solid]]\ngroup = \"block\"\nE = 1e12\npoisson = 0.2\ndensity = 1000\n[[support]]\ngroup = \"soil_bottom\"\n"
         "fixed = [\"ux\", \"uy\"]\n[[interface]]\nname = \"base\"\nsurface = { group = \"interface\", lower = [\"soil_1\"] }\n"
         "law = { type = \"springs\", K_n = 5e6, K_t = 1e9 }\n[gravity]\n[[function]]\nname = \"slow\"\n"
         "shape = { type = \"ramp\", duration = 9 }\n[[load]]\ngroup = \"block_top\"\nforce = [2e3, 0]\nfunction = \"slow\"\n"
         "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\nduration = 10\nstep = 0.02\n[damping]\nalpha = 2\n" +
         p_delta + more;
}

/// W = 2 x 10 x 1000 kg x g = 196.2 kN; in a block that turns as a whole half of it at the height of the top has the same moment. The
/// springs at the three pairs of nodes, K_n (0.5, 1, 0.5) m2 at -1, 0 and 1 m, turn by theta = H h/k with k = 5 MN m/rad, so that W h/2
/// theta is W h/(2 k) = 19.6 % of the base moment.
TEST(SecondOrderEffects, SolidsHaveNoneWithPDeltaEither) {
  const double total_weight = 2 * 10 * 1000 * 9.80665, k = 5e6;
  for (const bool p_delta : {false, true}) {
    std::string text = block_of_solids("");
    if (p_delta) text.replace(text.find("step = 0.02\n"), 12, "step = 0.02\np_delta = true\n");
    const BuiltCase built = built_of(text);
    EXPECT_NEAR(swaying_weight(built), total_weight / 2, 1e-3 * total_weight);
    const RunResult run = run_of(built);
    ASSERT_EQ(to_string(run.status), "completed") << run.reason;
    const SecondOrderMoment effects = effects_of(built, run);
    EXPECT_NEAR(effects.ratio(), total_weight * 10 / (2 * k), 0.02 * effects.ratio());
    EXPECT_TRUE(effects.counts());
    EXPECT_NE(effects.warning().find("make the part that stands on the base rigid with [[rigid]]"), std::string::npos);
    EXPECT_EQ(effects.warning().find("second-order effects of solids are left out, p_delta = true does not") == 0, p_delta)
        << effects.warning();
    EXPECT_EQ(warned(text, "p_delta computes no second-order effects of solids, and 100 % of"), p_delta);
  }
  // 1000 t whose centre is 20 m above the top of the block, on a node of that top: nearly all of the moment arises above the solids
  const std::string high = block_of_solids("",
                                           "[nodes]\nn = [0, 10]\n[[rigid]]\nnode = \"n\"\ngroup = \"block_top\"\nmass = 1e6\ninertia = "
                                           "1e6\ncentre = [0, 30]\n");
  const double of_block = 2 * 10 * 1000 * 5.0, of_mass = 1e6 * 30;  // kg m, about the foot
  EXPECT_NEAR(second_order_of_solids(built_of(high)), (of_block + 1e6 * 10) / (of_block + of_mass), 1e-3);
  std::string rigid = block_of_solids("", "[nodes]\nm = [0, 1]\n[[rigid]]\nnode = \"m\"\ngroup = \"block\"\n");
  rigid.replace(rigid.find("step = 0.02\n"), 12, "step = 0.02\np_delta = true\n");
  EXPECT_FALSE(warned(rigid, "p_delta computes no"));
}

/// A column on a base that is nearly rigid, pushed slowly by H at its top: the drift is H h^3/(3 E I) = 1e4 x 125/(3 x 4e9) = 0.104 mm and
/// the base moment H h.
TEST(SecondOrderEffects, OfARunWithASlowForce) {
  const std::string slow =
      "[[function]]\nname = \"slow\"\nshape = { type = \"ramp\", duration = 9 }\n[[load]]\nnode = \"top\"\nforce = [1e4, 0]\nfunction = "
      "\"slow\"\n";
  std::string text = tower(slow);
  text.replace(text.find("duration = 1\nstep = 0.01"), 24, "duration = 10\nstep = 0.01");
  const BuiltCase built = built_of(text);
  const RunResult run = run_of(built);
  ASSERT_EQ(to_string(run.status), "completed") << run.reason;
  const SecondOrderMoment effects = effects_of(built, run);
  const double turn = 1e4 * 5 / (1e9 * 2.25);  // rad: K_n times the second moment of area, 3^3/12
  EXPECT_NEAR(effects.base_moment, 5e4, 0.02 * 5e4);
  EXPECT_NEAR(effects.drift, 1e4 * 125 / (3 * 4e9) + 5 * turn, 0.04 * effects.drift) << "eleven points: 1 % less inertia";
  EXPECT_FALSE(effects.counts());
}

/// Eleven points, 70 % uplifted: 3.3 in contact. On constraints the edge of a rigid base has one point.
TEST(EdgeWarnings, FewPointsAndNoBound) {
  const BuiltCase soft = built_of(tower(shaken));
  const auto of = [](const BuiltCase& built, double open) {
    const RunResult run = reaching(built, 4e5, 0.01, open);
    return edge_warnings(built, numbers_of(built, run, nullptr));
  };
  EXPECT_TRUE(of(soft, 0.6).empty());
  ASSERT_EQ(of(soft, 0.7).size(), 1u);
  EXPECT_NE(of(soft, 0.7).front().find("3.3 of its 11 points"), std::string::npos) << of(soft, 0.7).front();
  EXPECT_TRUE(of(soft, 1).empty()) << "no contact at all";
  const BuiltCase rigid = built_of(tower(shaken, "", "law = \"unilateral\"\n"));
  EXPECT_TRUE(of(rigid, 0).empty());
  ASSERT_EQ(of(rigid, 0.3).size(), 1u);
  EXPECT_NE(of(rigid, 0.3).front().find("has no bound"), std::string::npos);
}

/// Impacts of constraints with stiffness damping: a portal on two footings, 608, 608, 662, 795, 945, 1098 kN of compression with steps from
/// 1 ms to 1/32 ms, which without the stiffness damping settle at 1.13 MN.
TEST(EdgeWarnings, SectionForcesOfDampedImpacts) {
  const std::string envelope = "[[output.beam_envelope]]\nbeam = \"column\"\n";
  const auto said = [&](const std::string& joint, double open, double beta, const std::string& more, const std::string& rule = "") {
    const BuiltCase built = built_of(rule + tower(shaken + more, "", joint));
    const RunResult run = reaching(built, 4e5, 0.01, open);
    VerdictNumbers numbers = numbers_of(built, run, nullptr);
    if (!more.empty()) numbers.beams.emplace_back();
    return damped_impacts(built, numbers, beta);
  };
  EXPECT_NE(said("law = \"unilateral\"\n", 0.3, 1.5e-3, envelope).find("beta = 0.0015 s"), std::string::npos);
  EXPECT_EQ(said("law = \"unilateral\"\n", 0.3, 0, envelope), "");
  EXPECT_EQ(said("law = \"unilateral\"\n", 0, 1.5e-3, envelope), "") << "it stays closed";
  EXPECT_EQ(said("law = \"unilateral\"\n", 0.3, 1.5e-3, ""), "") << "no section forces";
  EXPECT_EQ(said(law, 0.3, 1.5e-3, envelope), "") << "a joint that gives way";
  EXPECT_EQ(said("law = \"unilateral\"\n", 0.3, 1.5e-3, envelope, "impact = \"none\"\n"), "") << "no impact changes velocities";
}

/// A floor that only the uplifting run excites has no change, but an acceleration: 12.7 m/s2 where the bonded one has none.
TEST(ArisingFloors, AreSaidWithTheirAcceleration) {
  FloorRun floors;
  floors.floors.resize(2);
  floors.floors[0].name = "f1x", floors.floors[1].name = "f3y";
  FloorChange moved, arisen;
  moved.bands = {{{0, 5}, -0.1, 0.8, 1, 4, false}};
  arisen.bands = {{{0, 5}, 6283, 1, 6284, 12.7, true}};
  floors.beside = {{moved}, {arisen}};
  EXPECT_EQ(range_of_bands(floors), "-10 %");
  EXPECT_EQ(arising_floors(floors), "accelerations of f3y up to 12.7 m/s\u00b2 where the bonded model has none");
  floors.beside = {{moved}, {moved}};
  EXPECT_EQ(arising_floors(floors), "");
}

/// A table over the motions has a base shear where the base carries one, and none where a support does.
TEST(TableOfMotions, NoBaseShearWhereASupportCarriesIt) {
  const auto has_shear = [](const std::string& soil, bool held) {
    Tower changed;
    changed.held = held;
    std::deque<BuiltCase> built;
    built.push_back(built_of(tower(shaken, "", soil, changed)));
    RunSpec spec;
    spec.motion_label = "one";
    const std::vector<MotionTable> tables = motion_tables({spec}, built, {RunResult()});
    return std::ranges::find(tables.at(0).quantities, "shear", &MotionTable::Quantity::key) != tables.at(0).quantities.end();
  };
  EXPECT_FALSE(has_shear("law = { type = \"springs\", K_n = 1e9, tangential = \"none\" }\n", true));
  EXPECT_TRUE(has_shear(law, false));
}

/// Vertical shaking leaves a top motion of round-off, 1.7e-15 m: no fact, no motion beside the bonded run.
TEST(Noise, IsNotPrinted) {
  const BuiltCase built = built_of(tower(shaken));
  const RunResult run = reaching(built, 4e5, 1.7e-15), bonded = reaching(built, 4e5, 0);
  const Verdict verdict = judge(built, run, &bonded);
  for (const Verdict::Fact& fact : verdict.facts) EXPECT_NE(fact.label, "Top motion") << fact.value;
  for (const std::string& text : verdict.paragraphs) EXPECT_EQ(text.find("1.7"), std::string::npos) << text;
}

}  // namespace
}  // namespace uplift::doubtful_results_test
