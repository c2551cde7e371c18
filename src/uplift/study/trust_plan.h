#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "uplift/case/case.h"
#include "uplift/study/case_edit.h"

// How far results can be trusted: the same case with every choice of the computation changed, one at a time (docs/theory/trust.md).
namespace uplift {

inline constexpr std::string_view joint_stiffness = "joint stiffness";  // the choice that has an interior

/// One changed choice.
struct TrustChange {
  std::string name;    // "step_half": part of names of runs
  std::string choice;  // "time step": what was chosen
  std::string label;   // "half the time step, 0.5 ms"
  std::vector<CaseEdit> edits;
};

/// What is repeated, and which choices could not be changed and why.
struct TrustPlan {
  std::vector<TrustChange> changes;
  struct LeftOut {
    std::string choice, reason;
  };
  std::vector<LeftOut> left_out;
};

/// Half the time step; the stiffness of every traction law (or penalty) times and over the case's factor, and as many values between as
/// the case asks for, in equal ratios; a tolerance ten times smaller; another sound method for the same interface; a finer mesh, where the
/// mesh is made by the case; the mesh moved against the planes of interface.cut.
TrustPlan trust_plan(const Case&);

}  // namespace uplift
