#include "uplift/reduction/training.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "uplift/dynamics/bulk.h"
#include "uplift/model/mechanism.h"
#include "uplift/reduction/linear_march.h"
#include "uplift/reduction/pod.h"

namespace uplift {

namespace {

constexpr Index columns_at_once = 16, snapshots_at_once = 320;
constexpr Index most_rows = 200;    // more interface rows than this are loaded in random combinations
constexpr double load_weight = 10;  // of the answers to loads against those of the interface rows
constexpr double longest = 3;       // s: of a march
constexpr double decayed = 1e-6;    // share of the largest energy at which a march ends
constexpr double dropped = 1e-9;    // share of the largest singular value
constexpr int snapshot_every = 2, steps_of_bell = 8;

/// One bell of the duration 1/f.
double bell(double time, double frequency) {
  const double phase = std::numbers::pi * time * frequency;
  return time * frequency < 1 ? std::sin(phase) * std::sin(phase) : 0;
}

/// A sweep through all frequencies up to f in one second: what the basis was not made of.
double sweep(double time, double frequency) {
  if (time > 1) return 0;
  return std::sin(std::numbers::pi * time) * std::sin(std::numbers::pi * frequency * time * time);
}

/// Numbers +1 and -1, always the same ones.
Matrix signs(Index rows, Index columns) {
  std::mt19937 random(1);
  Matrix drawn(rows, columns);
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i) drawn(i, j) = (random() & 1U) != 0 ? 1 : -1;
  return drawn;
}

/// Patterns of the loads that change with time.
Matrix load_patterns(const Model& model) {
  std::vector<const Vector*> shapes;
  for (const TimeLoad& load : model.time_loads)
    if (!load.constant && !load.shape.isZero(0)) shapes.push_back(&load.shape);
  Matrix patterns(model.free(), std::ssize(shapes));
  for (std::size_t k = 0; k < shapes.size(); ++k) patterns.col(static_cast<Index>(k)) = *shapes[k];
  return patterns;
}

class Trainer {
 public:
  Trainer(const Model& model, const LinearSolver& solver, const TrainingOptions& options)
      : model_(model),
        solver_(solver),
        options_(options),
        w_(2 * std::numbers::pi * options.frequency),
        product_(model.stiffness, model.mass, w_),
        march_(model.stiffness, model.damping, model.mass, 1 / (steps_of_bell * options.frequency), solver),
        b_(stack_interfaces(model)),
        loads_(load_patterns(model)),
        rigid_(model.free(), 0),
        pod_(product_, model.free(), dropped, options.most) {}

  Basis make() {
    Basis basis;
    basis.energy_frequency = w_;
    basis.why = march_.why();
    if (!basis.why.empty()) return basis;
    const Matrix loose = unresisted_motions(model_, std::vector<char>(static_cast<std::size_t>(b_.rows()), 0));
    for (Index k = 0; k < loose.cols(); ++k) append(product_, loose.col(k), 1e-8, rigid_);
    const Matrix rows = row_patterns();
    const bool tables = !model_.time_load_tables.empty();
    columns_ = rows.cols() + loads_.cols() + (tables ? 1 : 0);
    for (Index first = 0; first < rows.cols(); first += columns_at_once)
      add_bells(rows.middleCols(first, std::min(columns_at_once, rows.cols() - first)), 1);
    for (Index k = 0; k < loads_.cols(); ++k) add_bells(loads_.col(k), load_weight);
    if (tables)  // their functions belong together: those of the case's own motion
      add([&](double time, Matrix& load) { load.setZero(), add_load(time, load); }, 1, options_.duration, load_weight);
    basis.columns = static_cast<int>(columns_);
    basis.rigid = static_cast<int>(rigid_.cols());
    if (stopped_) basis.why = "interrupted";
    if (!basis.why.empty()) return basis;
    all_.resize(model_.free(), rigid_.cols() + pod_.basis().cols());
    all_ << rigid_, pod_.basis();
    choose_size(basis);
    return basis;
  }

 private:
  Matrix row_patterns() const {
    if (b_.rows() <= most_rows) return b_.transpose();
    return b_.transpose() * signs(b_.rows(), most_rows);
  }

  void add_load(double time, Matrix& load) const {
    Vector force = Vector::Zero(model_.free());
    model_.add_varying_force(time, force);
    load.col(0) += force;
  }

  void add_bells(const Matrix& patterns, double weight) {
    const double frequency = options_.frequency;
    const auto load = [&](double time, Matrix& at) { at = bell(time, frequency) * patterns; };
    add(load, patterns.cols(), longest, weight);
  }

  /// What is no motion of the loose parts.
  Matrix without_rigid(const Matrix& x) const {
    if (rigid_.cols() == 0) return x;
    return x - rigid_ * (rigid_.transpose() * product_.times(x));
  }

