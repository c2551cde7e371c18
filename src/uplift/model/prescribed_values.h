#pragma once
#include <vector>

#include "uplift/model/model.h"

namespace uplift {

/// A value (or rate) of a full unknown that the input asks for, as an initial condition.
struct PrescribedValue {
  int unknown = 0;
  double value = 0;  // m, rad, m/s, rad/s
  Where where;
};

/// Free unknowns (values or rates) with the smallest norm that give the prescribed values, zero prescribed motion. Throws InputError when
/// supports, rigid bodies or inextensible beams make the values impossible. Unknowns that no constraint couples cost nothing.
Vector free_values(const Model& model, const std::vector<PrescribedValue>& prescribed);

}  // namespace uplift
