#include "uplift/contact/unheld.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/contact/law_force.h"
#include "uplift/laws/macro_element.h"

namespace uplift {

namespace {

std::string exhausted_ground(const Block& block) {
  return fmt::format("the ground under '{}' gives way: its bearing capacity is exhausted", block.name);
}

}  // namespace

std::string unheld_motion(const InterfaceProblem& problem, const InterfaceSolution& solution, double ratio) {
  const Vector moved = (solution.opening - problem.from).cwiseAbs();
  const double least = ratio * (problem.free_opening - problem.from).cwiseAbs().maxCoeff();
  double most = 0;
  std::string text;
  for (const Block& block : problem.model->blocks) {
    const int normal = block.batch.normal();
    const double along = normal > 0 ? moved.segment(block.first, normal).maxCoeff() : 0;
    const double apart = moved.segment(block.first + normal, block.batch.points).maxCoeff();
    const double larger = std::max(along, apart);
    if (!(larger > most && larger > least)) continue;
    most = larger;
    const MacroElement* ground = as_macro_element(block.law);
    const bool pressed = (problem.free_opening - problem.from)[block.first + normal] < 0;
    if (!(apart > least))
      text = fmt::format("slides: nothing holds the structure along '{}'", block.name);
    else if (ground != nullptr && ground->surfaces().has_bearing() && pressed)
      text = exhausted_ground(block);
    else
      text = fmt::format("overturns: nothing holds the structure down on '{}', it turns over or lifts off", block.name);
  }
  return text;
}

std::string softening_joint(const InterfaceProblem& problem, const InterfaceSolution& solution) {
  if (solution.opening.size() != problem.rows() || !solution.opening.allFinite()) return {};
  Vector traction(problem.rows()), now(problem.old.size()), slope;
  double steepest = 0;
  std::string text;
  for (const Block& block : problem.model->blocks) {
    if (block.law == nullptr) continue;
    slope.setZero(block.slopes());
    law_force(problem, block, solution.opening.data(),
              {.traction = traction.data() + block.first, .slope = slope.data(), .now = now.data() + block.first_history});
    const int points = block.batch.points, components = block.batch.components;
    for (int c = 0; c < components; ++c)
      for (int i = 0; i < points; ++i) {
        const double own = slope[(c * components + c) * points + i];
        if (own >= steepest) continue;
        steepest = own;
        text = block.footprint
                   ? exhausted_ground(block)
                   : fmt::format(
                         "the joint '{}' softens at point {}, and no static equilibrium was found near the last one: it may let go at "
                         "once; apply this load in a dynamic stage, or give the joint more fracture energy or no strength",
                         block.name, i + 1);
      }
  }
  return text;
}

}  // namespace uplift