  /// The answers to some loads, with the same energy on average as those of any others times the weight.
  void add(const LinearMarch::Load& load, Index columns, double duration, double weight) {
    if (stopped_) return;
    Pod own(product_, model_.free(), dropped, options_.most);
    Matrix kept(model_.free(), 0), taken(model_.free(), snapshots_at_once);
    Index count = 0;
    const auto flush = [&] {
      if (count > 0) own.add(taken.leftCols(count));
      count = 0;
    };
    march_.start(columns);
    double most = 0;
    for (long step = 1; march_.time() < duration; ++step) {
      march_.advance(load);
      if (step % snapshot_every != 0) continue;
      if (count + columns > snapshots_at_once) flush();
      taken.middleCols(count, columns) = without_rigid(march_.displacement());
      count += columns;
      if (march_.time() * options_.frequency <= 1) continue;
      const double energy = energy_now();
      most = std::max(most, energy);
      if (columns > 1 || duration <= longest)
        if (energy <= decayed * most) break;
    }
    flush();
    done_ += columns;
    if (options_.go_on && !options_.go_on(static_cast<double>(done_) / static_cast<double>(columns_))) stopped_ = true;
    const double size = own.values().norm();
    if (size > 0) pod_.add(own.basis() * (weight * std::sqrt(static_cast<double>(columns)) / size * own.values()).asDiagonal());
  }

  double energy_now() const {
    const Matrix moving = without_rigid(march_.velocity());
    return march_.displacement().cwiseProduct(model_.stiffness * march_.displacement()).sum() +
           moving.cwiseProduct(model_.mass * moving).sum();
  }

  /// Marches the sweep with the whole model, then with leading vectors of the basis until the openings and velocities agree.
  void choose_size(Basis& basis) {
    const Index all = all_.cols(), least = std::min<Index>(all, rigid_.cols() + 10);
    Matrix patterns(model_.free(), (b_.rows() > 0 ? 3 : 0) + loads_.cols());
    if (b_.rows() > 0) patterns.leftCols(3) = b_.transpose() * signs(b_.rows(), 3);
    patterns.rightCols(loads_.cols()) = loads_;
    Sparse floors(std::ssize(options_.floors), model_.free());
    std::vector<Triplet> entries;
    for (std::size_t k = 0; k < options_.floors.size(); ++k)
      for (Sparse::InnerIterator entry(model_.expansion, options_.floors[k]); entry; ++entry)
        entries.emplace_back(static_cast<int>(k), static_cast<int>(entry.row()), entry.value());
    floors.setFromTriplets(entries.begin(), entries.end());
    const std::vector<Matrix> full = answers(march_, patterns, b_, floors);
    const Matrix k = all_.transpose() * (model_.stiffness * all_), c = all_.transpose() * (model_.damping * all_),
                 m = all_.transpose() * (model_.mass * all_), f = all_.transpose() * patterns, of_rows = b_ * all_,
                 of_floors = floors * all_;
    const auto error = [&](Index size) {
      const auto block = [&](const Matrix& a) -> Sparse {
        const Matrix leading = a.topLeftCorner(size, size);
        return Matrix(0.5 * (leading + leading.transpose())).sparseView(1, 0);
      };
      const Sparse stiffness = block(k), damping = block(c), mass = block(m);
      LinearMarch march(stiffness, damping, mass, 1 / (steps_of_bell * options_.frequency), solver_);
      return march.why().empty() ? difference(full, answers(march, f.topRows(size), Sparse(of_rows.leftCols(size).sparseView(1, 0)),
                                                            Sparse(of_floors.leftCols(size).sparseView(1, 0))))
                                 : 1.0;
    };
    Index size = options_.size > 0 ? std::min<Index>(options_.size, all) : least;
    basis.transfer_error = error(size);
    while (options_.size == 0 && basis.transfer_error > options_.target && size < all) {
      size = std::min<Index>(size + 10, all);
      basis.transfer_error = error(size);
    }
    basis.vectors = all_.leftCols(size);
  }

  /// Openings and velocities of floors over time, one matrix for each kind and load: rows x times.
  std::vector<Matrix> answers(LinearMarch& march, const Matrix& patterns, const Sparse& rows, const Sparse& floors) const {
    const double frequency = options_.frequency;
    const Index steps = std::lround(1.5 * steps_of_bell * frequency), columns = patterns.cols();
    std::vector<Matrix> found(static_cast<std::size_t>(2 * columns));
    for (Index j = 0; j < columns; ++j) {
      found[static_cast<std::size_t>(j)].resize(rows.rows(), steps);
      found[static_cast<std::size_t>(columns + j)].resize(floors.rows(), steps);
    }
    march.start(columns);
    for (Index step = 0; step < steps; ++step) {
      march.advance([&](double time, Matrix& load) { load = sweep(time, frequency) * patterns; });
      const Matrix opening = rows * march.displacement(), speed = floors * march.velocity();
      for (Index j = 0; j < columns; ++j) {
        found[static_cast<std::size_t>(j)].col(step) = opening.col(j);
        found[static_cast<std::size_t>(columns + j)].col(step) = speed.col(j);
      }
    }
    return found;
  }

  static double difference(const std::vector<Matrix>& full, const std::vector<Matrix>& reduced) {
    double most = 0;
    for (std::size_t k = 0; k < full.size(); ++k)
      if (const double size = full[k].norm(); size > 0) most = std::max(most, (full[k] - reduced[k]).norm() / size);
    return most;
  }

  const Model& model_;
  const LinearSolver& solver_;
  const TrainingOptions& options_;
  double w_;
  EnergyProduct product_;
  LinearMarch march_;
  Sparse b_;
  Matrix loads_, rigid_, all_;
  Pod pod_;
  Index columns_ = 0, done_ = 0;
  bool stopped_ = false;
};

}  // namespace

Basis train(const Model& model, const LinearSolver& solver, const TrainingOptions& options) {
  return Trainer(model, solver, options).make();
}

}  // namespace uplift
