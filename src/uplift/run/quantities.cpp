#include "uplift/run/quantities.h"

#include <algorithm>

namespace uplift {

std::span<const InterfaceQuantity> interface_quantities() {
  using enum Request::Kind;
  using enum InterfaceQuantity::Needs;
  using View = InterfaceView;
  constexpr bool in_step = true, at_end = false;  // a mean over the step, or a number of its end
  // In space `shear`, `moment` and `rotation` are the lengths of their parts along (about) the two tangents. With radiation dashpots the
  // forces of an interface contain theirs; those of its law do not.
  static constexpr InterfaceQuantity table[] = {
      {axial, "axial", "N", in_step, 0, nothing, [](const View& view) { return &view.resultant.axial; }},
      {shear, "shear", "N", in_step, 0, nothing, [](const View& view) { return &view.resultant.shear; }},
      {moment, "moment", "N m", in_step, 0, nothing, [](const View& view) { return &view.resultant.moment; }},
      {rotation, "rotation", "rad", at_end, 2, nothing, [](const View& view) { return &view.rotation[0]; }},
      {rotation, "rotation", "rad", at_end, 3, nothing},
      {shear_1, "shear_1", "N", in_step, 3, nothing, [](const View& view) { return &view.resultant.shear_1; }},
      {shear_2, "shear_2", "N", in_step, 3, nothing, [](const View& view) { return &view.resultant.shear_2; }},
      {moment_1, "moment_1", "N m", in_step, 3, nothing, [](const View& view) { return &view.resultant.moment_1; }},
      {moment_2, "moment_2", "N m", in_step, 3, nothing, [](const View& view) { return &view.resultant.moment_2; }},
      {torsion, "torsion", "N m", in_step, 3, nothing, [](const View& view) { return &view.resultant.torsion; }},
      {rotation_1, "rotation_1", "rad", at_end, 3, nothing, [](const View& view) { return &view.rotation[0]; }},
      {rotation_2, "rotation_2", "rad", at_end, 3, nothing, [](const View& view) { return &view.rotation[1]; }},
      {settlement, "settlement", "m", at_end, 0, nothing, nullptr, &BasePose::settlement},
      {tilt_1, "tilt", "rad", at_end, 2, nothing, nullptr, &BasePose::tilt_1},
      {tilt_1, "tilt_1", "rad", at_end, 3, nothing, nullptr, &BasePose::tilt_1},
      {tilt_2, "tilt_2", "rad", at_end, 3, nothing, nullptr, &BasePose::tilt_2},
      {uplifted_ratio, "uplifted_ratio", "1", at_end, 0, nothing, [](const View& view) { return &view.open_area; }},
      {max_opening, "max_opening", "m", at_end, 0, nothing, [](const View& view) { return &view.max_opening; }},
      {max_pressure, "max_pressure", "Pa", in_step, 0, points, [](const View& view) { return &view.max_pressure; }},
      {law_axial, "law_axial", "N", in_step, 0, dashpots, [](const View& view) { return &view.in_law.axial; }},
      {law_shear, "law_shear", "N", in_step, 0, dashpots, [](const View& view) { return &view.in_law.shear; }},
      {law_moment, "law_moment", "N m", in_step, 0, dashpots, [](const View& view) { return &view.in_law.moment; }},
      {law_shear_1, "law_shear_1", "N", in_step, 3, dashpots, [](const View& view) { return &view.in_law.shear_1; }},
      {law_shear_2, "law_shear_2", "N", in_step, 3, dashpots, [](const View& view) { return &view.in_law.shear_2; }},
      {law_moment_1, "law_moment_1", "N m", in_step, 3, dashpots, [](const View& view) { return &view.in_law.moment_1; }},
      {law_moment_2, "law_moment_2", "N m", in_step, 3, dashpots, [](const View& view) { return &view.in_law.moment_2; }},
      {law_torsion, "law_torsion", "N m", in_step, 3, dashpots, [](const View& view) { return &view.in_law.torsion; }},
      {bearing_utilisation, "bearing_utilisation", "1", at_end, 0, bearing_strength,
       [](const View& view) { return &view.bearing_utilisation; }},
      {bearing_capacity, "bearing_capacity", "N", at_end, 0, growing_strength, [](const View& view) { return &view.bearing_capacity; }},
      {sliding_utilisation, "sliding_utilisation", "1", at_end, 0, friction, [](const View& view) { return &view.sliding_utilisation; }}};
  return table;
}

const InterfaceQuantity* find_interface_quantity(Request::Kind kind, int dimension) {
  for (const InterfaceQuantity& each : interface_quantities())
    if (each.kind == kind && (each.dimension == 0 || each.dimension == dimension)) return &each;
  return nullptr;
}

std::span<const EnergyQuantity> energy_quantities() {
  using enum Request::Kind;
  static constexpr EnergyQuantity table[] = {{kinetic, "kinetic", &Energies::kinetic},
                                             {strain, "strain", &Energies::strain},
                                             {stored, "stored", &Energies::stored},
                                             {interface_dissipated, "interface_dissipated", &Energies::interface_dissipated},
                                             {damping, "damping", &Energies::damping},
                                             {impact, "impact", &Energies::impact},
                                             {external, "external", &Energies::external},
                                             {residual, "residual", &Energies::residual},
                                             {plastic, "plastic", &Energies::plastic},
                                             {stop, "stop", &Energies::stop},
                                             {algorithmic, "algorithmic", &Energies::algorithmic},
                                             {filter, "filter", &Energies::filter}};
  static_assert(std::size(table) == sizeof(Energies) / sizeof(double) - 1);  // friction is a part of interface_dissipated
  return table;
}

const EnergyQuantity* find_energy_quantity(Request::Kind kind) {
  for (const EnergyQuantity& each : energy_quantities())
    if (each.kind == kind) return &each;
  return nullptr;
}

bool is_step_mean(Request::Kind kind) {
  using enum Request::Kind;
  if (kind == acceleration || kind == absolute_acceleration || kind == traction || kind == force) return true;
  return std::ranges::any_of(interface_quantities(), [&](const InterfaceQuantity& each) { return each.kind == kind && each.step_mean; });
}

}  // namespace uplift
