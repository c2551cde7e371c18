#include "uplift/reduction/training.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <utility>

#include "uplift/dynamics/bulk.h"
#include "uplift/model/mechanism.h"
#include "uplift/model/wave_functions.h"
#include "uplift/reduction/linear_march.h"
#include "uplift/reduction/pod.h"

namespace uplift {

namespace {

constexpr Index columns_at_once = 16, snapshots_at_once = 320;
constexpr Index most_rows = 200;    // more interface rows than this are loaded in random combinations
constexpr Index beside = 10;        // coordinates beside the exact ones at least
constexpr double load_weight = 10;  // of the answers to loads against those of the interface rows
constexpr double longest = 3;       // s: of a march
constexpr double decayed = 1e-6;    // share of the largest energy at which a march ends
constexpr double dropped = 1e-9;    // share of the largest singular value
constexpr int snapshot_every = 2, steps_of_bell = 8;

/// One bell of the duration 1/f.
class Bell final : public TimeFunction {
 public:
  explicit Bell(double frequency) : w_(2 * std::numbers::pi * frequency) {}
  double value(double time) const override { return inside(time) ? (1 - std::cos(w_ * time)) / 2 : 0; }
  double rate(double time) const override { return inside(time) ? w_ * std::sin(w_ * time) / 2 : 0; }
  double acceleration(double time) const override { return inside(time) ? w_ * w_ * std::cos(w_ * time) / 2 : 0; }

 private:
  bool inside(double time) const { return time >= 0 && w_ * time < 2 * std::numbers::pi; }
  double w_;
};

/// A sweep through all frequencies up to f in one second: what the basis was not made of. Derivatives are not needed.
class Sweep final : public TimeFunction {
 public:
  explicit Sweep(double frequency) : frequency_(frequency) {}
  double value(double time) const override {
    if (time > 1) return 0;
    return std::sin(std::numbers::pi * time) * std::sin(std::numbers::pi * frequency_ * time * time);
  }
  double rate(double) const override { return 0; }
  double acceleration(double) const override { return 0; }

 private:
  double frequency_;
};

/// Numbers +1 and -1, always the same ones.
Matrix signs(Index rows, Index columns) {
  std::mt19937 random(1);
  Matrix drawn(rows, columns);
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i) drawn(i, j) = (random() & 1U) != 0 ? 1 : -1;
  return drawn;
}

/// The loads of a model that change with time, all of them under the same function. Those of a wave come with what its free field puts on
/// the sides, as they do in every run: without it the structure would stand in ground that moves otherwise.
class Loads {
 public:
  Loads(const Model& model, const std::shared_ptr<const TimeFunction>& function, double step, double duration) : function_(function) {
    for (const TimeLoad& load : model.time_loads) {
      if (load.constant || load.shape.isZero(0)) continue;
      One one{&load.shape, {}};
      for (const TimeLoadTable& table : model.time_load_tables)
        if (const auto* wave = dynamic_cast<const WaveFunctions*>(table.functions.get()); wave != nullptr && wave->load() == load.name)
          one.tables.emplace_back(&table.pattern, wave->under(function, step, duration));
      loads_.push_back(std::move(one));
    }
  }
  Index count() const { return std::ssize(loads_); }
  Vector at(Index k, double time) const {
    const One& one = loads_[static_cast<std::size_t>(k)];
    Vector force = function_->value(time) * *one.shape, values;
    for (const auto& [pattern, functions] : one.tables) {
      functions->values(time, values);
      force += *pattern * values;
    }
    return force;
  }

 private:
  struct One {
    const Vector* shape;
    std::vector<std::pair<const Sparse*, std::shared_ptr<const TimeFunctions>>> tables;
  };
  std::shared_ptr<const TimeFunction> function_;
  std::vector<One> loads_;
};

class Trainer {
 public:
  Trainer(const Model& model, const LinearSolver& solver, const TrainingOptions& options)
      : model_(model),
        solver_(solver),
        options_(options),
        w_(2 * std::numbers::pi * options.frequency),
        product_(model.stiffness, model.mass, w_),
        step_(1 / (steps_of_bell * options.frequency)),
        march_(model.stiffness, model.damping, model.mass, step_, solver),
        b_(stack_interfaces(model)),
        bell_(std::make_shared<const Bell>(options.frequency)),
        loads_(model, bell_, step_, longest),
        rigid_(model.free(), 0),
        pod_(product_, model.free(), dropped, options.most) {}

