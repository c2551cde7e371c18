#pragma once
#include <string>
#include <vector>

#include "uplift/contact/problem.h"
#include "uplift/model/model.h"

namespace uplift {

/// Motions that an interface resisted alone have no unique static equilibrium once it has lost all contact: round-off would choose one.
/// They are taken out of the increment, so that the structure keeps the position that it had before the load step.
struct Lifted {
  Vector increment, opening, force, history;  // in place of those of the load step; empty where the equilibrium is unique
  std::string notice;                         // which motions these are, in words
};
/// What is kept from load step to load step.
struct LooseMotions {
  std::vector<char> holds;  // interface rows
  Matrix motions;           // free unknowns: what they do not hold, see unresisted_motions
};
/// `increment`: displacement of a load step with this solution of the interfaces.
Lifted keep_undetermined(const Model& model, const Sparse& b, const InterfaceProblem& problem, const InterfaceSolution& solution,
                         const Vector& increment, LooseMotions& loose);

}  // namespace uplift
