#include "uplift/reduction/training_loads.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "uplift/model/wave_functions.h"

namespace uplift {

Bell::Bell(double frequency) : w_(2 * std::numbers::pi * frequency) {}

double Bell::value(double time) const {
  return inside(time) ? (1 - std::cos(w_ * time)) / 2 : 0;
}

double Bell::rate(double time) const {
  return inside(time) ? w_ * std::sin(w_ * time) / 2 : 0;
}

double Bell::acceleration(double time) const {
  return inside(time) ? w_ * w_ * std::cos(w_ * time) / 2 : 0;
}

bool Bell::inside(double time) const {
  return time >= 0 && w_ * time < 2 * std::numbers::pi;
}

double Sweep::value(double time) const {
  if (time > 1) return 0;
  return std::sin(std::numbers::pi * time) * std::sin(std::numbers::pi * frequency_ * time * time);
}

Matrix signs(Index rows, Index columns) {
  std::mt19937 random(1);
  Matrix drawn(rows, columns);
  for (Index j = 0; j < columns; ++j)
    for (Index i = 0; i < rows; ++i) drawn(i, j) = (random() & 1U) != 0 ? 1 : -1;
  return drawn;
}

RandomBells::RandomBells(double frequency, const Sparse& rows, double duration)
    : bell_(frequency), distance_(0.5 / frequency), signs_(signs(rows.rows(), columns * (1 + static_cast<Index>(duration / distance_)))) {
  for (int k = 0; k < rows.cols(); ++k)
    if (Sparse::InnerIterator(rows, k)) loaded_.push_back(k);
  on_loaded_ = Matrix::Zero(std::ssize(loaded_), rows.rows());
  for (Index k = 0; k < on_loaded_.rows(); ++k)
    for (Sparse::InnerIterator entry(rows, loaded_[static_cast<std::size_t>(k)]); entry; ++entry)
      on_loaded_(k, entry.row()) = entry.value();
}

void RandomBells::at(double time, Matrix& load) const {
  const auto last = static_cast<Index>(std::floor(time / distance_ + 1e-9));
  Matrix force = Matrix::Zero(on_loaded_.cols(), columns);
  for (Index k = std::max<Index>(0, last - 1); k <= last && (k + 1) * columns <= signs_.cols(); ++k)
    force += bell_.value(time - static_cast<double>(k) * distance_) * signs_.middleCols(k * columns, columns);
  const Matrix forces = on_loaded_ * force;
  for (Index k = 0; k < forces.rows(); ++k) load.row(loaded_[static_cast<std::size_t>(k)]) = forces.row(k);
}

TrainingLoads::TrainingLoads(const Model& model, const std::shared_ptr<const TimeFunction>& function, double step, double duration)
    : function_(function) {
  for (const TimeLoad& load : model.time_loads) {
    if (load.constant || load.shape.isZero(0)) continue;
    One one{&load.shape, {}};
    for (const TimeLoadTable& table : model.time_load_tables)
      if (const auto* wave = dynamic_cast<const WaveFunctions*>(table.functions.get()); wave != nullptr && wave->load() == load.name)
        one.tables.emplace_back(&table.pattern, wave->under(function, step, duration));
    loads_.push_back(std::move(one));
  }
}

Vector TrainingLoads::at(Index k, double time) const {
  const One& one = loads_[static_cast<std::size_t>(k)];
  Vector force = function_->value(time) * *one.shape, values;
  for (const auto& [pattern, functions] : one.tables) {
    functions->values(time, values);
    force += *pattern * values;
  }
  return force;
}

}  // namespace uplift
