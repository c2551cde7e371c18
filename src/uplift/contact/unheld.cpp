#include "uplift/contact/unheld.h"

#include <fmt/format.h>

#include <algorithm>

namespace uplift {

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
    text = apart > least ? fmt::format("overturns: nothing holds the structure down on '{}', it turns over or lifts off", block.name)
                         : fmt::format("slides: nothing holds the structure along '{}'", block.name);
  }
  return text;
}

}  // namespace uplift
