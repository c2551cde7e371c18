#include <fmt/format.h>

#include <cmath>

#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/model/builder.h"
#include "uplift/session/check.h"

namespace uplift::cli {
namespace {

void print_modes(const Model& model, const std::vector<Mode>& found, std::string_view title) {
  const Sparse mass = assembled(model, &Local::mass);
  say(title);
  if (found.empty()) say("  none: a massless unknown has no stiffness");
  std::vector<std::vector<std::string>> rows{{"mode", "frequency [Hz]", "period [s]", "mass in x [%]", "mass in y [%]"}};
  if (model.space.dimension == 3) rows.front().emplace_back("mass in z [%]");
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Vector shape = model.expand(found[i].shape);
    const double frequency = found[i].frequency;
    rows.push_back(
        {fmt::format("{}", i + 1), fmt::format("{:.6g}", frequency), frequency > 0 ? fmt::format("{:.6g}", 1 / frequency) : "rigid motion",
         fmt::format("{:.1f}", 100 * mass_share(model, mass, shape, ux)), fmt::format("{:.1f}", 100 * mass_share(model, mass, shape, uy))});
    if (model.space.dimension == 3) rows.back().push_back(fmt::format("{:.1f}", 100 * mass_share(model, mass, shape, uz)));
  }
  if (rows.size() > 1) print_table(rows);
}

}  // namespace

int modes(const Options& options, int count) {
  const LoadedCase loaded = load(options);
  if (options.json) {
    say(modes_json(loaded, count));
    return Exit::done;
  }
  const BuiltCase built = build(loaded.read, runs_of_case(loaded.read).front());
  const Model& model = built.at_rest();
  const std::vector<Mode> bonded = bonded_modes(model, count);
  if (model.interfaces.empty()) {
    print_modes(model, bonded, "modes of the model, which has no interface");
  } else {
    print_modes(model, bonded, "interfaces closed and bonded");
    print_modes(model, base_free_modes(model, count), "\nbase free (interfaces open)");
  }
  say("\nmode shapes: uplift modes --json");
  return Exit::done;
}

}  // namespace uplift::cli
