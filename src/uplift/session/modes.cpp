#include <span>

#include "uplift/io/text/json_writer.h"
#include "uplift/model/builder.h"
#include "uplift/session/check.h"

namespace uplift {

double mass_share(const Model& model, const Sparse& mass, const Vector& full_shape, Dof direction) {
  Vector along = Vector::Zero(model.full_unknowns());
  for (Index node = 0; node < static_cast<Index>(model.nodes.size()); ++node) along[model.at(static_cast<int>(node), direction)] = 1;
  const Vector inertia = mass * along;
  const double total = along.dot(inertia), taken = full_shape.dot(inertia);
  return total > 0 ? taken * taken / total : 0;
}

namespace {

void write_modes(JsonWriter& json, const Model& model, const std::vector<Mode>& found) {
  const Sparse mass = assembled(model, &Local::mass);
  json.begin_array();
  for (const Mode& mode : found) {
    const Vector shape = model.expand(mode.shape);
    json.begin_object()
        .member("frequency", mode.frequency)
        .member("mass_share_x", mass_share(model, mass, shape, ux))
        .member("mass_share_y", mass_share(model, mass, shape, uy));
    if (model.space.dimension == 3) json.member("mass_share_z", mass_share(model, mass, shape, uz));
    json.key("shape").begin_object();
    for (std::size_t node = 0; node < model.nodes.size(); ++node)
      json.key(model.nodes[node].name)
          .numbers(std::span<const double>(shape.data() + model.space.unknowns() * static_cast<int>(node),
                                           static_cast<std::size_t>(model.space.unknowns())));
    json.end_object().end_object();
  }
  json.end_array();
}

}  // namespace

std::string modes_json(const LoadedCase& loaded, int count) {
  const BuiltCase built = build(loaded.read, runs_of_case(loaded.read).front());
  JsonWriter json(0, 2);
  json.begin_object().member("case", loaded.from.case_file).key("bonded");
  write_modes(json, built.at_rest(), bonded_modes(built.at_rest(), count));
  json.key("base_free");
  write_modes(json, built.at_rest(), base_free_modes(built.at_rest(), count));
  return json.end_object().take();
}

}  // namespace uplift
