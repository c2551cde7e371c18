#include "uplift/case/schema/analysis_sections.h"

#include <fmt/format.h>

#include <numbers>

#include "uplift/dynamics/scheme.h"

namespace uplift {
namespace {

using Fields = std::vector<Field>;

const Section& rayleigh_section() {
  static const Section s{
      "rayleigh", "a damping ratio wanted at a frequency",
      Fields{number("frequency", "Hz", "frequency").positive(), number("ratio", "1", "ratio to the critical damping").between(0, 1)}};
  return s;
}

Fields damping_fields() {
  return {tables("rayleigh", rayleigh_section(),
                 "one pair: stiffness-proportional damping; two pairs: Rayleigh damping with these ratios at these frequencies"),
          number("alpha", "1/s", "mass-proportional damping factor").nonnegative().standard(0.0),
          number("beta", "s", "stiffness-proportional damping factor").nonnegative().standard(0.0),
          numbers("modal", "1", "damping ratios of the first modes of the bonded model").optional(),
          integer("modes", "number of damped modes; the last ratio is repeated").between(0, 100000).standard(0.0)};
}

BulkDamping bulk_damping(const Values& damping) {
  BulkDamping made{damping.number("alpha"), damping.number("beta"), damping.numbers("modal"), damping.integer("modes")};
  if (made.modal_count == 0) made.modal_count = static_cast<int>(made.modal.size());
  const std::vector<Values>& pairs = damping.tables("rayleigh");
  if (pairs.size() > 2) fail(damping, "rayleigh", "one or two pairs of frequency and ratio", fmt::format("{}", pairs.size()));
  if (!pairs.empty() && (made.alpha > 0 || made.beta > 0)) fail(damping, "rayleigh", "either rayleigh or alpha and beta", "both");
  // ratio(w) = alpha/(2 w) + beta w/2
  const auto omega = [](const Values& pair) { return 2 * std::numbers::pi * pair.number("frequency"); };
  if (pairs.size() == 1) made.beta = 2 * pairs[0].number("ratio") / omega(pairs[0]);
  if (pairs.size() == 2) {
    const double w1 = omega(pairs[0]), w2 = omega(pairs[1]), r1 = pairs[0].number("ratio"), r2 = pairs[1].number("ratio");
    if (w1 == w2)
      fail(pairs[1], "frequency", "a frequency that differs from the first", fmt::format("{} Hz again", pairs[1].number("frequency")));
    made.beta = 2 * (r2 * w2 - r1 * w1) / (w2 * w2 - w1 * w1);
    made.alpha = 2 * w1 * r1 - made.beta * w1 * w1;
    if (made.alpha < 0 || made.beta < 0)
      fail(damping, "rayleigh", "two pairs that give no negative factor",
           fmt::format("alpha = {:.4g} 1/s, beta = {:.4g} s", made.alpha, made.beta));
  }
  return made;
}

}  // namespace

const Section& damping_section() {
  static const Section s{
      "damping",
      "damping of the structure, none across an interface; mass-proportional and modal damping also act on rocking and on free flight",
      damping_fields()};
  return s;
}

const Section& damping_case_section() {
  static const Section s = [] {
    Section made{"damping", "one damping with which all variants are run; without any value: undamped", damping_fields()};
    made.fields.insert(made.fields.begin(), {text("name", "name, part of the names of the runs"), text("label", "as shown").optional()});
    return made;
  }();
  return s;
}

CaseDamping case_damping(const Values& table) {
  CaseDamping damping{{{&table}, {}, {}}, {}, bulk_damping(table)};
  if (table.section() == &damping_case_section()) static_cast<CaseNamed&>(damping) = case_named(table);
  for (const double ratio : table.numbers("modal")) damping.ratios.push_back({{&table}, "modal", ratio});
  for (const Values& pair : table.tables("rayleigh")) damping.ratios.push_back({{&pair}, "ratio", pair.number("ratio")});
  return damping;
}

const Section& stage_section() {
  static const Section s{
      "stage", "a stage of the analysis; displacements and interface states are handed over to the next one",
      Fields{choice("type", {"static", "dynamic"},
                    "static: weight, constant loads and prescribed motions, in load steps; dynamic: everything"),
             integer("steps",
                     "static: number of equal load steps, each of which is recorded (histories.csv where all stages are "
                     "static, else load_steps.csv)")
                 .between(1, 1000000)
                 .standard(10.0),
             number("duration", "s", "dynamic: duration").positive().optional(),
             number("step", "s", "dynamic: time step").positive().optional(),
             part("scheme", schemes, "dynamic: time integration").standard("average_acceleration"),
             choice("traction", {"path", "end"},
                    "traction laws: path-averaged traction (closes the energy balance; average_acceleration only, other "
                    "schemes take \"end\"), or "
                    "that at the end of the step")
                 .standard("path"),
             flag("p_delta",
                  "second order: geometric stiffness of the preceding static state, a static stage's own at the end of its "
                  "load steps; it then ends in the equilibrium of second order, one more row of the load steps")
                 .standard(false),
             integer("halvings", "a step that fails is halved at most so often").between(0, 30).standard(8.0)}};
  return s;
}

CaseStage case_stage(const Values& table) {
  return {{&table},
          table.text("type") == "static",
          table.integer("steps"),
          number_if(table, "duration"),
          number_if(table, "step"),
          &table.part("scheme"),
          table.text("traction") == "path",
          table.given("traction"),
          table.flag("p_delta"),
          table.integer("halvings")};
}

const Section& energy_section() {
  static const Section s{"energy", "the energy balance as a gate",
                         Fields{number("created_limit", "1", "a run that creates more energy than this share of the external work fails")
                                    .positive()
                                    .standard(0.01),
                                flag("stop_at_limit", "stop such a run at once instead of at the end").standard(false)}};
  return s;
}

CaseEnergy case_energy(const Values& table) {
  return {table.number("created_limit"), table.flag("stop_at_limit")};
}

const Section& limits_section() {
  static const Section s{
      "limits", "limits of the small-displacement model",
      Fields{number("rotation", "rad",
                    "a body that turns more, or a surface whose sides turn more against each other, is overturned: the run ends")
                 .positive()
                 .standard(0.15),
             number("separation", "m",
                    "an interface that is open everywhere by more than this beyond its initial gap is separated: the run ends. Absent: "
                    "rotation times the largest distance between points of the interfaces (of nodes, where there is one point), the gap "
                    "at the toe of a base of that width when it turns by the limit")
                 .positive()
                 .optional(),
             number("gap_tolerance", "m",
                    "a gap larger than this counts as uplifted. Absent: 1e-10 of the largest distance between points of the interfaces (of "
                    "nodes, where there is one point)")
                 .positive()
                 .optional()}};
  return s;
}

CaseLimits case_limits(const Values& table) {
  return {table.number("rotation"), number_if(table, "separation"), number_if(table, "gap_tolerance")};
}

}  // namespace uplift
