#include "uplift/case/schema/sections.h"

#include <algorithm>

#include "uplift/case/build/criteria.h"
#include "uplift/case/build/records.h"
#include "uplift/case/schema/analysis_sections.h"
#include "uplift/case/schema/interface_sections.h"
#include "uplift/case/schema/mesh_sections.h"
#include "uplift/case/schema/output_sections.h"
#include "uplift/case/schema/structure_sections.h"
#include "uplift/contact/impact/impact.h"
#include "uplift/contact/method.h"
#include "uplift/dynamics/scheme.h"
#include "uplift/laws/law.h"
#include "uplift/linear/solver.h"

namespace uplift {
namespace {

using Fields = std::vector<Field>;

const Section& variant_section() {
  static const Section s{
      "variant", "for `uplift compare`: the same case with another law, method, rule, scheme or step, or another case",
      Fields{
          text("name", "name of its runs"), text("label", "as shown").optional(),
          text("case",
               "file of another case that is run instead, with nothing of this one: the same structure on another model of the ground; its "
               "own variants are left out, and its floor spectra unless they are those of this case")
              .optional(),
          part("law", interface_behaviours, "law or cone of the interface").optional(),
          text("interface", "interface that takes the law; absent: all").optional(),
          part("method", contact_methods, "contact method").optional(), part("impact", impact_rules, "impact rule").optional(),
          part("scheme", schemes, "time integration of the dynamic stages").optional(),
          choice("traction", {"path", "end"}, "traction of the dynamic stages").optional(),
          number("step", "s", "time step of the dynamic stages").positive().optional(),
          choice("expected", {"completes", "may_fail"},
                 "may_fail: a failure is shown and marked, but does not fail the command; the run is not counted as sound")
              .standard("completes")}};
  return s;
}

const Section& sweep_section() {
  static const Section s{
      "stiffness_sweep", "energy error of a traction law against its stiffness, for both tractions",
      Fields{part("law", interface_behaviours, "the law; its stiffness is replaced"),
             text("parameter", "parameter of the law that is the stiffness").standard("K_n"),
             numbers("ratios", "1", "stiffness ratios k F_ii (largest of the points)"),
             flag("rigid_ground", "leave out the elastic bed: the swept joint is the only flexibility of the ground").standard(false),
             part("impact", impact_rules, "velocity correction with the traction at the end of the step").standard("none"),
             number("duration", "s", "duration of the dynamic stage; absent: that of the case").positive().optional()}};
  return s;
}

const Section& compare_section() {
  static const Section s{
      "compare", "how variants are compared",
      Fields{
          number("band", "1", "runs that passed all checks agree when they differ from their median by less").positive().standard(0.02),
          texts("agree_on", "columns whose peaks are compared; absent: every number of the verdict").optional(),
          tables("damping", damping_case_section(), "every variant is run with each of these"),
          tables("motion", compare_motion_section(), "further motions: every variant is run with each of these and with that of the case"),
          table("stiffness_sweep", sweep_section(), "a table of energy error against stiffness").optional()}};
  return s;
}

const Section& trust_section() {
  static const Section s{
      "trust", "for `uplift trust`: how far each choice of the computation is changed",
      Fields{number("stiffness_factor", "1",
                    "joints are computed this many times as stiff and as soft too; 1: not changed; absent: 10, and 2 for a footing on "
                    "fixed ground, whose joint is the soil itself: the factor is then what the stiffness of the soil is uncertain by")
                 .between(1, 1e6)
                 .optional(),
             integer("interior",
                     "stiffnesses between the case and each end that are computed too, in equal ratios; 0: only the ends are, and the "
                     "results say so")
                 .between(0, 1000)
                 .standard(0),
             number("mesh_factor", "1", "sizes of a made mesh are multiplied by this; 1: not changed").between(0.1, 1).standard(0.7),
             number("mesh_shift", "1", "the mesh around interface.cut is moved by this share of a cell, to both sides; 0: not moved")
                 .between(0, 0.45)
                 .standard(0.3),
             number("spectrum_band", "1", "a floor spectrum speaks up to the frequency where its runs differ by more than this share")
                 .positive()
                 .standard(0.1)}};
  return s;
}

const Section& origin_section() {
  static const Section s{"origin", "where values come from, shown with the results",
                         Fields{text("label", "for example \"paper\" or \"our choice\""),
                                texts("keys", "\"beam.column.E\", a whole table \"beam.column\", or \"*\" for all others"),
                                text("note", "source or reason").optional()}};
  return s;
}

const Section& figure_section() {
  static const Section s{"figure", "where a figure of the report comes from",
                         Fields{text("chart", "identifier of the figure"), text("origin", "for example \"paper, figure 5a\""),
                                text("caption", "replaces the caption").optional()}};
  return s;
}

}  // namespace

const Section& case_section() {
  static const Section s = [] {
    Section made{
        "case", "a case file",
        Fields{
            text("title", "title of the case"),
            text("description", "what it shows").optional(),
            flag("bonded", "run the model with bonded interfaces too, for comparison").standard(true),
            named("nodes", node_section(), "nodes: name = [x, y], or [x, y, z]"),
            table("mesh", mesh_section(), "mesh of solids, in the plane or in space").optional(),
            tables("tie", tie_section(), "sides of the mesh that move together"),
            tables("mass", mass_section(), "point masses"),
            tables("rigid", rigid_section(), "rigid bodies"),
            tables("support", support_section(), "supports"),
            tables("interface", interface_section(), "interfaces"),
            tables("foundation", foundation_section(), "foundations on one element of the ground"),
            table("gravity", gravity_section(), "weight").optional(),
            tables("function", function_section(), "functions of time"),
            tables("record", record_section(), "motions of the ground, recorded or generated"),
            tables("load", load_section(), "loads"),
            tables("motion", motion_section(), "prescribed motions"),
            tables("ground_acceleration", ground_section(), "ground acceleration"),
            tables("initial", initial_section(), "initial state"),
            table("damping", damping_section(), "damping").optional(),
            tables("stage", stage_section(), "stages, in order"),
            part("method", contact_methods, "contact method; absent: newton for traction laws, lagrange for cones").optional(),
            part("impact", impact_rules, "velocity correction on impact; absent: project_hold for constraints, none for traction laws")
                .optional(),
            part("solver", linear_solvers, "factorisation of the structure's matrices").standard("cholmod"),
            choice("interface_solver", {"automatic", "direct", "krylov"},
                   "linear problems of interfaces with more than twelve independent rows: one factor while the contact status stays, and "
                   "none from 300 unknown forces on (automatic), a factor every time (direct), conjugate residuals on the compliance "
                   "(krylov)")
                .standard("automatic"),
            text("reduced_model",
                 "file of a reduced model of this case, made by `uplift reduce`, with which dynamic stages are computed; absent: the whole "
                 "model")
                .optional(),
            table("energy", energy_section(), "energy gate"),
            table("limits", limits_section(), "limits"),
            table("output", output_section(), "output"),
            table("verdict", verdict_section(), "what the verdict is asked").optional(),
            tables("variant", variant_section(), "variants to compare"),
            table("compare", compare_section(), "comparison").optional(),
            table("trust", trust_section(), "trust bands"),
            tables("origin", origin_section(), "origin of values"),
            tables("figure", figure_section(), "origin of figures")}};
    // the order of the reference: solids and their faces, beams, masses, springs and dashpots
    const std::pair<ElementPlace, const char*> before[] = {
        {ElementPlace::cells, "tie"}, {ElementPlace::faces, "tie"}, {ElementPlace::lines, "mass"}, {ElementPlace::nodes, "rigid"}};
    for (const auto& [place, table] : before) {
      auto next = std::ranges::find(made.fields, table, &Field::name);
      for (const Section& element : element_sections(place))
        next = std::next(made.fields.insert(next, tables(element.name, element, element.meaning)));
    }
    return made;
  }();
  return s;
}

}  // namespace uplift
