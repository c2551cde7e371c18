// Beams against closed forms. Roots of the frequency equations are computed here, to round-off, by bisection.
#include <gtest/gtest.h>

#include <functional>

#include "unit/model/model_support.h"
#include "uplift/linear/solver.h"
#include "uplift/math/dense.h"
#include "uplift/model/geometric.h"
#include "verification/manual.h"

namespace uplift::beams_test {
namespace {

using std::numbers::pi;
using support::here;

double root(const std::function<double(double)>& f, double low, double high) {
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (f(low) * f(middle) <= 0 ? high : low) = middle;
  }
  return low;
}

struct Frame {
  double EI = 2.5e7, length = 3, angle = 0.7, rho_a = 240;
  int elements = 4;
  double tip_mass = 0;
  bool extensible = true;
  double EA = 1e11;  // so stiff that the first three bending modes come first
  BeamSection::Mass mass = BeamSection::Mass::consistent;
};

Model cantilever(const Frame& frame) {
  ModelBuilder builder;
  const Vec2 along(std::cos(frame.angle), std::sin(frame.angle));
  for (int i = 0; i <= frame.elements; ++i) builder.add_node("n" + std::to_string(i), frame.length * i / frame.elements * along, here);
  BeamSection section;
  section.bending = frame.EI;
  if (frame.extensible) section.axial = frame.EA;
  section.mass = frame.mass;
  section.mass_per_length = frame.rho_a;
  for (int i = 0; i < frame.elements; ++i)
    support::add_beam(builder, i, i + 1, frame.length * i / frame.elements * along, frame.length * (i + 1) / frame.elements * along,
                      section);
  for (const Dof dof : {ux, uy, rz}) builder.fix(0, dof, here);
  if (frame.tip_mass > 0) builder.add_element(std::make_unique<PointMass>(frame.elements, frame.tip_mass), here);
  return builder.finish();
}

/// beta L of mode k from the program's frequency.
double beta_l(const Frame& frame, int k) {
  const Model model = cantilever(frame);
  const double w = 2 * pi * modes(model.stiffness, model.mass, k + 1)[k].frequency;
  return std::sqrt(w * frame.length * frame.length * std::sqrt(frame.rho_a / frame.EI));
}

TEST(Cantilever, FrequenciesAndTheirOrder) {
  VERIFIES({"Beams", "Natural frequencies of a cantilever",
            "Euler-Bernoulli frequency equation cos x cosh x + 1 = 0, solved by bisection; Blevins, Formulas for Natural Frequency and "
            "Mode Shape (1979)"});
  const auto equation = [](double x) { return std::cos(x) * std::cosh(x) + 1; };
  const double exact[] = {root(equation, 1.5, 2.5), root(equation, 4, 5.5), root(equation, 7, 8.5)};
  VERIFY_NEAR("βL of mode 1, root of the frequency equation", "1", exact[0], 1.8751040687, 1e-10);
  VERIFY_NEAR("βL of mode 2, root of the frequency equation", "1", exact[1], 4.6940911330, 1e-10);
  VERIFY_NEAR("βL of mode 3, root of the frequency equation", "1", exact[2], 7.8547574382, 1e-10);
  for (const bool extensible : {true, false})
    for (int k = 0; k < 3; ++k) {
      Frame frame;
      frame.extensible = extensible;
      double errors[3];
      for (int level = 0; level < 3; ++level) {
        frame.elements = 4 << level;
        errors[level] = beta_l(frame, k) / exact[k] - 1;
        VERIFY_GT("relative error of βL (consistent mass: from above)", "1", errors[level], -1e-9);  // consistent mass: from above
      }
      VERIFY_NEAR("order of convergence, coarse meshes", "1", std::log2(errors[0] / errors[1]), 4, 0.4) << k;
      VERIFY_NEAR("order of convergence, fine meshes", "1", std::log2(errors[1] / errors[2]), 4, 0.15) << k;
      VERIFY_LT("relative error of βL, 16 elements", "1", errors[2], 3e-5);
    }
}

TEST(Cantilever, TipMass) {
  VERIFIES({"Beams", "Natural frequencies of a cantilever with a tip mass",
            "Frequency equation of the cantilever with the tip mass ρAL, solved by bisection; Blevins, Formulas for Natural Frequency and "
            "Mode Shape (1979)"});
  const auto equation = [](double x) {
    return 1 + std::cos(x) * std::cosh(x) + x * (std::cos(x) * std::sinh(x) - std::sin(x) * std::cosh(x));
  };
  const double exact[] = {root(equation, 1, 1.5), root(equation, 3.5, 4.5)};
  VERIFY_NEAR("βL of mode 1, root of the frequency equation", "1", exact[0], 1.2479174096, 1e-10);
  VERIFY_NEAR("βL of mode 2, root of the frequency equation", "1", exact[1], 4.0311394367, 1e-10);
  for (int k = 0; k < 2; ++k) {
    Frame frame;
    frame.extensible = false;
    frame.tip_mass = frame.rho_a * frame.length;
    double errors[3];
    for (int level = 0; level < 3; ++level) {
      frame.elements = 2 << level;
      errors[level] = beta_l(frame, k) / exact[k] - 1;
    }
    VERIFY_NEAR("order of convergence, coarse meshes", "1", std::log2(errors[0] / errors[1]), 4, 0.5) << k;
    VERIFY_NEAR("order of convergence, fine meshes", "1", std::log2(errors[1] / errors[2]), 4, 0.15) << k;
    VERIFY_LT("relative error of βL, 8 elements", "1", errors[2], 3e-5);
  }
}

TEST(Cantilever, LumpedMassConvergesFromBelowAndKeepsTheMass) {
  VERIFIES({"Beams", "Cantilever with lumped mass", "Euler-Bernoulli frequency equation, first root 1.8751040687"});
  Frame frame;
  frame.mass = BeamSection::Mass::lumped;
  double errors[2];
  for (int level = 0; level < 2; ++level) {
    frame.elements = 8 << level;
    errors[level] = beta_l(frame, 0) / 1.8751040687 - 1;
  }
  VERIFY_LT("relative error of βL, 8 elements (from below)", "1", errors[0], 0);
  VERIFY_NEAR("order of convergence", "1", std::log2(errors[0] / errors[1]), 2, 0.1);
}

TEST(Timoshenko, TipDisplacementsOfACantilever) {
  VERIFIES({"Beams", "Tip displacements of a cantilever, with and without shear flexibility",
            "Unit-load method: PL³/3EI + PL/GA − ML²/2EI, NL/EA, PL²/2EI + ML/EI"});
  const double EI = 2.5e7, GA = 8e6, EA = 1e9, l = 3, p = 1e4, m = 2e4, n = 5e4;
  for (const bool shear : {false, true})
    for (const int elements : {1, 3}) {
      ModelBuilder builder;
      BeamSection section;
      section.bending = EI;
      section.axial = EA;
      if (shear) section.shear = GA;
      for (int i = 0; i <= elements; ++i) builder.add_node("n" + std::to_string(i), {0, l * i / elements}, here);
      for (int i = 0; i < elements; ++i) support::add_beam(builder, i, i + 1, {0, l * i / elements}, {0, l * (i + 1) / elements}, section);
      for (const Dof dof : {ux, uy, rz}) builder.fix(0, dof, here);
      builder.add_load("tip", {{3 * elements, p}, {3 * elements + 1, -n}, {3 * elements + 2, m}}, nullptr, true, here);
      const Model model = builder.finish();
      Vector force = Vector::Zero(model.free());
      model.add_force(0, force);
      const Vector u = model.full(PivotedLdlt(Matrix(model.stiffness)).solve(force), 0, 0);
      // vertical cantilever: a load to the right turns it clockwise
      VERIFY_NEAR("transverse displacement of the tip", "m", u[3 * elements],
                  p * l * l * l / (3 * EI) + (shear ? p * l / GA : 0) - m * l * l / (2 * EI), 1e-12);
      VERIFY_NEAR("axial displacement of the tip", "m", u[3 * elements + 1], -n * l / EA, 1e-15);
      VERIFY_NEAR("rotation of the tip", "rad", u[3 * elements + 2], -p * l * l / (2 * EI) + m * l / EI, 1e-14);
    }
}

TEST(Timoshenko, FrequencyOfASimplySupportedBeam) {
  VERIFIES({"Beams", "Frequency of a simply supported Timoshenko beam", "Timoshenko (1921): closed form with shear and rotary inertia"});
  // w^2 of the mode sin(pi x/L) with shear and rotary inertia: roots of rho A w^2 = ... (Timoshenko 1921), from the 2 x 2 problem in (w,
  // rotation)
  const double EI = 2.5e7, GA = 6e7, l = 3, rho_a = 240, rho_i = 12, q = pi / l;
  // [GA q^2 - rho_a w^2, -GA q; -GA q, EI q^2 + GA - rho_i w^2]
  const double a = rho_a * rho_i, b = -(rho_a * (EI * q * q + GA) + rho_i * GA * q * q), c = GA * q * q * (EI * q * q);
  const double exact = std::sqrt((-b - std::sqrt(b * b - 4 * a * c)) / (2 * a)) / (2 * pi);
  double errors[2];
  for (int level = 0; level < 2; ++level) {
    const int elements = 4 << level;
    ModelBuilder builder;
    BeamSection section;
    section.bending = EI;
    section.axial = 1e13;
    section.shear = GA;
    section.mass = BeamSection::Mass::consistent;
    section.mass_per_length = rho_a;
    section.rotary_per_length = rho_i;
    for (int i = 0; i <= elements; ++i) builder.add_node("n" + std::to_string(i), {l * i / elements, 0}, here);
    for (int i = 0; i < elements; ++i) support::add_beam(builder, i, i + 1, {l * i / elements, 0}, {l * (i + 1) / elements, 0}, section);
    builder.fix(0, ux, here);
    builder.fix(0, uy, here);
    builder.fix(elements, uy, here);
    const Model model = builder.finish();
    errors[level] = modes(model.stiffness, model.mass, 1)[0].frequency / exact - 1;
  }
  // the shear force is constant in an element while the inertia forces vary it: order 2, not 4 as in bending
  VERIFY_GT("relative error of the frequency (from above)", "1", errors[1], 0);
  VERIFY_LT("relative error of the frequency, 8 elements", "1", errors[1], 3e-3);
  VERIFY_NEAR("order of convergence", "1", std::log2(errors[0] / errors[1]), 2, 0.1);
}

TEST(PDelta, EulerLoadOfACantilever) {
  VERIFIES({"Beams", "Buckling load of a cantilever", "Euler: π²EI/4L²"});
  // the smallest load factor at which K + factor Kg is singular is pi^2 EI/(4 L^2); both for a beam with area and for an inextensible one
  const double EI = 2.5e7, l = 3, exact = pi * pi * EI / (4 * l * l), p = 1000;
  for (const bool extensible : {true, false})
    for (const double angle : {pi / 2, 0.7}) {
      double errors[2];
      for (int level = 0; level < 2; ++level) {
        const int elements = 2 << level;
        ModelBuilder builder;
        const Vec2 along(std::cos(angle), std::sin(angle));
        BeamSection section;
        section.bending = EI;
        if (extensible) section.axial = 1e12;
        for (int i = 0; i <= elements; ++i) builder.add_node("n" + std::to_string(i), l * i / elements * along, here);
        for (int i = 0; i < elements; ++i)
          support::add_beam(builder, i, i + 1, l * i / elements * along, l * (i + 1) / elements * along, section);
        for (const Dof dof : {ux, uy, rz}) builder.fix(0, dof, here);
        builder.add_load("weight", {{3 * elements, -p * along.x()}, {3 * elements + 1, -p * along.y()}}, nullptr, true, here);
        const Model model = builder.finish();
        State state;
        Vector force = Vector::Zero(model.free());
        model.add_force(0, force);
        state.displacement = PivotedLdlt(Matrix(model.stiffness)).solve(force);
        const Matrix kg = geometric_stiffness(model, state);
        // K x = factor (-Kg) x: the smallest factor is the reciprocal of the largest eigenvalue of K^-1 (-Kg)
        const Vector eigen = GeneralisedEigen(-kg, Matrix(model.stiffness)).eigenvalues();
        errors[level] = p / eigen.maxCoeff() / exact - 1;
      }
      VERIFY_LT("relative error of the buckling load, 4 elements", "1", std::abs(errors[1]), 1e-4);
      VERIFY_NEAR("order of convergence", "1", std::log2(errors[0] / errors[1]), 4, 0.4);
    }
}

}  // namespace
}  // namespace uplift::beams_test
