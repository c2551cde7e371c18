#include "uplift/case/schema/sections.h"

#include <algorithm>

#include "uplift/case/build/criteria.h"
#include "uplift/case/build/records.h"
#include "uplift/case/schema/interface_sections.h"
#include "uplift/case/schema/mesh_sections.h"
#include "uplift/case/schema/structure_sections.h"
#include "uplift/contact/impact/impact.h"
#include "uplift/contact/method.h"
#include "uplift/dynamics/scheme.h"
#include "uplift/laws/law.h"
#include "uplift/linear/solver.h"

namespace uplift {
namespace {

using Fields = std::vector<Field>;

// ---- what is computed ----

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

const Section& energy_section() {
  static const Section s{"energy", "the energy balance as a gate",
                         Fields{number("created_limit", "1", "a run that creates more energy than this share of the external work fails")
                                    .positive()
                                    .standard(0.01),
                                flag("stop_at_limit", "stop such a run at once instead of at the end").standard(false)}};
  return s;
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

const Section& history_section() {
  static const Section s{
      "history", "a column of the output: of a node, a group, an interface or one of its points, a beam, or a storey",
      Fields{text("name", "name of the column; absent: made from the rest").optional(), text("node", "node").optional(),
             vector("at", "m", "instead of node: the node nearest to this place").optional(), text("interface", "interface").optional(),
             integer("point", "point of the interface, from 1").between(1, 1000000).optional(),
             text("beam", "beam whose section force is wanted, at position or at").optional(),
             number("position", "m", "distance of the section from the first node of the beam").nonnegative().optional(),
             text("group", "group of the mesh whose reactions are summed").optional(),
             number("level", "m", "height of a horizontal cut through all beams, for the storey shear").optional(),
             text("below", "for the drift of node: the node below, whose displacement is subtracted").optional(),
             text("quantity",
                  "node: ux uy rz, vx vy vrz, ax ay arz, and the absolute accelerations abs_ax abs_ay, which are others than ax ay under a "
                  "ground acceleration; interface: axial shear moment rotation uplifted_ratio max_opening max_pressure, and "
                  "settlement tilt of the upper side (in space tilt_1 tilt_2, about x and y); of a foundation, which has no pressure, "
                  "bearing_utilisation (with V_s), bearing_capacity (with V_u > V_s) and sliding_utilisation (with friction_angle), "
                  "and with radiation dashpots, whose forces axial, shear and moment contain, law_axial law_shear law_moment without them; "
                  "point: opening slip traction shear_traction mean_traction mean_shear_traction (tractions of a foundation are forces). "
                  "In space: all three axes; also shear_1 "
                  "shear_2 moment_1 moment_2 torsion (also with law_) rotation_1 rotation_2, and slip_1 slip_2 ... of a point, along and "
                  "about x and y under a level base, also of a footing with an azimuth. beam: axial "
                  "shear moment, in "
                  "space also shear_y shear_z torsion moment_y moment_z; level: storey_shear, in space storey_shear_x storey_shear_y; node "
                  "and below: drift_x drift_ratio_x (drift_y ...); node or group: reaction_x reaction_y reaction_moment (in space "
                  "reaction_mx ...) of supports and prescribed motions, tie_x ... of ties and rigid bodies. Forces are those that the time "
                  "scheme balances: with the path-averaged traction the mean over the step that ends at the time of the row")}};
  return s;
}

const Section& envelope_section() {
  static const Section s{
      "beam_envelope",
      "largest and smallest section forces along a beam over all steps, with their times, compared with those of the bonded run",
      Fields{text("beam", "name of the beam"),
             integer("sections", "least number of sections along each line of the beam, besides its beginning")
                 .between(1, 10000)
                 .standard(20.0)}};
  return s;
}

const Section& floor_range_section() {
  static const Section s{"range", "frequencies equally spaced in their logarithm",
                         Fields{number("from", "Hz", "lowest").positive(), number("to", "Hz", "highest").positive(),
                                integer("count", "how many").between(2, 100000).standard(300)}};
  return s;
}

const Section& floor_section() {
  static const Section s{
      "floor_spectrum", "response spectra (pseudo-acceleration) of a floor's absolute acceleration, of every run and beside the bonded one",
      Fields{text("name", "name of the floor, as shown"), text("node", "node").optional(),
             vector("at", "m", "instead of node: the node nearest to this place").optional(),
             vector("direction", "1", "direction of the acceleration; its length means nothing"),
             numbers("damping", "1", "damping ratios of the equipment; absent: 0.02 and 0.05").optional(),
             numbers("frequencies", "Hz", "frequencies, ascending; absent: the 75 of Regulatory Guide 1.122, 0.2 to 34 Hz").optional(),
             table("range", floor_range_section(), "instead of frequencies").optional(),
             number("broadening", "1", "peaks are broadened by this share to either side, with parallel sides; 0: not at all")
                 .between(0, 0.5)
                 .standard(0.15)}};
  return s;
}

const Section& fields_section() {
  static const Section s{
      "fields",
      "fields on the mesh, in the folder fields/ of the results, for ParaView: every n-th step of the dynamic stages, the moments that "
      "matter, or both, and the end of every stage; without every and events about a hundred moments. The interfaces are a block of their "
      "own, with opening, slip, traction, pressure and status (0 open, 1 closed, 2 slipping)",
      Fields{choice("format", {"vtu", "xdmf"},
                    "vtu: a file for each moment and block; xdmf: one HDF5 file for all. Absent: vtu up to 200 MB, else xdmf")
                 .optional(),
             integer("every", "every n-th step").between(1, 1000000000).optional(),
             flag("events", "first uplift, largest gap, largest pressure").standard(false),
             texts("quantities",
                   "any of displacement, velocity, acceleration, stress (of solids), what the laws of solids put out (drucker_prager: "
                   "plastic_strain), section_forces (in the middle of the lines of beams); absent: all")
                 .optional(),
             texts("groups", "groups with a [[solid]] or a [[beam]]; absent: all").optional(),
             choice("precision", {"float32", "float64"}, "how values are stored: 7 or 16 digits").standard("float32"),
             flag("variants", "of the runs of `uplift compare` too").standard(false)}};
  return s;
}

const Section& output_section() {
  static const Section s{
      "output", "what is written",
      Fields{
          integer("every", "record every n-th step").between(1, 1000000000).standard(1.0),
          flag("automatic", "motion of the top and of the base, and the resultants of every interface").standard(true),
          flag("energies", "all energies").standard(true),
          integer("frames", "pictures of the animation; 0: none").between(0, 5000).standard(240.0),
          tables("history", history_section(), "further columns"), tables("floor_spectrum", floor_section(), "floor spectra"),
          tables("beam_envelope", envelope_section(), "envelopes of section forces"),
          numbers("floor_bands", "Hz",
                  "frequencies that part the bands in which floor spectra are compared with those of the bonded run; absent: 2, 5, 10, 20")
              .optional(),
          number("checkpoint", "s",
                 "`uplift run` and `uplift compare` keep the state of a run after this much time on the clock, from which `uplift resume` "
                 "goes on; absent: never")
              .positive()
              .optional(),
          table("fields", fields_section(), "fields on the mesh; absent: none").optional()}};
  return s;
}

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
