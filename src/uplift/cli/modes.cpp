#include <fmt/format.h>

#include <cmath>

#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/io/text/json_writer.h"
#include "uplift/model/builder.h"

namespace uplift::cli {
namespace {

/// Share of the model's mass that moves with a mode in a direction: (phi^T M r)^2 / (r^T M r), phi^T M phi = 1.
double share(const Model& model, const Sparse& mass, const Vector& full_shape, Dof direction) {
  Vector along = Vector::Zero(model.full_unknowns());
  for (Index node = 0; node < static_cast<Index>(model.nodes.size()); ++node) along[model.at(static_cast<int>(node), direction)] = 1;
  const Vector inertia = mass * along;
  const double total = along.dot(inertia), taken = full_shape.dot(inertia);
  return total > 0 ? taken * taken / total : 0;
}

void print_modes(const Model& model, const std::vector<Mode>& found, std::string_view title) {
  const Sparse mass = assembled(model, &Local::mass);
  say(title);
  if (found.empty()) say("  none: a massless unknown has no stiffness");
  std::vector<std::vector<std::string>> rows{{"mode", "frequency [Hz]", "period [s]", "mass in x [%]", "mass in y [%]"}};
  if (model.space.dimension == 3) rows.front().emplace_back("mass in z [%]");
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Vector shape = model.reduction * found[i].shape;
    const double frequency = found[i].frequency;
    rows.push_back(
        {fmt::format("{}", i + 1), fmt::format("{:.6g}", frequency), frequency > 0 ? fmt::format("{:.6g}", 1 / frequency) : "rigid motion",
         fmt::format("{:.1f}", 100 * share(model, mass, shape, ux)), fmt::format("{:.1f}", 100 * share(model, mass, shape, uy))});
    if (model.space.dimension == 3) rows.back().push_back(fmt::format("{:.1f}", 100 * share(model, mass, shape, uz)));
  }
  if (rows.size() > 1) print_table(rows);
}

void write_modes(JsonWriter& json, const Model& model, const std::vector<Mode>& found) {
  const Sparse mass = assembled(model, &Local::mass);
  json.begin_array();
  for (const Mode& mode : found) {
    const Vector shape = model.reduction * mode.shape;
    json.begin_object()
        .member("frequency", mode.frequency)
        .member("mass_share_x", share(model, mass, shape, ux))
        .member("mass_share_y", share(model, mass, shape, uy));
    if (model.space.dimension == 3) json.member("mass_share_z", share(model, mass, shape, uz));
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

int modes(const Options& options, int count) {
  const Loaded loaded = load(options);
  const BuiltCase built = build(loaded.read, runs_of_case(loaded.read).front());
  const std::vector<Mode> bonded = bonded_modes(built.at_rest(), count),
                          base_free = uplift::modes(built.at_rest().stiffness, built.at_rest().mass, count);
  if (options.json) {
    JsonWriter json(0, 2);
    json.begin_object().member("case", loaded.from.case_file).key("bonded");
    write_modes(json, built.at_rest(), bonded);
    json.key("base_free");
    write_modes(json, built.at_rest(), base_free);
    json.end_object();
    say(json.take());
    return Exit::done;
  }
  print_modes(built.at_rest(), bonded, "interfaces closed and bonded");
  print_modes(built.at_rest(), base_free, "\nbase free (interfaces open)");
  say("\nmode shapes: uplift modes --json");
  return Exit::done;
}

}  // namespace uplift::cli
