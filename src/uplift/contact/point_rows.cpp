#include "uplift/contact/point_rows.h"

#include <algorithm>
#include <cmath>

#include "uplift/math/small.h"

namespace uplift {
namespace {

constexpr int most_with_factor = 16, most_alone = 100;

double weighted(const PointRelation::Local& a, const PointRelation::Local& b, int components) {
  double sum = 0;
  for (int c = 0; c < components; ++c) sum += a[static_cast<std::size_t>(c)] * b[static_cast<std::size_t>(c)];
  return sum;
}

double largest_of(const Vector& v, Index n) {
  return n > 0 ? v.head(n).cwiseAbs().maxCoeff() : 0;
}

}  // namespace

void PointRows::begin(const InterfaceProblem& problem) {
  problem_ = &problem;
  const ContactModel& model = *problem.model;
  if (seen_.is(model)) return;
  seen_.take(model);
  const Index rows = model.rows();
  valid_ = false;
  compliance_.resize(rows, rows);
  compliance_.noalias() = model.factor * model.factor.transpose();
  for (Vector* v : {&residual_, &direction_, &image_, &unknown_, &change_, &moved_, &column_}) v->setZero(rows);
  const bool alone = model.solver == InterfaceSolver::krylov || (model.solver == InterfaceSolver::automatic && rows >= enough_to_iterate);
  directions_.resize(rows, alone ? most_alone : most_with_factor);
  images_.resize(rows, directions_.cols());
  places_.clear();
  first_point_.clear();
  for (const Block& block : model.blocks) {
    first_point_.push_back(places_.size());
    for (int i = 0; i < block.batch.points; ++i) places_.push_back({block.first + i, block.batch.points, 0, block.batch.components, -1});
  }
  relations_.assign(places_.size(), {});
}

void PointRows::linearise(std::size_t b, const double* slope, const Vector& force, const Vector& opening) {
  const Block& block = problem_->model->blocks[b];
  const int n = block.batch.points, components = block.batch.components;
  for (int i = 0; i < n; ++i) {
    const Place& at = places_[first_point_[b] + static_cast<std::size_t>(i)];
    PointRelation& relation = relations_[first_point_[b] + static_cast<std::size_t>(i)];
    relation.count = relation.kind = 0;
    for (int r = 0; r < components; ++r) {
      const double taken = problem_->model->shift.size() > 0 ? problem_->model->shift[at.row(r)] : 0;
      PointRelation::Local k{};
      double moved = 0;
      bool any = false;
      for (int c = 0; c < components; ++c) {
        double& entry = k[static_cast<std::size_t>(c)];
        entry = slope[(r * components + c) * n + i] - (c == r ? taken : 0);
        moved += entry * opening[at.row(c)];
        any = any || entry != 0;
      }
      const double now = force[at.row(r)] - taken * opening[at.row(r)];
      relation.known[static_cast<std::size_t>(r)] = any ? 0 : now;
      if (!any) continue;
      const double weight = 1 / (1 + std::abs(k[static_cast<std::size_t>(r)]) * compliance(at.row(r)));
      const std::size_t f = static_cast<std::size_t>(relation.count++);
      relation.kind |= 1 << r;
      relation.basis[f] = relation.force[f] = {};
      relation.basis[f][static_cast<std::size_t>(r)] = 1;
      relation.force[f][static_cast<std::size_t>(r)] = weight;
      for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c) relation.opening[f][c] = weight * k[c];
      relation.right[f] = weight * (moved - now);
    }
  }
}

bool PointRows::same_kinds() const {
  for (std::size_t p = 0; p < places_.size(); ++p)
    if (places_[p].kind != relations_[p].kind) return false;
  return true;
}

void PointRows::list_unknowns() {
  unknowns_ = 0;
  for (std::size_t p = 0; p < places_.size(); ++p) {
    places_[p].kind = relations_[p].kind;
    places_[p].unknown = unknowns_;
    unknowns_ += relations_[p].count;
  }
}

