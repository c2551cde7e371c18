#include "uplift/run/radiation.h"

#include "uplift/math/linalg.h"

namespace uplift {

RadiationForces::RadiationForces(const Model& model, const Sparse& b) : force_(Vector::Zero(b.rows())) {
  const SparseRows by_row(b);
  int first = 0;
  for (const Interface& interface : model.interfaces) {
    const std::vector<double> damping = interface.footprint ? radiation_damping(*interface.footprint) : std::vector<double>();
    for (std::size_t k = 0; k < damping.size(); ++k) {
      Row made{first + static_cast<int>(k), damping[k], {}, {}};
      for (SparseRows::InnerIterator entry(by_row, made.row); entry; ++entry)
        made.terms.emplace_back(static_cast<int>(entry.col()), entry.value());
      for (const PrescribedMotion& motion : model.motions)
        if (motion.opening[made.row] != 0) made.motions.emplace_back(motion.function.get(), motion.opening[made.row]);
      rows_.push_back(std::move(made));
    }
    first += interface.rows();
  }
}

const Vector& RadiationForces::measure(const Stepper& stepper) {
  const State& now = stepper.state();
  const StepBalance at = stepper.averages_acceleration() ? stepper.balance(now.acceleration) : StepBalance::of_state(now, now.acceleration);
  for (const Row& row : rows_) {
    double rate = 0;
    for (const auto& [unknown, factor] : row.terms) rate += factor * at.velocity(unknown);
    for (const auto& [function, factor] : row.motions) rate += factor * at.motion(*function, 1);
    force_[row.row] = row.damping * rate;
  }
  return force_;
}

}  // namespace uplift
