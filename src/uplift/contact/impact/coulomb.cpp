#include "uplift/contact/impact/coulomb.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "uplift/contact/lagrange/lagrange.h"

namespace uplift {

bool any_friction(const std::vector<Block>& blocks) {
  return std::ranges::any_of(blocks, [](const Block& block) { return block.cone != nullptr && block.cone->friction() > 0; });
}

CoulombRates::CoulombRates(const std::vector<Block>& blocks, const Matrix& factor) {
  auto model = std::make_shared<ContactModel>();
  std::ranges::copy_if(blocks, std::back_inserter(model->blocks), [](const Block& block) { return block.cone != nullptr; });
  model->factor = factor;
  problem_ = problem_of(std::move(model));
}

CoulombRates::~CoulombRates() = default;

bool CoulombRates::solve(const Vector& free, const Vector& takes_part, double at_rest) {
  constexpr double far = 1e3;  // times the largest rate: closes by no impulse of this size
  problem_.free_opening = free;
  const double open = far * free.cwiseAbs().maxCoeff();
  for (const Block& block : problem_.model->blocks) {
    const int normal = block.normal_row();
    for (int row = normal; row < normal + block.batch.points; ++row)
      if (!(takes_part[row] > 0)) problem_.free_opening[row] += open;
  }
  problem_.from.setZero(free.size());
  if (fresh_.opening.size() != free.size()) size_solution(problem_, fresh_);
  solution_ = fresh_;
  solution_.opening = free;
  if (!(open > 0)) return true;
  std::size_t point = 0;  // the first guess: what approaches sticks
  for (const Block& block : problem_.model->blocks) {
    const int normal = block.normal_row();
    for (int row = normal; row < normal + block.batch.points; ++row, ++point)
      solution_.status[point] = problem_.free_opening[row] < -at_rest ? Status::stick : Status::open;
  }
  return solve_frictional(problem_, {.gap_tolerance = at_rest}, work_, solution_).converged;
}

}  // namespace uplift
