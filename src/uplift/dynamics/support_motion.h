#pragma once
#include "uplift/model/model.h"

namespace uplift {

/// Lower sides of interfaces that prescribed motions move: what these alone make of the openings.
class SupportMotion {
 public:
  /// `still_gap`: the gaps without motions [m]. Both must stay alive.
  SupportMotion(const Model& model, const Vector& still_gap);
  /// False: the gaps stay, and nothing below needs to be called.
  bool acts() const { return acts_; }
  /// Sets the gaps at the end of a step, and their change in it.
  void go(double from, double to);
  /// Sets the rates, which impacts and held points need; a jump of the velocity is in the velocity alone.
  void set_rates(double time);
  void add_velocity(double time, Vector& rates) const;
  const Vector& gap() const { return gap_; }                                       // rows [m]
  const Vector& change() const { return change_; }                                 // rows [m]
  const Vector* velocity() const { return acts_ ? &velocity_ : nullptr; }          // rows [m/s]
  const Vector* acceleration() const { return acts_ ? &acceleration_ : nullptr; }  // rows [m/s2]

 private:
  const Model& model_;
  const Vector& still_gap_;
  bool acts_ = false;
  Vector gap_, change_, velocity_, acceleration_;
};

}  // namespace uplift
