#include "uplift/io/results/forces_json.h"

#include <utility>

namespace uplift {
namespace {

std::string_view unit_of(const std::string& component) {
  return component.starts_with("moment") || component == "torsion" ? "N m" : "N";
}

void write_component(ResultWriter& out, const BeamEnvelope& envelope, std::size_t component) {
  const std::string& name = envelope.components[component];
  out.when(true).object(name, "range of this section force over all steps, at every section", [&] {
    const std::string_view unit = unit_of(name);
    out.unit(unit);
    const auto write = [&](const char* key, double ForceRange::*member, std::string_view of, const char* meaning) {
      std::vector<double> values;
      for (std::size_t s = 0; s < envelope.sections.size(); ++s) values.push_back(envelope.at(s, component).*member);
      out.numbers(key, values, of, meaning);
    };
    write("max", &ForceRange::most, unit, "largest value");
    write("max_time", &ForceRange::most_time, "s", "time of the largest value");
    write("min", &ForceRange::least, unit, "smallest value");
    write("min_time", &ForceRange::least_time, "s", "time of the smallest value");
  });
}

void write_sum(ResultWriter& out, const char* key, const char* meaning, const Equilibrium::Sum& sum) {
  const auto three = [](const Vec3& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
  out.object(key, meaning, [&] {
    out.numbers("force", three(sum.force), "N", "force, components x, y and z");
    out.numbers("moment", three(sum.moment), "N m", "moment about the centre of the nodes, components x, y and z");
  });
}

}  // namespace

void write_envelopes(ResultWriter& out, const std::vector<BeamEnvelope>& envelopes, int up) {
  out.list("beam_envelopes", "section forces along the beams of [[output.beam_envelope]]", envelopes, [&](const BeamEnvelope& given) {
    BeamEnvelope envelope = given;
    if (out.is_schema()) envelope.components = {"axial", "shear_y", "shear_z", "torsion", "moment_y", "moment_z", "shear", "moment"};
    out.text("beam", envelope.beam, "name of the beam");
    std::vector<double> along, elevation;
    for (const EnvelopeRequest::Section& section : envelope.sections)
      along.push_back(section.along), elevation.push_back(section.position[up]);
    out.object("along", "positions of the sections along the beam", [&] {
      out.unit("m");
      out.numbers("value", along, "m", "distances from the beginning of the beam");
    });
    out.object("elevation", "elevations of the sections", [&] {
      out.unit("m");
      out.numbers("value", elevation, "m", "coordinates along the upward axis");
    });
    for (std::size_t k = 0; k < envelope.components.size(); ++k) write_component(out, envelope, k);
  });
}

void write_equilibrium(ResultWriter& out, const Equilibrium& equilibrium) {
  out.object("equilibrium", "equilibrium of the whole model: forces that act on the structure, which add up to zero", [&] {
    out.number("largest_relative_residual", equilibrium.residual, "1", "largest residual, relative to the largest of the other sums");
    out.number("time", equilibrium.time, "s", "time of that residual");
    out.constant("unit_of_forces", "N", "unit of the forces");
    out.constant("unit_of_moments", "N m", "unit of the moments");
    out.list("instants", "instants that were examined", equilibrium.instants, [&](const Equilibrium::Instant& at) {
      out.number("time", at.time, "s", "time");
      write_sum(out, "inertia", "inertia forces", at.inertia);
      write_sum(out, "damping", "damping forces, absorbing boundaries included", at.damping);
      write_sum(out, "internal", "springs to the ground and other parts whose internal forces have a resultant", at.internal);
      write_sum(out, "interfaces", "interfaces whose sides are at a distance from each other", at.joint);
      write_sum(out, "second_order", "second-order forces (P-Delta)", at.second_order);
      write_sum(out, "applied", "loads, gravity, ground acceleration and waves", at.applied);
      write_sum(out, "reactions", "forces of supports, prescribed motions and ties", at.reactions);
      write_sum(out, "residual", "sum of all forces", at.residual);
    });
  });
}

}  // namespace uplift
