// Anderson's rule: D. G. Anderson, Iterative procedures for nonlinear integral equations, J. ACM 12, 1965; in the form of H. F. Walker and
// P. Ni, SIAM J. Numer. Anal. 49, 2011, eq (2.1).
#include "uplift/dynamics/solved_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "uplift/math/dense.h"

namespace uplift {

namespace {

/// Loads with the place where each of them acts.
struct Loads {
  Sparse columns;            // V^T: free unknowns x loads
  std::vector<Vec3> centre;  // m; the middle of the rows that an unknown touches
};

/// Places of the rows of all interfaces.
std::vector<Vec3> row_places(const Model& model) {
  std::vector<Vec3> places;
  for (const Interface& interface : model.interfaces)
    for (int row = 0; row < interface.rows(); ++row)
      places.push_back(interface.position[static_cast<std::size_t>(row % interface.batch.points)]);
  return places;
}

struct Box {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  void add(const Vec3& place) { low = low.cwiseMin(place), high = high.cwiseMax(place); }
  double size() const { return (high - low).norm(); }
};

Box box_of(const Sparse& b, int unknown, const std::vector<Vec3>& places) {
  Box box;
  for (Sparse::InnerIterator entry(b, unknown); entry; ++entry) box.add(places[static_cast<std::size_t>(entry.row())]);
  return box;
}

/// Columns of the identity.
Sparse unit_columns(Index rows, const std::vector<int>& chosen) {
  std::vector<Triplet> entries;
  for (std::size_t j = 0; j < chosen.size(); ++j) entries.emplace_back(chosen[j], static_cast<int>(j), 1.0);
  Sparse unit(rows, std::ssize(chosen));
  unit.setFromTriplets(entries.begin(), entries.end());
  return unit;
}

/// The first number for every load that none within `distance` before it has.
std::vector<int> colours(const std::vector<Vec3>& centre, double distance) {
  std::vector<int> colour(centre.size(), 0);
  std::vector<char> taken;
  for (std::size_t i = 0; i < centre.size(); ++i) {
    taken.assign(centre.size() + 1, 0);
    for (std::size_t j = 0; j < i; ++j)
      if ((centre[i] - centre[j]).squaredNorm() <= distance * distance) taken[static_cast<std::size_t>(colour[j])] = 1;
    colour[i] = static_cast<int>(std::ranges::find(taken, 0) - taken.begin());
  }
  return colour;
}

/// V A^-1 b, some columns at once so that little is kept. `residual`: see FactorWithReach.
Matrix answers(const BulkFactor& factor, const Sparse& b, const Sparse& loads, double residual, LinearCounts& counts) {
  constexpr Index most_numbers = 1 << 17;
  const Index block = std::clamp<Index>(most_numbers / std::max<Index>(b.rows(), 1), 1, 32);
  Matrix result(loads.cols(), b.cols()), x;
  for (Index first = 0; first < b.cols(); first += block) {
    const Index count = std::min(block, b.cols() - first);
    x = b.middleCols(first, count);
    factor.solve(x, x, residual, counts);
    result.middleCols(first, count).noalias() = loads.transpose() * x;
  }
  return result;
}

double largest(const Vector& v) {
  return v.cwiseAbs().maxCoeff();
}

/// U with U U^T = G, where G has negative eigenvalues with that part of it which has none.
Matrix root_of(const Matrix& g) {
  const Cholesky cholesky(g);
  if (cholesky->info() == Success) return cholesky->matrixL();
  const SymmetricEigen eigen(g);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

class Compliance {
 public:
  Compliance(const BulkFactor& factor, const Model& model, const Sparse& b, LinearCounts& counts)
      : factor_(factor), b_(b), counts_(counts), reach_(factor.reach()), places_(row_places(model)) {
    for (const int unknown : touched_unknowns(b)) (box_of(b, unknown, places_).size() > 2 * reach_ ? common_ : near_).push_back(unknown);
  }

  Matrix factor() {
    if (b_.rows() <= std::ssize(near_) + std::ssize(common_)) {
      loads_ = {b_.transpose(), places_};
      return root_of(compliance());
    }
    std::vector<int> touched = near_;
    touched.insert(touched.end(), common_.begin(), common_.end());
    loads_.columns = unit_columns(b_.cols(), touched);
    for (const int unknown : near_) {
      const Box box = box_of(b_, unknown, places_);
      loads_.centre.emplace_back((box.low + box.high) / 2);
    }
    return Matrix(b_ * loads_.columns) * root_of(compliance());
  }

 private:
  static constexpr double residual_of_entries = 1e-6;  // what is left out beyond the reach is more by far

  /// What is kept of G.
  Matrix compliance() {
    const Index count = loads_.columns.cols(), near = std::ssize(loads_.centre);
    Matrix through = Matrix::Zero(count, 0);  // (V X) U^-1 with E^T X = U^T U
    if (!common_.empty()) {
      const Sparse e = unit_columns(b_.cols(), common_);
      Sparse both(b_.cols(), count + e.cols());
      both.leftCols(count) = loads_.columns, both.rightCols(e.cols()) = e;
      const Matrix x = answers(factor_, e, both, 0, counts_);
      const Matrix own = x.bottomRows(e.cols());
      through = divided_by_upper(Cholesky(Matrix((own + own.transpose()) / 2)), x.topRows(count));
    }
    Matrix g = through * through.transpose();
    const std::vector<int> colour = colours(loads_.centre, 2 * reach_);
    const int most = colour.empty() ? 0 : *std::ranges::max_element(colour) + 1;
    std::vector<Triplet> members;
    for (Index j = 0; j < near; ++j) members.emplace_back(static_cast<int>(j), colour[static_cast<std::size_t>(j)], 1.0);
    Sparse of_colour(count, most);
    of_colour.setFromTriplets(members.begin(), members.end());
    const Matrix answer = answers(factor_, loads_.columns * of_colour, loads_.columns, residual_of_entries, counts_) -
                          through * (through.transpose() * of_colour);
    for (Index j = 0; j < near; ++j)
      for (Index i = 0; i < near; ++i)
        if (within_reach(i, j))
          g(i, j) += (answer(i, colour[static_cast<std::size_t>(j)]) + answer(j, colour[static_cast<std::size_t>(i)])) / 2;
    return g;
  }
  bool within_reach(Index i, Index j) const {
    return (loads_.centre[static_cast<std::size_t>(i)] - loads_.centre[static_cast<std::size_t>(j)]).squaredNorm() <= reach_ * reach_;
  }

  const BulkFactor& factor_;
  const Sparse& b_;
  LinearCounts& counts_;
  const double reach_;
  const std::vector<Vec3> places_;
  std::vector<int> near_, common_;  // touched unknowns: of rows near each other, and of far ones too
  Loads loads_;
};

}  // namespace

SolvedResponse::SolvedResponse(const BulkFactor& factor, const Model& model, const Sparse& b, LinearCounts& counts)
    : factor_(factor), b_(b), work_(counts), c_(Compliance(factor, model, b, counts).factor()) {
  forget();
}

void SolvedResponse::forget() {
  force_.setZero(b_.rows());
  openings_.clear(), remains_.clear();
}

/// increment -= A^-1 B^T force
void SolvedResponse::press(const Vector& force, double residual, Vector& increment) {
  work_.given.resize(b_.cols(), 1);
  work_.given.col(0).noalias() = b_.transpose() * force;
  factor_.solve(work_.given, work_.given, residual, *work_.counts);
  increment -= work_.given.col(0);
}

/// Columns of length one: the changes become smaller from try to try.
void SolvedResponse::improve(Vector& free_opening, const Vector& rest) {
  constexpr std::size_t most = 24;  // tries that are remembered
  if (last_rest_.size() > 0) {
    openings_.push_back(free_opening - last_opening_), remains_.push_back(rest - last_rest_);
    if (openings_.size() > most) openings_.erase(openings_.begin()), remains_.erase(remains_.begin());
  }
  last_opening_ = free_opening, last_rest_ = rest;
  free_opening += rest;
  if (remains_.empty()) return;
  Matrix changes(rest.size(), std::ssize(remains_));
  for (std::size_t k = 0; k < remains_.size(); ++k) changes.col(static_cast<Index>(k)) = remains_[k];
  const Vector length = changes.colwise().norm().cwiseMax(1e-300);
  CompleteQr decomposition;
  decomposition->setThreshold(1e-8);
  decomposition.compute(changes * length.cwiseInverse().asDiagonal());
  const Vector share = decomposition.solve(rest).cwiseQuotient(length);
  for (std::size_t k = 0; k < remains_.size(); ++k) free_opening -= share[static_cast<Index>(k)] * (openings_[k] + remains_[k]);
}

Outcome SolvedResponse::solve(const Vector& right, const Vector& opening, const ContactMethod& method, MethodWork& work,
                              InterfaceProblem& problem, InterfaceSolution& solution, Vector& increment) {
  constexpr double tolerance = 1e-10, least = 1e-12, round_off = 1e-14, of_motion = 1e-15;
  constexpr int most_tries = 60;
  const ContactModel& model = *problem.model;
  increment = right;
  increment.noalias() -= b_.transpose() * force_;
  factor_.solve(increment, increment, work_);
  problem.free_opening = opening + b_ * increment;
  problem.free_opening += model.factor * (model.factor.transpose() * force_).eval();
  last_rest_.resize(0);
  double share = 0;  // of what the last try left over that the next one may leave
  Outcome all;
  for (int k = 0; k < most_tries; ++k) {
    const Outcome one = method.solve(problem, work, solution);
    all.iterations += one.iterations, all.cycles += one.cycles, all.residual = one.residual;
    all.converged = one.converged, all.why = one.why;
    if (!all.converged) return all;
    Vector force = solution.force;
    if (model.shift.size() > 0) force -= model.shift.cwiseProduct(solution.opening);
    press(force - force_, 1e-2 * share, increment);
    force_ = std::move(force);
    const Vector rest = opening + b_ * increment - solution.opening;
    if (!rest.allFinite()) break;
    const double pressed = largest(problem.free_opening - solution.opening);      // what the forces close
    const double moved = std::min(pressed, largest(solution.opening - opening));  // in this step; small in a light motion
    const double lost = round_off * largest(solution.opening) + of_motion * largest(b_.cwiseAbs() * increment.cwiseAbs());
    const double allowed = std::max(tolerance * moved, least * pressed) + lost;
    if (largest(rest) <= allowed) {
      work_.given.resize(0, 0);  // as large as the model; beside a solve allocating it costs nothing
      return all;
    }
    share = allowed / largest(rest);
    improve(problem.free_opening, rest);
  }
  forget();
  all.converged = false;
  all.why = fmt::format(
      "the openings with entries of the flexibility within {} m do not approach those of the whole model in {} tries: take a longer "
      "solver.reach",
      factor_.reach(), most_tries);
  return all;
}

}  // namespace uplift
