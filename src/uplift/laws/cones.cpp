#include <cmath>

#include "uplift/laws/law.h"

// Cones: what a contact constraint allows. In the tension-positive sign p_n <= 0, and |p_t| <= -mu p_n with friction mu.
// The projection is that of the augmented Lagrangian of Alart & Curnier (Comput. Methods Appl. Mech. Eng. 92, 1991): first the normal
// force,
//     p_n = min(q_n, 0),        p_t = q_t when |q_t| <= b = -mu p_n, else b q_t/|q_t|,
// so that slip does not lift the faces (an orthogonal projection on the cone would).
namespace uplift {
namespace {

/// p_n = min(q_n, 0) for all points; the slope's other entries become zero.
void project_normal(const Batch& batch, const double* trial, double* force, double* slope) {
  const int n = batch.points, normal = batch.normal(), entries = batch.components * batch.components;
  if (slope != nullptr) {
    for (int i = 0; i < (entries - 1) * n; ++i) slope[i] = 0;
    double* last = slope + (entries - 1) * n;
    for (int i = 0; i < n; ++i) last[i] = trial[normal + i] < 0 ? 1 : 0;
  }
#pragma omp simd
  for (int i = 0; i < n; ++i) force[normal + i] = trial[normal + i] > 0 ? 0 : trial[normal + i];
}

class Unilateral final : public Cone {
 public:
  double friction() const override { return 0; }
  void project(const Batch& batch, const double* trial, double* force, double* slope) const override {
    project_normal(batch, trial, force, slope);
    for (int i = 0; i < batch.normal(); ++i) force[i] = 0;
  }
};

class Coulomb final : public Cone {
 public:
  explicit Coulomb(double friction) : friction_(friction) {}
  double friction() const override { return friction_; }

  void project(const Batch& batch, const double* trial, double* force, double* slope) const override {
    const int n = batch.points, tangents = batch.components - 1;
    project_normal(batch, trial, force, slope);
    for (int i = 0; i < n; ++i) {
      double direction[2] = {};
      for (int c = 0; c < tangents; ++c) direction[c] = trial[c * n + i];
      const double size = std::hypot(direction[0], direction[1]), bound = -friction_ * force[batch.normal() + i];
      const bool slips = size > bound;
      for (int c = 0; c < tangents; ++c) {
        if (slips) direction[c] /= size;
        force[c * n + i] = slips ? bound * direction[c] : direction[c];
      }
      if (slope == nullptr) continue;
      for (int r = 0; r < tangents; ++r) {
        double* row = slope + r * batch.components * n + i;
        row[r * n] = slips ? bound / size : 1;
        if (!slips) continue;
        for (int c = 0; c < tangents; ++c) row[c * n] -= bound / size * direction[r] * direction[c];
        row[tangents * n] = bound > 0 ? -friction_ * direction[r] : 0;
      }
    }
  }

 private:
  double friction_;
};

}  // namespace

const Entry<Cone>& entry_cone_unilateral() {
  static const Entry<Cone> entry{{.name = "unilateral",
                                  .summary = "rigid contact without tension and without friction, by constraint",
                                  .equations = "g >= 0, p <= 0, p g = 0",
                                  .source = "Signorini; Cherubini, Richard & Frau, section 2",
                                  .params = {}},
                                 [](const Values&) -> std::unique_ptr<const Cone> { return std::make_unique<Unilateral>(); }};
  return entry;
}

const Entry<Cone>& entry_cone_coulomb() {
  static const Entry<Cone> entry{
      {.name = "coulomb",
       .summary = "rigid contact without tension, with Coulomb friction, by constraint",
       .equations = "g >= 0, p_n <= 0, p_n g = 0\n"
                    "|p_t| <= -friction p_n; where it slips, p_t reaches the bound and points along the slip (conjugate to the opening)",
       .source = "Coulomb; projection of Alart & Curnier (1991)",
       .params = {number("friction", "1", "coefficient of friction").nonnegative()}},
      [](const Values& values) -> std::unique_ptr<const Cone> { return std::make_unique<Coulomb>(values.number("friction")); }};
  return entry;
}

}  // namespace uplift
