#include "uplift/laws/macro_landing.h"

#include <algorithm>
#include <cmath>

namespace uplift {

MacroLanding::MacroLanding(const MacroUplift& uplift, const MacroSurfaces& surfaces, const MacroVector& trial, double settlement)
    : uplift_(uplift), surfaces_(surfaces), trial_(trial), settlement_(settlement) {
  const MacroElasticity& ground = uplift.elasticity();
  toe_[macro_n] = 1;
  const double turned = std::hypot(trial[macro_m1], trial[macro_m2]);
  for (int i = 0; i < 2; ++i) {
    const double theta = trial[macro_m1 + i];
    if (theta != 0) toe_[macro_m1 + i] = 0.5 * ground.length[i] * (ground.disc ? theta / turned : theta < 0 ? -1 : 1);
  }
  const MacroStrength& strength = surfaces.strength();
  constexpr double unlimited = 1e6;
  largest_shear_ = strength.power_law ? unlimited : 1;
  if (surfaces.has_sliding() && !(strength.cohesion > 0)) largest_shear_ = std::min(strength.friction, largest_shear_);
  MacroVector force = toe_;
  const double moved = std::hypot(trial[macro_h1], trial[macro_h2]);
  if (moved > 0) force.segment<2>(macro_h1) = trial.segment<2>(macro_h1) / moved;
  flow_ = surfaces.bearing_flow(force, strength.service).direction;
  follow_flow();
}

/// The multiplier is the root of a function of straight pieces: each axis that comes to lie flat begins a new one.
void MacroLanding::follow_flow() {
  for (int pass = 0; pass < 3; ++pass) {
    most_ = toe_.dot(trial_) / toe_.dot(flow_);
    int flat = -1;
    for (int i = macro_m1; i <= macro_m2; ++i)
      if (toe_[i] != 0 && trial_[i] / flow_[i] < most_ && (flat < 0 || trial_[i] / flow_[i] < trial_[flat] / flow_[flat])) flat = i;
    if (flat < 0) break;
    toe_[flat] = 0;
    if (uplift_.elasticity().disc) toe_.tail<2>().setZero();
  }
}

/// So far along the flow: a rotation ends where the axis lies flat. Next to no N leaves next to no shear.
MacroVector MacroLanding::sunk(double multiplier) const {
  MacroVector e = trial_ - multiplier * flow_;
  e.segment<2>(macro_h1).setZero();
  for (int i = macro_m1; i <= macro_m2; ++i)
    if (e[i] * trial_[i] < 0) e[i] = 0;
  return e;
}

/// H/N: the flow of the shear has taken all of its displacement, or the shear is the largest and the footing slides.
double MacroLanding::shear_share(double multiplier) const {
  const double flow = std::hypot(flow_[macro_h1], flow_[macro_h2]), u = std::hypot(trial_[macro_h1], trial_[macro_h2]);
  return u < largest_shear_ * multiplier * flow ? u / (multiplier * flow) : u > 0 ? largest_shear_ : 0;
}

/// 2 M/(N D) of an axis that lies flat: the flow of its moment has taken all of its rotation. 0 for other axes.
double MacroLanding::flat_moment(double multiplier, int axis) const {
  const double flow = flow_[macro_m1 + axis], theta = trial_[macro_m1 + axis];
  return multiplier * std::abs(flow) > std::abs(theta) ? theta / (multiplier * std::abs(flow)) : 0;
}

/// Surfaces in powers bear every contact as N vanishes (eq M20).
bool MacroLanding::beyond(double multiplier) const {
  if (surfaces_.strength().power_law) return false;
  const MacroVector e = sunk(multiplier);
  double left = capacity(e) * std::pow(1 - shear_share(multiplier), 3);
  if (!(left > 0)) return true;
  for (int i = 0; i < 2; ++i) left *= 1 - std::abs(flat_moment(multiplier, i));
  return uplift_.beyond_capacity(e, left);
}

/// So far along the flow, with the moment of a flat axis and the shear that the flow has.
MacroVector MacroLanding::pressed(double multiplier) const {
  MacroVector e = sunk(multiplier), force = uplift_.respond(e, false).force;
  if (!(force[macro_n] > 0)) return e;
  bool flat = false;
  for (int i = 0; i < 2; ++i)
    if (const double moment = flat_moment(multiplier, i); moment != 0) {
      force[macro_m1 + i] = 0.5 * force[macro_n] * uplift_.elasticity().length[i] * moment;
      flat = true;
    }
  if (flat) e = uplift_.displacement(force);
  const double moved = std::hypot(trial_[macro_h1], trial_[macro_h2]);
  if (moved > 0)
    for (int i = macro_h1; i <= macro_h2; ++i)
      e[i] = shear_share(multiplier) * force[macro_n] * trial_[i] / (moved * uplift_.stiffness()[i]);
  return e;
}

/// Whether the ground must give way more.
bool MacroLanding::overloaded(double multiplier) const {
  if (beyond(multiplier)) return true;
  const MacroVector e = pressed(multiplier), force = uplift_.respond(e, false).force;
  return force[macro_n] > 0 && (!surfaces_.bears(force) || surfaces_.bearing_value(force, capacity(e)) > 0);
}

std::optional<MacroVector> MacroLanding::borne() const {
  if (!overloaded(0) || overloaded(most_)) return {};
  double low = 0, high = most_;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (overloaded(middle) ? low : high) = middle;
  }
  return pressed(high);
}

bool MacroLanding::land(MacroReturned& out) const {
  if (!beyond(most_)) return false;
  out.elastic = sunk(most_);
  out.at = {};
  out.at.contact = false;
  out.at.contact_share = 0;
  MacroVector flow = flow_;
  for (int i = macro_m1; i <= macro_m2; ++i)
    if (toe_[i] == 0) flow[i] = 0, out.by_trial(i, i) = 0;  // flat
  out.by_trial -= flow * toe_.transpose() / toe_.dot(flow);
  out.by_trial.middleRows<2>(macro_h1).setZero();
  const double turned = trial_.tail<2>().norm();
  if (uplift_.elasticity().disc && turned > 0) {  // its rotation keeps its direction and gets shorter
    const Fixed<2, 1> along = trial_.tail<2>() / turned;
    out.by_trial.bottomRightCorner<2, 2>() -=
        most_ * flow.tail<2>().norm() / turned * (Fixed<2, 2>::Identity() - along * along.transpose());
  }
  return true;
}

}  // namespace uplift
