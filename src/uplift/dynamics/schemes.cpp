#include <cmath>

#include "uplift/dynamics/scheme.h"

// The schemes of the Newmark family: coefficients only (see scheme.h for the equations).
namespace uplift {

StepWeights weights_of(const Scheme& s, double step) {
  const double dt = step * s.stretch(), w = 1 - s.alpha_f;
  StepWeights made;
  made.damping = s.gamma / (s.beta * dt);
  made.mass = (1 - s.alpha_m) / (w * s.beta * dt * dt);
  made.share = 1 / s.stretch();
  made.mass_velocity = (1 - s.alpha_m) / (w * s.beta * dt);
  made.mass_acceleration = ((1 - s.alpha_m) * (1 / (2 * s.beta) - 1) - s.alpha_m) / w;
  made.damping_velocity = 1 - s.gamma / s.beta + s.alpha_f / w;
  made.damping_acceleration = dt * (1 - s.gamma / (2 * s.beta));
  return made;
}

const Entry<Scheme>& entry_scheme_average_acceleration() {
  static const Entry<Scheme> entry{
      {.name = "average_acceleration",
       .summary = "trapezoidal rule; no numerical damping; conserves energy exactly with the path-averaged traction",
       .equations = "beta = 1/4, gamma = 1/2",
       .source = "Newmark 1959; docs/theory, eqs (9) and (10)",
       .params = {}},
      [](const Values&) { return std::make_unique<const Scheme>(); }};
  return entry;
}

const Entry<Scheme>& entry_scheme_energy_decay() {
  static const Entry<Scheme> entry{
      {.name = "energy_decay",
       .summary =
           "filtered energy decay: the trapezoidal rule with the path-averaged traction and passive filters, which damp what the step "
           "does not resolve (bulk and joint); second order, never creates energy, exact energy balance",
       .equations = "M dv/h + C du/h + K (u0 + u1)/2 + K y_u + B^T W t = (f0 + f1)/2,   du/h = (v0 + v1)/2 + y_v\n"
                    "y = b (d - d_f),   d_f <- a d_f + (1 - a) d   for d = du, dv and the opening increment of every point in contact\n"
                    "a = (1 - 3 rho)/(3 - rho),   b = (1 - rho)^2/(2 (3 - rho)(1 + rho))\n"
                    "a point that closes in the step takes the traction at its end",
       .source = "docs/theory, section 3; eigenvalues of the linear part: Jansen, Whiting & Hulbert 2000",
       .params = {number("rho", "1", "spectral radius at infinite frequency; 1 is average_acceleration").between(0, 1).standard(0.5)}},
      [](const Values& values) -> std::unique_ptr<const Scheme> {
        const double rho = values.number("rho");
        Scheme scheme;
        scheme.pole = (1 - 3 * rho) / (3 - rho);
        scheme.gain = (1 - rho) * (1 - rho) / (2 * (3 - rho) * (1 + rho));
        return std::make_unique<const Scheme>(scheme);
      }};
  return entry;
}

const Entry<Scheme>& entry_scheme_newmark() {
  static const Entry<Scheme> entry{
      {.name = "newmark",
       .summary = "Newmark's family with given coefficients",
       .equations = "u1 = u0 + dt v0 + dt^2 ((1/2 - beta) a0 + beta a1)\nv1 = v0 + dt ((1 - gamma) a0 + gamma a1)",
       .source = "Newmark 1959",
       .params = {number("gamma", "1", "1/2: second order; above: numerical damping").between(0.5, 2).standard(0.5),
                  number("beta", "1", "at least gamma/2: unconditionally stable; absent: (gamma + 1/2)^2/4").positive().optional()}},
      [](const Values& values) -> std::unique_ptr<const Scheme> {
        Scheme scheme;
        scheme.gamma = values.number("gamma");
        scheme.beta = values.has("beta") ? values.number("beta") : std::pow(scheme.gamma + 0.5, 2) / 4;
        if (scheme.beta < scheme.gamma / 2)
          throw InputError(values.where("beta"), values.path("beta"), "beta >= gamma/2 (unconditional stability)",
                           std::to_string(scheme.beta));
        return std::make_unique<const Scheme>(scheme);
      }};
  return entry;
}

const Entry<Scheme>& entry_scheme_hht() {
  static const Entry<Scheme> entry{
      {.name = "hht",
       .summary = "HHT-alpha: numerical damping of high frequencies, second order",
       .equations = "alpha_f = -alpha, beta = (1 - alpha)^2/4, gamma = 1/2 - alpha",
       .source = "Hilber, Hughes & Taylor 1977",
       .params = {number("alpha", "1", "0: trapezoidal rule; -1/3: strongest damping").between(-1.0 / 3, 0).standard(-0.05)}},
      [](const Values& values) -> std::unique_ptr<const Scheme> {
        const double alpha = values.number("alpha");
        return std::make_unique<const Scheme>(Scheme{std::pow(1 - alpha, 2) / 4, 0.5 - alpha, 0, -alpha});
      }};
  return entry;
}

const Entry<Scheme>& entry_scheme_generalised_alpha() {
  static const Entry<Scheme> entry{
      {.name = "generalised_alpha",
       .summary = "generalised-alpha with the spectral radius at infinite frequency given",
       .equations = "alpha_m = (2 r - 1)/(r + 1), alpha_f = r/(r + 1), gamma = 1/2 - alpha_m + alpha_f, beta = (1 - alpha_m + alpha_f)^2/4",
       .source = "Chung & Hulbert 1993",
       .params = {number("rho", "1", "spectral radius at infinite frequency: 1 keeps all, 0 annihilates the highest in one step")
                      .between(0, 1)
                      .standard(0.9)}},
      [](const Values& values) -> std::unique_ptr<const Scheme> {
        const double rho = values.number("rho");
        Scheme scheme;
        scheme.alpha_m = (2 * rho - 1) / (rho + 1);
        scheme.alpha_f = rho / (rho + 1);
        scheme.gamma = 0.5 - scheme.alpha_m + scheme.alpha_f;
        scheme.beta = std::pow(1 - scheme.alpha_m + scheme.alpha_f, 2) / 4;
        return std::make_unique<const Scheme>(scheme);
      }};
  return entry;
}

std::span<const Entry<Scheme>* const> scheme_catalog() {
  static const Entry<Scheme>* const entries[] = {
#define SCHEME(name) &entry_scheme_##name(),
#include "uplift/parts.def"
  };
  return entries;
}

std::span<const PartInfo* const> schemes() {
  static const PartInfo* const entries[] = {
#define SCHEME(name) &entry_scheme_##name(),
#include "uplift/parts.def"
  };
  return entries;
}

}  // namespace uplift
