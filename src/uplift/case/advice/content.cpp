#include "uplift/case/advice/content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/base/format.h"
#include "uplift/case/advice/step_suggestion.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/math/fourier.h"
#include "uplift/mesh/quality.h"

namespace uplift {
namespace {

constexpr double accepted_energy = 0.05;

}  // namespace

MeshReach lowest_reach(const Case& read) {
  MeshReach lowest;
  if (!read.mesh) return lowest;
  const CaseSolids materials(*read.input, *read.mesh);
  const std::vector<GroupQuality> qualities = quality_by_group(read.mesh->mesh);
  for (const CaseSolids::Solid& solid : materials.solids()) {
    const auto quality = std::ranges::find(qualities, solid.group(), &GroupQuality::name);
    if (quality == qualities.end() || !(solid.section.material.density > 0)) continue;
    const double reach = highest_frequency(*quality, solid.section.material.s_wave_speed(), nodes_per_wavelength);
    if (reach < lowest.frequency) lowest = {quality->name, reach};
  }
  return lowest;
}

double energy_above(const TimeFunction& function, int derivative, double duration, double frequency) {
  const double step = std::min(duration / 16, 0.05 / frequency);                              // ten samples a period of twice the frequency
  std::vector<double> values(fourier_length(2 * static_cast<std::size_t>(duration / step)));  // zeros behind it: it does not wrap around
  for (std::size_t i = 0; 2 * i < values.size(); ++i) values[i] = smooth_derivative_of(function, derivative, step * static_cast<double>(i));
  const auto transform = fourier(values);
  double all = 0, above = 0;
  for (std::size_t k = 0; k < transform.size(); ++k) {
    const double energy = std::norm(transform[k]);
    all += energy;
    if (static_cast<double>(k) > frequency * step * static_cast<double>(values.size())) above += energy;
  }
  return all > 0 ? above / all : 0;
}

void warn_content(const Case& read, const BuiltCase& built, std::vector<std::string>& said) {
  const double duration = dynamic_duration(built.plan);
  const MeshReach reach = lowest_reach(read);
  if (!(duration > 0) || !std::isfinite(reach.frequency)) return;
  double most = accepted_energy;
  const TimeLoad* worst = nullptr;
  for (const TimeLoad* time_load : varying_loads(built.model)) {
    const double above = energy_above(*time_load->function, static_cast<int>(time_load->order), duration, reach.frequency);
    if (above > most) most = above, worst = time_load;
  }
  if (worst)
    said.push_back(
        fmt::format("the cells of \"{}\" carry shear waves up to {} (ten nodes a wavelength), and {} of the energy of the load \"{}\" lies "
                    "above: refine the mesh there, or filter the motion",
                    reach.group, format_quantity(reach.frequency, "Hz"), percent(most), worst->name));
  double highest = 0;
  for (const FloorRequest& floor : built.plan.floors)
    if (!floor.frequencies.empty()) highest = std::max(highest, floor.frequencies.back());
  if (highest > reach.frequency)
    said.push_back(
        fmt::format("floor spectra go up to {}, but the cells of \"{}\" carry shear waves up to {} only (ten nodes a wavelength): above, "
                    "the spectra miss "
                    "what the soil transmits; refine the mesh there, or use the spectra up to this frequency",
                    format_quantity(highest, "Hz"), reach.group, format_quantity(reach.frequency, "Hz")));
}

}  // namespace uplift
