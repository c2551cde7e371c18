#include "uplift/case/schema/output_sections.h"

#include <fmt/format.h>

#include "uplift/motion/spectrum.h"

namespace uplift {
namespace {

using Fields = std::vector<Field>;

const Section& history_section() {
  static const Section s{
      "history", "a column of the output: of a node, a group, an interface or one of its points, a beam, or a storey",
      Fields{
          text("name", "name of the column; absent: made from the rest").optional(), text("node", "node").optional(),
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
               "about x and y under a level base, also of a footing or a foundation with an azimuth; but the point of a foundation slips "
               "along its width and its length. beam: axial shear moment, in "
               "space also shear_y shear_z torsion moment_y moment_z; level: storey_shear, in space storey_shear_x storey_shear_y; node "
               "and below: drift_x drift_ratio_x (drift_y ...); node or group: reaction_x reaction_y reaction_moment (in space "
               "reaction_mx ...) of supports and prescribed motions, tie_x ... of ties and rigid bodies. Forces are those that the time "
               "scheme balances: with the path-averaged traction the mean over the step that ends at the time of the row")}};
  return s;
}

CaseHistory case_history(const Values& table, Space space) {
  return {{{&table}, name_if(table, "node"), vector_if(table, "at", space)},
          name_if(table, "name"),
          name_if(table, "interface"),
          name_if(table, "beam"),
          name_if(table, "group"),
          name_if(table, "below"),
          table.has("point") ? std::optional(table.integer("point")) : std::nullopt,
          number_if(table, "position"),
          number_if(table, "level"),
          name_used(table, "quantity")};
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

CaseEnvelope case_envelope(const Values& table) {
  return {{&table}, name_used(table, "beam"), table.integer("sections")};
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

/// Frequencies [Hz].
std::vector<double> ascending(const Values& table, std::string_view key) {
  const std::vector<double>& values = table.numbers(key);
  if (values.empty()) fail(table, key, "at least one frequency", "none");
  double before = 0;
  for (const double value : values) {
    if (!(value > before)) fail(table, key, "frequencies > 0 Hz in ascending order", fmt::format("{:g} Hz after {:g} Hz", value, before));
    before = value;
  }
  return values;
}

std::vector<double> frequencies_of(const Values& floor) {
  const Values* range = table_if(floor, "range");
  if (floor.given("frequencies") && range) fail(floor, "range", "frequencies or range", "both");
  if (range) {
    const double from = range->number("from"), to = range->number("to");
    if (!(to > from)) fail(*range, "to", fmt::format("a frequency above {:g} Hz", from), fmt::format("{:g} Hz", to));
    return log_spaced(from, to, range->integer("count"));
  }
  if (!floor.given("frequencies")) return rg_1_122_frequencies();
  return ascending(floor, "frequencies");
}

std::vector<double> dampings_of(const Values& floor) {
  if (!floor.given("damping")) return {0.02, 0.05};
  const std::vector<double>& dampings = floor.numbers("damping");
  if (dampings.empty()) fail(floor, "damping", "at least one damping ratio", "none");
  for (const double damping : dampings)
    if (!(damping >= 0 && damping < 1)) fail(floor, "damping", "damping ratios from 0, below 1", fmt::format("{:g}", damping));
  return dampings;
}

CaseFloor case_floor(const Values& table, Space space) {
  const Vec3 direction = vector_of(table, "direction", space);
  if (!(direction.norm() > 0)) fail(table, "direction", "a direction", "zero");
  return {{{&table}, name_if(table, "node"), vector_if(table, "at", space)},
          name_used(table, "name"),
          direction / direction.norm(),
          dampings_of(table),
          frequencies_of(table),
          table.number("broadening")};
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

CaseFields case_fields(const Values& table) {
  using enum CaseFields::Format;
  CaseFields fields{
      {&table}, {}, {}, table.flag("events"), table.texts("quantities"), {}, table.text("precision") == "float32", table.flag("variants")};
  if (table.has("format")) fields.format = table.text("format") == "vtu" ? vtu : xdmf;
  if (table.has("every")) fields.every = table.integer("every");
  if (table.has("groups")) fields.groups = table.texts("groups");
  return fields;
}

}  // namespace

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

CaseOutput case_output(const Values& table, Space space) {
  CaseOutput output;
  output.table = &table;
  output.every = table.integer("every");
  output.automatic = table.flag("automatic");
  output.energies = table.flag("energies");
  output.frames = table.integer("frames");
  for (const Values& each : table.tables("history")) output.histories.push_back(case_history(each, space));
  for (const Values& each : table.tables("floor_spectrum")) output.floors.push_back(case_floor(each, space));
  for (const Values& each : table.tables("beam_envelope")) output.envelopes.push_back(case_envelope(each));
  output.floor_bands = table.given("floor_bands") ? ascending(table, "floor_bands") : std::vector<double>{2, 5, 10, 20};
  output.checkpoint = number_if(table, "checkpoint");
  if (const Values* fields = table_if(table, "fields")) output.fields = case_fields(*fields);
  return output;
}

}  // namespace uplift