  Basis make() {
    Basis basis;
    basis.energy_frequency = w_;
    basis.why = march_.why();
    if (!basis.why.empty()) return basis;
    const Matrix loose = unresisted_motions(model_, std::vector<char>(static_cast<std::size_t>(b_.rows()), 0));
    for (Index k = 0; k < loose.cols(); ++k) append(product_, loose.col(k), 1e-8, rigid_);
    exact_ = with_static_answers();
    weighted_ = product_.times(exact_);
    const Matrix rows = row_patterns();
    columns_ = rows.cols() + loads_.count();
    for (Index first = 0; first < rows.cols(); first += columns_at_once) {
      const Matrix some = rows.middleCols(first, std::min(columns_at_once, rows.cols() - first));
      add([&](double time, Matrix& load) { load = bell_->value(time) * some; }, some.cols(), 1);
    }
    for (Index k = 0; k < loads_.count(); ++k) add([&](double time, Matrix& load) { load = loads_.at(k, time); }, 1, load_weight);
    basis.columns = static_cast<int>(columns_);
    basis.rigid = static_cast<int>(rigid_.cols());
    if (stopped_) basis.why = "interrupted";
    if (!basis.why.empty()) return basis;
    all_.resize(model_.free(), exact_.cols() + pod_.basis().cols());
    all_ << exact_, pod_.basis();
    choose_size(basis);
    return basis;
  }

 private:
  /// The loose motions, and the static answers to a force at every row of the interfaces: with them every row has its own flexibility,
  /// however few coordinates follow. A loose part rests on its inertia at a tenth of the frequency of the basis. Too many rows, or too few
  /// coordinates for them: the loose motions alone.
  Matrix with_static_answers() const {
    Matrix exact = rigid_;
    if (b_.rows() == 0 || b_.rows() > most_rows) return exact;
    const Factorisation made = solver_.factorise(model_.stiffness + (0.01 * w_ * w_) * model_.mass);
    if (made.factor == nullptr) return exact;  // an unknown that a dashpot alone holds
    Matrix answers;
    made.factor->solve(b_.transpose(), answers);
    for (Index k = 0; k < answers.cols(); ++k) append(product_, answers.col(k), 1e-8, exact);
    return options_.size == 0 || options_.size >= exact.cols() + beside ? exact : rigid_;
  }

  Matrix row_patterns() const {
    if (b_.rows() <= most_rows) return b_.transpose();
    return b_.transpose() * signs(b_.rows(), most_rows);
  }

  /// What the first exact vectors leave of x.
  Matrix without(Index count, const Matrix& x) const { return x - exact_.leftCols(count) * (weighted_.leftCols(count).transpose() * x); }

  /// The answers to some loads, with the same energy on average as those of any others times the weight.
  void add(const LinearMarch::Load& load, Index columns, double weight) {
    if (stopped_) return;
    Pod own(product_, model_.free(), dropped, options_.most);
    Matrix kept(model_.free(), 0), taken(model_.free(), snapshots_at_once);
    Index count = 0;
    const auto flush = [&] {
      if (count > 0) own.add(taken.leftCols(count));
      count = 0;
    };
    march_.start(columns);
    double most = 0, all = 0;
    for (long step = 1; march_.time() < longest; ++step) {
      march_.advance(load);
      if (step % snapshot_every != 0) continue;
      if (count + columns > snapshots_at_once) flush();
      const Matrix& answer = march_.displacement();
      all += answer.cwiseProduct(product_.times(answer)).sum();
      taken.middleCols(count, columns) = without(exact_.cols(), answer);
      count += columns;
      if (march_.time() * options_.frequency <= 1) continue;
      const double energy = energy_now();
      most = std::max(most, energy);
      if (energy <= decayed * most) break;
    }
    flush();
    done_ += columns;
    if (options_.go_on && !options_.go_on(static_cast<double>(done_) / static_cast<double>(columns_))) stopped_ = true;
    const double size = own.values().norm();  // round-off where the exact vectors are the whole answer
    if (size > dropped * std::sqrt(all))
      pod_.add(own.basis() * (weight * std::sqrt(static_cast<double>(columns)) / size * own.values()).asDiagonal());
  }

