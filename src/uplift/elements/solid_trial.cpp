#include <cassert>

#include "uplift/elements/solid_nonlinear.h"
#include "uplift/math/lanes.h"

// What most updates of a yielding solid come to: no point of the element yields, its memory stays. The points of an element stand side by
// side in vector registers, so that this costs little beside the update of an element that yields (solid_nonlinear.cpp).
namespace uplift {

namespace {

/// The gradients that NonlinearSolid keeps, of points that fill registers.
struct KeptGradients {
  const double* volume;  // of each point, zero beyond the last; then the gradients in the same way
  int functions, points;
  const double* of(int direction, int function) const { return volume + (1 + direction * functions + function) * points; }
};

/// Strain of `count` functions from `first` on, added to the components `e`.
template <int dim>
[[gnu::always_inline]] inline void add_strain(const KeptGradients& kept, const WholeLanes& at, int first, int count, const double* u,
                                              Lanes (&e)[6]) {
  for (int a = first; a < first + count; ++a, u += dim) {
    const Lanes x = at(kept.of(0, a)), y = at(kept.of(1, a));
    e[0] += x * u[0];
    e[1] += y * u[1];
    e[3] += y * u[0] + x * u[1];
    if constexpr (dim == 3) {
      const Lanes z = at(kept.of(2, a));
      e[2] += z * u[2];
      e[4] += z * u[1] + y * u[2];
      e[5] += z * u[0] + x * u[2];
    }
  }
}

[[gnu::always_inline]] inline void find_stress(double lame, double shear, const Lanes (&e)[6], Lanes (&s)[6]) {
  const Lanes volumetric = lame * (e[0] + e[1] + e[2]);
  for (int c = 0; c < 3; ++c) s[c] = volumetric + 2 * shear * e[c];
  for (int c = 3; c < 6; ++c) s[c] = shear * e[c];
}

/// Forces of a stress on `count` functions from `first` on.
template <int dim>
[[gnu::always_inline]] inline void add_force(const KeptGradients& kept, const WholeLanes& at, int first, int count, const Lanes (&s)[6],
                                             double* force) {
  constexpr int voigt[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  const Lanes volume = at(kept.volume);
  for (int a = first; a < first + count; ++a)
    for (int i = 0; i < dim; ++i) {
      Lanes traction = s[voigt[i][0]] * at(kept.of(0, a));
      for (int j = 1; j < dim; ++j) traction += s[voigt[i][j]] * at(kept.of(j, a));
      *force++ += sum(volume * traction);
    }
}

}  // namespace

template <int dim>
bool NonlinearSolid::stays_elastic_in(const double* displacement, std::span<const double> old, std::span<double> now, Scratch& scratch,
                                      double* force) const {
  const int count = static_cast<int>(nodes().size());
  const KeptGradients kept{gradient_.data(), count + modes_, side_by_side_};
  const double lame = law_->material().lame(), shear = law_->material().shear();
  const bool inelastic = has_yielded(old);
  scratch.trial.resize(static_cast<std::size_t>(6 * side_by_side_));
  double* trial = scratch.trial.data();
  const auto component = [&](int c) { return trial + c * side_by_side_; };
  if (inelastic)
    for (int c = 0; c < 6; ++c)
      for (int p = 0; p < side_by_side_; ++p) component(c)[p] = p < points_ ? old[static_cast<std::size_t>(size_ * p + c)] : 0;

  double* amplitudes = now.data() + first_amplitude();
  if (modes_ > 0) {
    constexpr int n = dim * dim;
    assert(num_amplitudes() == n);
    double made[n] = {}, mode_force[n] = {};
    const double* column = modes_of_nodes_.data();
    for (int j = 0; j < dim * count; ++j, column += n)
      for (int k = 0; k < n; ++k) made[k] += column[k] * displacement[j];
    if (inelastic) {
      for (int first = 0; first < side_by_side_; first += static_cast<int>(lanes)) {
        const WholeLanes at{first};
        Lanes e[6], s[6];
        for (int c = 0; c < 6; ++c) e[c] = at(component(c));
        find_stress(lame, shear, e, s);
        add_force<dim>(kept, at, count, modes_, s, mode_force);
      }
      const double* flexibility = mode_flexibility_.data();
      for (int j = 0; j < n; ++j, flexibility += n)
        for (int k = 0; k < n; ++k) made[k] += flexibility[k] * mode_force[j];
    }
    std::copy_n(made, n, amplitudes);
  }

  if (force) std::fill_n(force, dim * count, 0.0);
  for (int first = 0; first < side_by_side_; first += static_cast<int>(lanes)) {
    const WholeLanes at{first};
    Lanes e[6] = {0, 0, 0, 0, 0, 0}, s[6];
    add_strain<dim>(kept, at, 0, count, displacement, e);
    add_strain<dim>(kept, at, count, modes_, amplitudes, e);
    if (inelastic)
      for (int c = 0; c < 6; ++c) e[c] -= at(component(c));
    find_stress(lame, shear, e, s);
    for (int c = 0; c < 6; ++c) at.put(component(c), s[c]);
    if (force) add_force<dim>(kept, at, 0, count, s, force);
  }
  return law_->stays_elastic({trial, side_by_side_, points_, old.data()});
}

bool NonlinearSolid::stays_elastic(const Vector& displacement, std::span<const double> old, std::span<double> now, Scratch& scratch,
                                   Vector* force) const {
  if (force) force->resize(unknowns());
  double* to = force ? force->data() : nullptr;
  return dimension() == 2 ? stays_elastic_in<2>(displacement.data(), old, now, scratch, to)
                          : stays_elastic_in<3>(displacement.data(), old, now, scratch, to);
}

}  // namespace uplift
