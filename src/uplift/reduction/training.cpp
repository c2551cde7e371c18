#include "uplift/reduction/training.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "uplift/dynamics/bulk.h"
#include "uplift/linear/blas.h"
#include "uplift/model/mechanism.h"
#include "uplift/reduction/linear_march.h"
#include "uplift/reduction/pod.h"
#include "uplift/reduction/training_loads.h"

namespace uplift {

namespace {

constexpr Index columns_at_once = 16;
constexpr Index most_alone = 64;     // more rows than this are loaded all together, at random
constexpr Index most_static = 400;   // more interface rows than this have no static answers of their own
constexpr Index beside = 10;         // coordinates beside the exact ones at least
constexpr double load_weight = 10;   // of the answers to loads against those of the interface rows
constexpr double longest = 3;        // s: of a march
constexpr double decayed = 1e-6;     // share of the largest energy at which a march ends
constexpr double dropped = 1e-9;     // share of the largest singular value
constexpr Index most_of_load = 100;  // directions at least that the answer to each of several loads may have
constexpr int steps_of_bell = 8;
constexpr int snapshot_every = 2, snapshot_of_random_every = 5;  // steps; odd: not always at the same time of the bells

/// Snapshots that wait for their decomposition: 110 MB at most, but for very large models. The work space of a decomposition is six times
/// as large.
Index snapshots_at_once(Index unknowns) {
  return std::clamp<Index>(14'000'000 / std::max<Index>(unknowns, 1), 64, 320);
}

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
        floors_(floors(model, options)),
        bell_(std::make_shared<const Bell>(options.frequency)),
        loads_(model, bell_, step_, longest),
        rigid_(model.free(), 0),
        work_(std::make_shared<PodWork>()),
        pod_(product_, exact_, dropped, options.most, work_) {}

  Basis make() {
    Basis basis;
    basis.energy_frequency = w_;
    basis.why = march_.why();
    if (!basis.why.empty()) return basis;
    const Matrix loose = unresisted_motions(model_, std::vector<char>(static_cast<std::size_t>(b_.rows()), 0));
    for (Index k = 0; k < loose.cols(); ++k) append(product_, loose.col(k), 1e-8, rigid_);
    exact_ = with_static_answers();
    columns_ = columns_of(b_) + (options_.loads_floors ? columns_of(floors_) : 0) + loads_.count();
    answer(b_, 1);
    if (options_.loads_floors) answer(floors_, load_weight);
    add(
        [&](double time, Matrix& load) {
          load.resize(model_.free(), loads_.count());
          for (Index k = 0; k < loads_.count(); ++k) load.col(k) = loads_.at(k, time);
        },
        {.columns = loads_.count(), .groups = loads_.count(), .weight = load_weight});
    basis.columns = static_cast<int>(columns_);
    basis.rigid = static_cast<int>(rigid_.cols());
    if (stopped_) basis.why = "interrupted";
    if (!basis.why.empty()) return basis;
    num_exact_ = exact_.cols();
    collect_vectors();
    choose_size(basis);
    return basis;
  }

 private:
  /// The loose motions, and the static answers to a force at every row of the interfaces: with them every row has its own flexibility,
  /// however few coordinates follow. A loose part rests on its inertia at a tenth of the frequency of the basis. Too many rows, or too few
  /// coordinates for them: the loose motions alone.
  Matrix with_static_answers() const {
    const Index expected = rigid_.cols() + b_.rows();
    if (b_.rows() == 0 || b_.rows() > most_static || (options_.size > 0 && options_.size < expected + beside)) return rigid_;
    const Factorisation made = solver_.factorise(model_.stiffness + (0.01 * w_ * w_) * model_.mass);
    if (made.factor == nullptr) return rigid_;  // an unknown that a dashpot alone holds
    const Sparse patterns = b_.transpose();
    Matrix exact(model_.free(), expected), answers;
    exact.leftCols(rigid_.cols()) = rigid_;
    Index count = rigid_.cols();
    for (Index first = 0; first < patterns.cols(); first += columns_at_once) {
      made.factor->solve(Matrix(patterns.middleCols(first, std::min(columns_at_once, patterns.cols() - first))), answers);
      count += orthonormalise(product_, exact.leftCols(count), 1e-8, answers);
      exact.middleCols(count - answers.cols(), answers.cols()) = answers;
    }
    exact.conservativeResize(Eigen::NoChange, count);
    return exact;
  }

