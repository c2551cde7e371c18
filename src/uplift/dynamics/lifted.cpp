#include "uplift/dynamics/lifted.h"

#include <fmt/format.h>

#include <utility>

#include "uplift/math/dense.h"
#include "uplift/model/check.h"
#include "uplift/model/mechanism.h"

namespace uplift {

namespace {

/// Forces that are round-off beside what the closed joint would bear count as none: a motion that nothing determines may end at a touch.
bool lost_contact(const Block& block, const InterfaceProblem& problem, const InterfaceSolution& solution) {
  constexpr double round_off = 1e-9;
  const auto opening = solution.opening.segment(block.first + block.batch.normal(), block.batch.points);
  const auto stiffness = problem.model->shift.segment(block.first + block.batch.normal(), block.batch.points);
  const double most = opening.maxCoeff(), force = stiffness.maxCoeff() * most;
  return most > 0 && opening.minCoeff() >= -round_off * most &&
         solution.force.segment(block.first, block.rows()).cwiseAbs().maxCoeff() <= round_off * force;
}

/// Answer of a law to these openings (all rows): its slopes; the forces go into `force`, the memory into `now`.
Vector respond(const Block& block, const InterfaceProblem& problem, const Vector& opening, Vector& force, Vector& now) {
  Vector slope(block.rows() * block.batch.components);
  LawResponse response{.traction = force.data() + block.first, .slope = slope.data()};
  response.now = now.data() + block.first_history;
  block.law->respond(block.batch, problem.from.data() + block.first, opening.data() + block.first, problem.old.data() + block.first_history,
                     response);
  for (int row = 0; row < block.rows(); ++row) force[block.first + row] *= block.area[row % block.batch.points];
  return slope;
}

/// Makes translations and rotations comparable.
Vector lengths(const Model& model) {
  Vec3 low = model.nodes.front().position, high = low;
  for (const Node& node : model.nodes) low = low.cwiseMin(node.position), high = high.cwiseMax(node.position);
  const double size = (high - low).norm();
  Vector length = Vector::Ones(model.free());
  for (int i = 0; i < model.free(); ++i)
    if (model.space.is_rotation(model.kept[static_cast<std::size_t>(i)]) && size > 0) length[i] = size;
  return length;
}

}  // namespace

Lifted keep_undetermined(const Model& model, const Sparse& b, const InterfaceProblem& problem, const InterfaceSolution& solution,
                         const Vector& increment, LooseMotions& loose) {
  std::vector<const Block*> lifted;
  for (const Block& block : problem.model->blocks)
    if (lost_contact(block, problem, solution)) lifted.push_back(&block);
  if (lifted.empty()) return {};
  std::vector<char> holds(static_cast<std::size_t>(b.rows()), 1);
  Lifted kept;
  kept.opening = solution.opening, kept.force = solution.force, kept.history = solution.now;
  std::string names;
  for (const Block* block : lifted) {
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", block->name);
    const int points = block->batch.points, components = block->batch.components;
    auto normal = kept.opening.segment(block->first + block->batch.normal(), points);
    normal = normal.cwiseMax(0.5 * normal.maxCoeff());  // none touches
    Vector slope = Vector::Zero(block->rows() * components);
    if (block->law) slope = respond(*block, problem, kept.opening, kept.force, kept.history);
    for (int row = 0; row < block->rows(); ++row) {
      const int component = row / points;
      holds[static_cast<std::size_t>(block->first + row)] = slope[(component * components + component) * points + row % points] > 0;
    }
  }
  if (loose.holds != holds) loose.motions = unresisted_motions(model, holds), loose.holds = std::move(holds);
  const Matrix& motions = loose.motions;
  if (motions.cols() == 0) return {};
  const Vector length = lengths(model);
  const Matrix scaled = length.asDiagonal() * motions;
  const Vector taken = motions * CompleteQr(scaled).solve(Vector(length.cwiseProduct(increment)));
  kept.increment = increment - taken;
  kept.opening = solution.opening - b * taken;
  for (const Block* block : lifted) {
    if (block->law)
      respond(*block, problem, kept.opening, kept.force, kept.history);
    else
      kept.force.segment(block->first, block->rows()).setZero();
    const bool open = kept.opening.segment(block->first + block->batch.normal(), block->batch.points).minCoeff() > 0;
    if (!open || !kept.force.segment(block->first, block->rows()).isZero(0)) return {};
  }
  kept.notice = fmt::format(
      "the static equilibrium is not unique: {} has no contact, and {} without resistance; this motion keeps its value of the load step "
      "before",
      names, describe_motion(model, motions.col(0)));
  return kept;
}

}  // namespace uplift
