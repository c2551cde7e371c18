#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "uplift/base/error.h"
#include "uplift/elements/beam.h"
#include "uplift/elements/discrete.h"
#include "uplift/math/dense.h"
#include "uplift/model/builder.h"
#include "uplift/model/check.h"

// What several tests of elements, interfaces and models share.
namespace uplift::support {

inline const Where here{"case.toml", 7};

/// How the model can move without resistance with its interfaces closed, in words; empty when it cannot.
inline std::string loose_part(const Model& model, Resistance resistance = Resistance::stiffness) {
  const Vector motion = unresisted_motion(model, resistance);
  return motion.size() == 0 ? std::string() : describe_motion(model, motion);
}

/// A linear joint: traction = stiffness * opening per component.
class LinearLaw : public InterfaceLaw {
 public:
  explicit LinearLaw(std::vector<double> stiffness) : stiffness_(std::move(stiffness)) {}
  int num_history(int) const override { return 0; }
  void respond(const Batch& batch, const double*, const double* to, const double*, const LawResponse& response) const override {
    for (int c = 0; c < batch.components; ++c)
      for (int i = 0; i < batch.points; ++i) response.traction[c * batch.points + i] = stiffness_[c] * to[c * batch.points + i];
  }
  void mean(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const override {
    respond(batch, from, to, old, response);
  }
  void energy(const Batch&, const double*, const double*, double*, double*) const override {}
  void closed_stiffness(int components, double* stiffness) const override { std::copy_n(stiffness_.begin(), components, stiffness); }

 private:
  std::vector<double> stiffness_;
};

class HardCone : public Cone {
 public:
  explicit HardCone(double friction) : friction_(friction) {}
  double friction() const override { return friction_; }
  void project(const Batch& batch, const double* trial, double* force, double*) const override {
    for (int i = 0; i < batch.points; ++i) force[batch.normal() + i] = std::min(trial[batch.normal() + i], 0.0);
  }

 private:
  double friction_;
};

/// f(t) = 1 + 2 t + 3 t^2.
class Parabola : public TimeFunction {
 public:
  double value(double t) const override { return 1 + 2 * t + 3 * t * t; }
  double rate(double t) const override { return 2 + 6 * t; }
  double acceleration(double) const override { return 6; }
};

/// f(t) = 1.
class Steady : public TimeFunction {
 public:
  double value(double) const override { return 1; }
  double rate(double) const override { return 0; }
  double acceleration(double) const override { return 0; }
};

inline InterfaceSpec linear_interface(std::string name, std::vector<JointPoint> points, std::vector<double> stiffness) {
  InterfaceSpec spec;
  spec.name = std::move(name);
  spec.components = static_cast<int>(stiffness.size());
  spec.points = std::move(points);
  spec.law = std::make_unique<LinearLaw>(std::move(stiffness));
  return spec;
}

inline void add_beam(ModelBuilder& builder, int a, int b, Vec2 xa, Vec2 xb, const BeamSection& section) {
  builder.add_element(std::make_unique<Beam>(a, b, xa, xb, section), here);
  if (!section.axial) builder.inextensible(a, b, here);
}

/// An inextensible massless beam.
inline BeamSection bending_only(double EI) {
  BeamSection section;
  section.bending = EI;
  return section;
}

/// A beam with area and mass (200 kg/m).
inline BeamSection general(double EI, double EA) {
  BeamSection section;
  section.bending = EI;
  section.axial = EA;
  section.mass = BeamSection::Mass::consistent;
  section.mass_per_length = 200;
  return section;
}

/// Displacement under all drives at a time.
inline Vector static_solution(const Model& model, double time = 0) {
  Vector force = Vector::Zero(model.free());
  model.add_force(time, force);
  return PivotedLdlt(Matrix(model.stiffness)).solve(force);
}

/// A rigid block (2000 kg) on a footing 3 m wide with 7 joints, its centre above.
inline std::unique_ptr<ModelBuilder> block_on_ground(double height, Vec2 normal, bool with_gravity) {
  auto builder = std::make_unique<ModelBuilder>();
  builder->add_node("block", {0, height}, here);
  builder->add_element(std::make_unique<PointMass>(0, 2000.0, 700.0), here);
  builder->add_interface(linear_interface("base", footing_points({.body = 0, .normal = normal, .width = 3, .points = 7}, here), {4e6, 1e7}),
                         here);
  if (with_gravity) builder->set_gravity({0, -10}, here);
  return builder;
}

/// Message of the InputError that a call throws; empty when it throws none.
template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace uplift::support