  double energy_now() const {
    const Matrix moving = without(rigid_.cols(), march_.velocity());
    return march_.displacement().cwiseProduct(model_.stiffness * march_.displacement()).sum() +
           moving.cwiseProduct(model_.mass * moving).sum();
  }

  /// Marches the sweep with the whole model, then with leading vectors of the basis until the openings and velocities agree.
  void choose_size(Basis& basis) {
    const Index all = all_.cols(), least = std::min(all, exact_.cols() + beside);
    const auto sweep = std::make_shared<const Sweep>(options_.frequency);
    const Loads loads(model_, sweep, step_, longest);
    const Matrix rows = b_.rows() > 0 ? Matrix(b_.transpose() * signs(b_.rows(), 3)) : Matrix(model_.free(), 0);
    const Index columns = rows.cols() + loads.count();
    std::vector<Matrix> forces;  // at every time, on all vectors of the basis
    const auto load = [&](double time, Matrix& at) {
      at.resize(model_.free(), columns);
      at.leftCols(rows.cols()) = sweep->value(time) * rows;
      for (Index k = 0; k < loads.count(); ++k) at.col(rows.cols() + k) = loads.at(k, time);
      forces.emplace_back(all_.transpose() * at);
    };
    Sparse floors(std::ssize(options_.floors), model_.free());
    std::vector<Triplet> entries;
    for (std::size_t k = 0; k < options_.floors.size(); ++k)
      for (Sparse::InnerIterator entry(model_.expansion, options_.floors[k]); entry; ++entry)
        entries.emplace_back(static_cast<int>(k), static_cast<int>(entry.row()), entry.value());
    floors.setFromTriplets(entries.begin(), entries.end());
    const std::vector<Matrix> full = answers(march_, columns, load, b_, floors);
    const Matrix k = all_.transpose() * (model_.stiffness * all_), c = all_.transpose() * (model_.damping * all_),
                 m = all_.transpose() * (model_.mass * all_), of_rows = b_ * all_, of_floors = floors * all_;
    const auto error = [&](Index size) {
      const auto block = [&](const Matrix& a) -> Sparse {
        const Matrix leading = a.topLeftCorner(size, size);
        return Matrix(0.5 * (leading + leading.transpose())).sparseView(1, 0);
      };
      const Sparse stiffness = block(k), damping = block(c), mass = block(m);
      LinearMarch march(stiffness, damping, mass, step_, solver_);
      const auto leading = [&](double time, Matrix& at) { at = forces[static_cast<std::size_t>(std::lround(time / step_))].topRows(size); };
      return march.why().empty() ? difference(full, answers(march, columns, leading, Sparse(of_rows.leftCols(size).sparseView(1, 0)),
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
  std::vector<Matrix> answers(LinearMarch& march, Index columns, const LinearMarch::Load& load, const Sparse& rows,
                              const Sparse& floors) const {
    const Index steps = std::lround(1.5 / step_);
    std::vector<Matrix> found(static_cast<std::size_t>(2 * columns));
    for (Index j = 0; j < columns; ++j) {
      found[static_cast<std::size_t>(j)].resize(rows.rows(), steps);
      found[static_cast<std::size_t>(columns + j)].resize(floors.rows(), steps);
    }
    march.start(columns);
    for (Index step = 0; step < steps; ++step) {
      march.advance(load);
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
  double step_;
  LinearMarch march_;
  Sparse b_;
  std::shared_ptr<const TimeFunction> bell_;
  Loads loads_;
  Matrix rigid_, exact_, weighted_, all_;  // exact: the loose motions first; weighted: times the matrix of the product
  Pod pod_;
  Index columns_ = 0, done_ = 0;
  bool stopped_ = false;
};

}  // namespace

Basis train(const Model& model, const LinearSolver& solver, const TrainingOptions& options) {
  return Trainer(model, solver, options).make();
}

}  // namespace uplift