/// The matrix opening . F . basis + force . basis, and its factor.
bool PointRows::factorise() {
  const Index rows = compliance_.rows();
  matrix_.size(rows);
  for (std::size_t p = 0; p < places_.size(); ++p)
    for (int f = 0; f < relations_[p].count; ++f) {
      const PointRelation::Local& basis = relations_[p].basis[static_cast<std::size_t>(f)];
      column_.setZero();
      for (int c = 0; c < places_[p].components; ++c)
        if (const double share = basis[static_cast<std::size_t>(c)]; share != 0)
          small::add(rows, share, compliance_.col(places_[p].row(c)).data(), column_.data());
      double* entry = matrix_.column(places_[p].unknown + f);
      for (std::size_t o = 0; o < places_.size(); ++o) {
        const PointRelation& other = relations_[o];
        const Place& there = places_[o];
        for (std::size_t e = 0; e < static_cast<std::size_t>(other.count); ++e, ++entry) {
          double sum = 0;
          for (int c = 0; c < there.components; ++c) sum += other.opening[e][static_cast<std::size_t>(c)] * column_[there.row(c)];
          *entry = o == p ? sum + weighted(other.force[e], basis, there.components) : sum;
        }
      }
    }
  valid_ = matrix_.factorise(unknowns_);
  return valid_;
}

void PointRows::put_forces(const Vector& unknowns, bool with_known, Vector& forces) const {
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const Place& at = places_[p];
    for (int c = 0; c < at.components; ++c) {
      double value = with_known ? relations_[p].known[static_cast<std::size_t>(c)] : 0;
      for (int f = 0; f < relations_[p].count; ++f)
        value += relations_[p].basis[static_cast<std::size_t>(f)][static_cast<std::size_t>(c)] * unknowns[at.unknown + f];
      forces[at.row(c)] = value;
    }
  }
}

/// opening -= F forces. Columns without force, those of open points, are not read.
void PointRows::spread(const Vector& forces, Vector& opening) const {
  const Index rows = compliance_.rows();
  const double* pending[4];
  double factor[4];
  int count = 0;
  for (Index j = 0; j < rows; ++j) {
    if (forces[j] == 0) continue;
    pending[count] = compliance_.col(j).data();
    factor[count++] = -forces[j];
    if (count < 4) continue;
    const double *a = pending[0], *b = pending[1], *c = pending[2], *d = pending[3];
    double* y = opening.data();
#pragma omp simd
    for (Index i = 0; i < rows; ++i) y[i] += factor[0] * a[i] + factor[1] * b[i] + factor[2] * c[i] + factor[3] * d[i];
    count = 0;
  }
  for (int k = 0; k < count; ++k) small::add(rows, factor[k], pending[k], opening.data());
}

/// opening . moved - force . forces for all equations.
void PointRows::apply(const Vector& moved, const Vector& forces, Vector& result) const {
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const Place& at = places_[p];
    for (int f = 0; f < relations_[p].count; ++f) {
      const PointRelation::Local &opening = relations_[p].opening[static_cast<std::size_t>(f)],
                                 &force = relations_[p].force[static_cast<std::size_t>(f)];
      double sum = 0;
      for (int c = 0; c < at.components; ++c)
        sum += opening[static_cast<std::size_t>(c)] * moved[at.row(c)] - force[static_cast<std::size_t>(c)] * forces[at.row(c)];
      result[at.unknown + f] = sum;
    }
  }
}

/// Forces, opening and residual of the unknowns as they are; returns the largest force that the problem is measured with.
double PointRows::start(Vector& forces, Vector& opening) {
  put_forces(unknown_, true, forces);
  opening = problem_->free_opening;
  spread(forces, opening);
  apply(opening, forces, residual_);
  double size = 0;
  for (std::size_t p = 0; p < places_.size(); ++p)
    for (int f = 0; f < relations_[p].count; ++f) {
      residual_[places_[p].unknown + f] -= relations_[p].right[static_cast<std::size_t>(f)];
      size = std::max(size, std::abs(relations_[p].right[static_cast<std::size_t>(f)]));
    }
  rest_ = largest_of(residual_, unknowns_);
  return std::max({size, rest_, forces.cwiseAbs().maxCoeff()});
}

