#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "uplift/model/model.h"

// What a structure is marched under when a basis is made for it (docs/theory/reduced_models.md, R4 and R9).
namespace uplift {

/// One bell of the duration 1/f.
class Bell final : public TimeFunction {
 public:
  explicit Bell(double frequency);
  double value(double time) const override;
  double rate(double time) const override;
  double acceleration(double time) const override;

 private:
  bool inside(double time) const;
  double w_;
};

/// A sweep through all frequencies up to f in one second: what the basis was not made of. Derivatives are not needed.
class Sweep final : public TimeFunction {
 public:
  explicit Sweep(double frequency) : frequency_(frequency) {}
  double value(double time) const override;
  double rate(double) const override { return 0; }
  double acceleration(double) const override { return 0; }

 private:
  double frequency_;
};

/// Numbers +1 and -1, always the same ones.
Matrix signs(Index rows, Index columns);

/// Random bells on every row, and others in every column: one begins every half a duration with the sign +1 or -1. The answers have on
/// average the products that those to single bells on every row have, summed over rows and times (R9).
class RandomBells {
 public:
  static constexpr Index columns = 32;  // of the march
  /// `rows`: rows x free unknowns.
  RandomBells(double frequency, const Sparse& rows, double duration);
  /// Fills the rows of the loaded unknowns; the others are zero from the start of the march.
  void at(double time, Matrix& load) const;

 private:
  Bell bell_;
  double distance_;
  std::vector<int> loaded_;  // unknowns
  Matrix on_loaded_;         // loaded unknowns x rows
  Matrix signs_;
};

/// The loads of a model that change with time, all of them under the same function. Those of a wave come with what its free field puts on
/// the sides, as they do in every run: without it the structure would stand in ground that moves otherwise.
class TrainingLoads {
 public:
  TrainingLoads(const Model& model, const std::shared_ptr<const TimeFunction>& function, double step, double duration);
  Index count() const { return std::ssize(loads_); }
  Vector at(Index k, double time) const;

 private:
  struct One {
    const Vector* shape;
    std::vector<std::pair<const Sparse*, std::shared_ptr<const TimeFunctions>>> tables;
  };
  std::shared_ptr<const TimeFunction> function_;
  std::vector<One> loads_;
};

}  // namespace uplift