  static Index columns_of(const Sparse& rows) { return rows.rows() <= most_alone ? rows.rows() : RandomBells::columns; }

  /// The answers to one bell on every row; where there are many, to random bells on all of them. Each row has the energy weight^2.
  void answer(const Sparse& rows, double weight) {
    if (rows.rows() > most_alone) {
      const RandomBells bells(options_.frequency, rows, longest);
      add([&](double time, Matrix& load) { bells.at(time, load); }, {.columns = RandomBells::columns,
                                                                     .weight = weight * std::sqrt(static_cast<double>(rows.rows())),
                                                                     .every = snapshot_of_random_every});
      return;
    }
    const Matrix patterns = rows.transpose();
    for (Index first = 0; first < patterns.cols(); first += columns_at_once) {
      const Matrix some = patterns.middleCols(first, std::min(columns_at_once, patterns.cols() - first));
      add([&](double time, Matrix& load) { load = bell_->value(time) * some; },
          {.columns = some.cols(), .weight = weight * std::sqrt(static_cast<double>(some.cols()))});
    }
  }

  /// The displacements of the floors, floors x free unknowns. The reduced structure answers a floor, by reciprocity, as well as it
  /// represents both the load and the answer to a force at the floor.
  static Sparse floors(const Model& model, const TrainingOptions& options) {
    Sparse made(std::ssize(options.floors), model.free());
    std::vector<Triplet> entries;
    for (std::size_t k = 0; k < options.floors.size(); ++k)
      for (Sparse::InnerIterator entry(model.expansion, options.floors[k]); entry; ++entry)
        entries.emplace_back(static_cast<int>(k), static_cast<int>(entry.row()), entry.value());
    made.setFromTriplets(entries.begin(), entries.end());
    return made;
  }

  /// Of a march: columns that are marched together, in groups of equal size. The answers of each group get the energy weight^2.
  struct March {
    Index columns = 0, groups = 1;
    double weight = 1;
    int every = snapshot_every;  // steps
  };
  /// The answers of one group.
  struct Group {
    Pod own;
    Matrix taken;
    Index count = 0;    // of the columns that are taken
    double most = 0;    // energy
    bool over = false;  // it has decayed
    void flush() {
      if (count < taken.cols()) taken.conservativeResize(Eigen::NoChange, count);  // the last batch
      own.add(taken);
      count = 0;
    }
  };

  void add(const LinearMarch::Load& load, const March& how) {
    if (stopped_ || how.columns == 0) return;
    const Index width = how.columns / how.groups;
    const Index most = how.groups == 1 ? options_.most : std::max<Index>(most_of_load, options_.most / how.groups);
    std::vector<Group> groups;
    for (Index k = 0; k < how.groups; ++k)
      groups.push_back({Pod(product_, exact_, dropped, most, work_),
                        Matrix(model_.free(), std::max(width, snapshots_at_once(model_.free()) / how.groups))});
    march_.start(how.columns);
    for (long step = 1; march_.time() < longest && !std::ranges::all_of(groups, &Group::over); ++step) {
      march_.advance(load);
      if (!goes_on(static_cast<double>(how.columns) * march_.time() / longest)) return;
      if (step % how.every != 0) continue;
      Vector energies;  // random bells never end
      if (march_.time() * options_.frequency > 1 && how.every == snapshot_every) energies = energies_now();
      for (Index k = 0; k < how.groups; ++k) {
        Group& group = groups[static_cast<std::size_t>(k)];
        if (group.over) continue;
        if (group.count + width > group.taken.cols()) group.flush();
        group.taken.middleCols(group.count, width) = march_.displacement().middleCols(k * width, width);
        group.count += width;
        if (energies.size() == 0) continue;
        const double energy = energies.segment(k * width, width).sum();
        group.most = std::max(group.most, energy);
        group.over = energy <= decayed * group.most;
      }
    }
    done_ += how.columns;
    if (!goes_on(0)) return;
    for (Group& group : groups) {
      group.flush();
      group.taken.resize(0, 0);
      const Vector weights = group.own.values() * (how.weight / group.own.values().norm());
      // round-off where the exact vectors are the whole answer
      if (!(group.own.values().norm() > dropped * std::sqrt(group.own.energy()))) continue;
      const Matrix answers = group.own.release();
      const Index at_once = snapshots_at_once(model_.free());
      for (Index first = 0; first < answers.cols(); first += at_once) {
        const Index count = std::min(at_once, answers.cols() - first);
        Matrix weighted = answers.middleCols(first, count) * weights.segment(first, count).asDiagonal();
        pod_.add(weighted);
      }
    }
  }

