#include "uplift/io/results/forces_json.h"

#include <utility>

namespace uplift {
namespace {

std::string_view unit_of(const std::string& component) {
  return component.starts_with("moment") || component == "torsion" ? "N m" : "N";
}

void write_sum(JsonWriter& json, const char* key, const Equilibrium::Sum& sum) {
  const auto three = [](const Vec3& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
  json.key(key).begin_object().key("force").numbers(three(sum.force)).key("moment").numbers(three(sum.moment)).end_object();
}

}  // namespace

void write_envelopes(JsonWriter& json, const std::vector<BeamEnvelope>& envelopes) {
  json.begin_array();
  for (const BeamEnvelope& envelope : envelopes) {
    json.begin_object().member("beam", envelope.beam);
    std::vector<double> along;
    for (const EnvelopeRequest::Section& section : envelope.sections) along.push_back(section.along);
    json.key("along").begin_object().member("unit", "m").key("value").numbers(along).end_object();
    for (std::size_t k = 0; k < envelope.components.size(); ++k) {
      json.key(envelope.components[k]).begin_object().member("unit", unit_of(envelope.components[k]));
      for (const auto& [name, member] : {std::pair{"max", &ForceRange::most},
                                         {"max_time", &ForceRange::most_time},
                                         {"min", &ForceRange::least},
                                         {"min_time", &ForceRange::least_time}}) {
        std::vector<double> values;
        for (std::size_t s = 0; s < envelope.sections.size(); ++s) values.push_back(envelope.at(s, k).*member);
        json.key(name).numbers(values);
      }
      json.end_object();
    }
    json.end_object();
  }
  json.end_array();
}

void write_equilibrium(JsonWriter& json, const Equilibrium& equilibrium) {
  json.begin_object().member("largest_relative_residual", equilibrium.residual).member("time", equilibrium.time);
  json.member("unit_of_forces", "N").member("unit_of_moments", "N m").key("instants").begin_array();
  for (const Equilibrium::Instant& at : equilibrium.instants) {
    json.begin_object().member("time", at.time);
    write_sum(json, "inertia", at.inertia);
    write_sum(json, "damping", at.damping);
    write_sum(json, "internal", at.internal);
    write_sum(json, "interfaces", at.joint);
    write_sum(json, "second_order", at.second_order);
    write_sum(json, "applied", at.applied);
    write_sum(json, "reactions", at.reactions);
    write_sum(json, "residual", at.residual);
    json.end_object();
  }
  json.end_array().end_object();
}

}  // namespace uplift
