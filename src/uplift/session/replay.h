#pragma once
#include <string>
#include <vector>

#include "uplift/contact/method.h"

// The interface problem of one step alone, as it is stored when a step fails.
namespace uplift {

/// What one method makes of an interface problem.
struct Replay {
  std::string method;
  bool suits = true;  // a method for traction laws does not suit a problem with cones
  Outcome outcome;
  InterfaceSolution solution;
  double residual = 0;  // the contact residual
};

/// Solves a problem by a method, or by all of them with an empty name. Throws InputError for an unknown method; numerical failure is in
/// the outcomes. `where` is where the name stands, for messages.
std::vector<Replay> replay_problem(const InterfaceProblem& problem, const std::string& method, const Where& where);
/// The same as JSON text, which `uplift replay --json` prints.
std::string replay_json(const std::string& reason, const std::vector<Replay>& answers);

}  // namespace uplift
