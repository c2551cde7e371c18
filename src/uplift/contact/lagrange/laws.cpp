#include "uplift/contact/lagrange/laws.h"

#include <algorithm>

#include "uplift/contact/law_force.h"

namespace uplift {

void slope_offsets(const ContactModel& model, std::vector<int>& offsets) {
  offsets.assign(1, 0);
  for (const Block& block : model.blocks)
    offsets.push_back(offsets.back() + (block.law != nullptr ? block.batch.points * block.batch.components * block.batch.components : 0));
}

void law_forces(const InterfaceProblem& problem, const std::vector<int>& first_slope, double* slope, InterfaceSolution& solution) {
  for (std::size_t b = 0; b < problem.model->blocks.size(); ++b) {
    const Block& block = problem.model->blocks[b];
    if (block.law == nullptr) continue;
    LawResponse response;
    response.traction = solution.force.data() + block.first;
    response.slope = slope != nullptr ? slope + first_slope[b] : nullptr;
    response.now = solution.now.data() + block.first_history;
    law_force(problem, block, solution.opening.data(), response);
  }
}

void add_law_slopes(const ContactModel& model, const std::vector<int>& first_slope, Vector& slope, bool convex, Matrix& work,
                    Matrix& hessian) {
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Block& block = model.blocks[b];
    if (block.law == nullptr) continue;
    const int n = block.batch.points, components = block.batch.components;
    for (int row = 0; row < components; ++row)
      for (int column = 0; column < components; ++column) {
        if (convex && row != column) continue;
        double* k = slope.data() + first_slope[b] + (row * components + column) * n;
        if (convex)
          for (int i = 0; i < n; ++i) k[i] = std::max(k[i], 0.0);
        add_weighted_gram(model, block.first + row * n, block.first + column * n, ConstMap(k, n), work, hessian);
      }
  }
}

}  // namespace uplift