  /// Tells how far the marches are, in columns beyond those that are done; false: the training ends.
  bool goes_on(double columns) {
    if (options_.go_on && !options_.go_on((static_cast<double>(done_) + columns) / static_cast<double>(columns_))) stopped_ = true;
    return !stopped_;
  }

  /// Of every column of the march; the loose motions go on for ever and do not count.
  Vector energies_now() const {
    const Matrix &displacement = march_.displacement(), &velocity = march_.velocity();
    const Matrix moving = velocity - rigid_ * (rigid_.transpose() * product_.times(velocity));
    Matrix forces = Matrix::Zero(displacement.rows(), displacement.cols()), momenta = forces;
    add_symmetric_product(1, model_.stiffness, displacement, forces);
    add_symmetric_product(1, model_.mass, moving, momenta);
    return (displacement.cwiseProduct(forces) + moving.cwiseProduct(momenta)).colwise().sum();
  }

  /// The exact vectors and those of the decomposition, which ends.
  void collect_vectors() {
    all_ = std::exchange(exact_, Matrix());
    const Matrix further = pod_.release();
    all_.conservativeResize(model_.free(), num_exact_ + further.cols());
    all_.rightCols(further.cols()) = further;
    *work_ = {};
  }

  /// Marches the sweep with the whole model, then with leading vectors of the basis until the openings and velocities agree.
  void choose_size(Basis& basis) {
    const Index all = all_.cols(), least = std::min(all, num_exact_ + beside);
    const auto sweep = std::make_shared<const Sweep>(options_.frequency);
    const TrainingLoads loads(model_, sweep, step_, longest);
    const Matrix rows = b_.rows() > 0 ? Matrix(b_.transpose() * signs(b_.rows(), 3)) : Matrix(model_.free(), 0);
    const Index columns = rows.cols() + loads.count();
    std::vector<Matrix> forces;  // at every time, on all vectors of the basis
    const auto load = [&](double time, Matrix& at) {
      at.resize(model_.free(), columns);
      at.leftCols(rows.cols()) = sweep->value(time) * rows;
      for (Index k = 0; k < loads.count(); ++k) at.col(rows.cols() + k) = loads.at(k, time);
      forces.push_back(transposed_product(all_, at));
    };
    const std::vector<Matrix> full = answers(march_, columns, load, b_, floors_);
    const Matrix k = symmetric_projection(model_.stiffness, all_), c = symmetric_projection(model_.damping, all_),
                 m = symmetric_projection(model_.mass, all_), of_rows = b_ * all_, of_floors = floors_ * all_;
    const auto error = [&](Index size) {
      const auto block = [&](const Matrix& a) -> Sparse { return Matrix(a.topLeftCorner(size, size)).sparseView(1, 0); };
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
    all_.conservativeResize(Eigen::NoChange, size);
    basis.vectors = std::move(all_);
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
  Sparse b_, floors_;  // rows of the interfaces, displacements of the floors; x free unknowns
  std::shared_ptr<const TimeFunction> bell_;
  TrainingLoads loads_;
  Matrix rigid_, exact_, all_;  // exact: the loose motions first
  std::shared_ptr<PodWork> work_;
  Pod pod_;
  Index num_exact_ = 0, columns_ = 0, done_ = 0;
  bool stopped_ = false;
};

}  // namespace

Basis train(const Model& model, const LinearSolver& solver, const TrainingOptions& options) {
  return Trainer(model, solver, options).make();
}

}  // namespace uplift
