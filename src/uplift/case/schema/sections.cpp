#include "uplift/case/schema/sections.h"

#include <algorithm>

#include "uplift/case/schema/analysis_sections.h"
#include "uplift/case/schema/comparison_sections.h"
#include "uplift/case/schema/interface_sections.h"
#include "uplift/case/schema/mesh_sections.h"
#include "uplift/case/schema/output_sections.h"
#include "uplift/case/schema/record_sections.h"
#include "uplift/case/schema/structure_sections.h"
#include "uplift/case/schema/verdict_sections.h"
#include "uplift/contact/impact/impact.h"
#include "uplift/contact/method.h"
#include "uplift/dynamics/scheme.h"
#include "uplift/laws/law.h"
#include "uplift/linear/solver.h"

namespace uplift {
namespace {

using Fields = std::vector<Field>;

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