/// Generalised conjugate residuals, with the factor when it is valid, until the residual is round-off; false when it is not after so many
/// iterations, or when it stops falling although there is a factor.
bool PointRows::iterate(int most, double size, Vector& forces, Vector& opening) {
  const Index n = unknowns_;
  auto rest = residual_.head(n);
  double before = rest_;
  for (int k = 0; k < most; ++k) {
    if (rest_ <= 1e-14 * size) return true;
    auto direction = directions_.col(k).head(n);
    auto image = images_.col(k).head(n);
    direction = rest;
    if (valid_) matrix_.solve(directions_.col(k).data());
    direction_.head(n) = direction;
    put_forces(direction_, false, change_);
    moved_.setZero();
    spread(change_, moved_);
    apply(moved_, change_, image_);
    image = image_.head(n);
    for (int pass = 0; pass < 2; ++pass)
      for (int j = 0; j < k; ++j) {
        const double share = images_.col(j).head(n).dot(image);
        image -= share * images_.col(j).head(n);
        direction -= share * directions_.col(j).head(n);
      }
    const double length = image.norm();
    if (!(length > 0) || !std::isfinite(length)) return false;
    image /= length;
    direction /= length;
    const double step = -image.dot(rest);
    rest += step * image;
    unknown_.head(n) += step * direction;
    rest_ = largest_of(residual_, n);
    if (rest_ <= 1e-14 * size || (valid_ && rest_ > 0.9 * before)) break;
    before = rest_;
  }
  start(forces, opening);  // the true residual: that of the iteration gathers round-off
  return rest_ <= 1e-13 * size;
}

/// The iteration without a factor, from no unknown forces, begun afresh when its directions are used up. The equations are scaled so that
/// the diagonal of the matrix is about one.
bool PointRows::iterate_alone(double& size, Vector& forces, Vector& opening) {
  const int most_restarts = problem_->model->solver == InterfaceSolver::krylov ? 6 : 2;
  valid_ = false;
  for (int k = 0; k < most_restarts; ++k) {
    const double before = rest_;
    if (iterate(most_alone, size, forces, opening)) return true;
    size = std::max(size, forces.cwiseAbs().maxCoeff());
    if (!(rest_ <= 0.5 * before)) return rest_ <= 1e-12 * size;
  }
  return false;
}

/// A new factor, and corrections until the residual is round-off.
bool PointRows::factor_and_correct(double size, Vector& forces, Vector& opening) {
  if (!factorise()) return false;
  bool done = false;
  for (int pass = 0; pass < 3 && !done; ++pass) {
    const double before = rest_;
    done = iterate(2, std::max(size, forces.cwiseAbs().maxCoeff()), forces, opening);
    if (!std::isfinite(rest_)) return false;
    if (!done && rest_ > 0.25 * before) done = rest_ <= 1e-11 * size;
    size = std::max(size, forces.cwiseAbs().maxCoeff());
  }
  valid_ = done;
  return done;
}

bool PointRows::solve(Vector& forces, Vector& opening, Vector& z, InterfaceSystems& counts) {
  const InterfaceSolver choice = problem_->model->solver;
  const bool same = same_kinds(), kept = valid_ && same && choice == InterfaceSolver::automatic;
  forces.resize(compliance_.rows());
  if (!same) {
    list_unknowns();
    unknown_.head(unknowns_).setZero();
  }
  double size = start(forces, opening);
  if (!std::isfinite(size)) return false;
  const bool alone = choice == InterfaceSolver::krylov || (choice == InterfaceSolver::automatic && !kept && unknowns_ >= enough_to_iterate);
  bool done = unknowns_ == 0;
  if (!done && kept) done = iterate(std::clamp(static_cast<int>(unknowns_ / 64), 3, most_with_factor), size, forces, opening);
  if (!done && alone) done = iterate_alone(size, forces, opening);
  if (unknowns_ > 0) ++(done ? counts.iterated : counts.factored);
  if (!done) done = factor_and_correct(size, forces, opening);
  if (!done) unknown_.setZero();
  z.noalias() = -problem_->model->factor.transpose() * forces;
  return done;
}

}  // namespace uplift
