#include "uplift/run/pictures.h"

#include <utility>

#include "uplift/model/reduced.h"

namespace uplift {

Pictures::Pictures(const Model& model, const RunPlan& plan, std::vector<Frame>& frames)
    : model_(model), plan_(plan), frames_(frames), waits_(is_reduced(model)) {
  if (waits_) coordinates_.setZero(together, model.free());
}

void Pictures::add(Frame frame, const State& state) {
  frames_.push_back(std::move(frame));
  if (!waits_) {
    frames_.back().displacement = displacement(state.instant(), state.displacement);
    return;
  }
  coordinates_.row(std::ssize(instant_)) = state.displacement.transpose();
  instant_.push_back(state.instant());
  if (std::ssize(instant_) == together) finish();
}

void Pictures::finish() {
  if (instant_.empty()) return;
  std::vector<Vector*> missing;
  for (auto frame = frames_.end() - std::ssize(instant_); frame != frames_.end(); ++frame) missing.push_back(&frame->displacement);
  make<together>(coordinates_, instant_, missing);
  instant_.clear();
}

Vector Pictures::displacement(MotionInstant at, const Vector& coordinates) const {
  Vector made;
  if (waits_) {
    make<1>(coordinates.transpose(), {at}, {&made});
    return made;
  }
  if (plan_.pictured.empty()) return model_.full(coordinates, 0, at);
  made.resize(count());
  for (Index i = 0; i < made.size(); ++i) made[i] = model_.full(unknown(i), coordinates, 0, at);
  return made;
}

Index Pictures::count() const {
  return plan_.pictured.empty() ? model_.full_unknowns() : model_.space.unknowns() * std::ssize(plan_.pictured);
}

int Pictures::unknown(Index i) const {
  const int each = model_.space.unknowns();
  return plan_.pictured.empty() ? static_cast<int>(i)
                                : each * plan_.pictured[static_cast<std::size_t>(i / each)] + static_cast<int>(i % each);
}

template <int Rows>
void Pictures::make(const Matrix& coordinates, const std::vector<MotionInstant>& at, const std::vector<Vector*>& displacements) const {
  for (Vector* displacement : displacements) displacement->resize(count());
  for (Index i = 0; i < count(); ++i) {
    Eigen::Array<double, Rows, 1> sum = Eigen::Array<double, Rows, 1>::Zero();
    for (Sparse::InnerIterator entry(model_.expansion, unknown(i)); entry; ++entry)
      sum += entry.value() * coordinates.col(entry.row()).array();
    for (std::size_t k = 0; k < displacements.size(); ++k) (*displacements[k])[i] = sum[static_cast<Index>(k)];
  }
  for (const PrescribedMotion& motion : model_.motions)
    for (std::size_t k = 0; k < displacements.size(); ++k) {
      const double value = at[k].share * motion.function->value(at[k].time);
      for (Index i = 0; i < count(); ++i) (*displacements[k])[i] += value * motion.shape[unknown(i)];
    }
}

}  // namespace uplift
