#pragma once
#include "uplift/laws/law.h"
#include "uplift/laws/macro_return.h"

// Macro-element of a shallow foundation: footing and near-field ground as one point with uplift, bearing capacity and sliding. Equations
// and sources: docs/theory/macro_element.md.
namespace uplift {

/// What describes the foundation and its ground. In the plane index 0 counts; per metre of a strip all forces are per metre.
struct MacroParameters {
  MacroElasticity elasticity;
  MacroStrength strength;
  double torsion = 0;  // K_t, elastic [N m/rad]; in space only
};

/// The state of the foundation, for results.
struct MacroState {
  double vertical = 0;        // N [N], compression
  double heave = 0;           // upward displacement of the centre through uplift [m]
  double uplifted_share = 0;  // of the base
  double bearing = 0;         // utilisation of the bearing capacity, 1: yields
  double sliding = 0;         // utilisation of the resistance to sliding, 1: slides
  double settlement = 0;      // permanent settlement of the centre [m]
  double accumulated = 0;     // p: sum of the absolute increments of the permanent settlement [m]
  double slip = 0;            // accumulated slip [m]
  double dissipated = 0;      // J
};

/// An interface law with coupled rows instead of one traction per direction. Rows of its point (area 1) in the plane, three components:
/// (u_t, u_n, theta); in space, six: (u_t1, u_t2, u_n, theta_1, theta_2, theta_n), theta_1 about t1. Forces [N, N m]; u_n > 0 apart, so
/// that N = -force_n and w = -u_n. The rocking stiffness and the length of index 0 belong to theta in the plane and to theta_2 in space.
/// Memory: the plastic part of all openings but theta_n, p, slip, dissipated energy. Where the return fails in spite of sub-steps, the
/// forces are not finite, so that the step is cut.
class MacroElement final : public InterfaceLaw {
 public:
  explicit MacroElement(const MacroParameters& parameters);

  int num_history(int components) const override;
  void respond(const Batch&, const double* from, const double* to, const double* old, const LawResponse&) const override;
  /// Discrete gradient (eq M12): mean . (to - from) is the change of the stored energy and the dissipated energy, which never decreases.
  void mean(const Batch&, const double* from, const double* to, const double* old, const LawResponse&) const override;
  void energy(const Batch&, const double* opening, const double* history, double* stored, double* dissipated) const override;
  void closed_stiffness(int components, double* stiffness) const override;
  void elastic(int components, const double* opening, const double* history, double* elastic, double* slope) const override;
  /// Gaps at the edges, against the ground that has settled; utilisations at most 1, since the return keeps the forces on the surfaces.
  FootingContact contact(const Batch&, const double* opening, const double* history) const override;

  const MacroElasticity& elasticity() const { return uplift_.elasticity(); }
  const MacroSurfaces& surfaces() const { return surfaces_; }
  /// Of one point.
  MacroState state(int components, const double* opening, const double* history) const;

 private:
  struct Rows;
  class Path;
  template <int R>
  bool go_elastically(bool average, const Batch&, const Rows&, const double* from, const double* to, const double* old,
                      const LawResponse&) const;
  template <int R>
  void put_elastic(const Rows&, const double* opening, const double* history, double* elastic, double* slope) const;
  MacroElastic respond_without_yielding(const Rows&, const MacroVector& elastic) const;
  void put_torsion(bool average, const Rows&, const double* from, const double* to, const LawResponse&) const;
  void advance(bool average, const Batch&, const double* from, const double* to, const double* old, const LawResponse&) const;

  MacroUplift uplift_;
  MacroSurfaces surfaces_;
  double torsion_;
};

/// The macro-element that a law is; null: another one.
inline const MacroElement* as_macro_element(const InterfaceLaw* law) {
  return dynamic_cast<const MacroElement*>(law);
}

}  // namespace uplift
