#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "uplift/base/catalog.h"

// Interface laws. Axes of a point: (t, n) in 2D, (t1, t2, n) in 3D; opening [m] > 0 apart, traction [Pa] > 0 tension.
// A call takes all points of one interface, as a structure of arrays: component c of point i stands at [c * points + i], the normal
// component is the last translation. A point that stands for a whole footing has rotations behind it: then "openings" are relative
// displacements and rotations of both sides, "tractions" forces and moments, and its area is 1. Memory of a law: variable h of point i
// stands at [h * points + i]. Laws are const; memory is passed in and out.
namespace uplift {

/// The batch that one call handles.
struct Batch {
  int points = 0;
  int components = 2;  // rows of a point, rotations included; translations: 1: normal only, 2: (t, n), 3: (t1, t2, n)
  double step = 0;     // s; 0 in statics (rates are zero then)
  // Joint filter of the scheme of filtered energy decay (laws/filter.h); null: none. All components, for `mean` only.
  const double* coefficient = nullptr;  // c of every row [Pa/m]; negative on a normal row: the point is open at the start of the step
  const double* lag = nullptr;          // d_f of every row [m]
  int rotations = 0;                    // rows behind the normal: in the plane 1 (counter-clockwise), in space 3 (about t1, t2, n)
  // With rotations the filter has the matrix gain * (slope of `elastic` at the start): `lag` is that times d_f [N, N m], and `coefficient`
  // is 1 in every row, or -1: without contact at the start.
  double gain = 0;
  int translations() const { return components - rotations; }
  int normal() const { return (translations() - 1) * points; }  // offset of the normal component
};

inline constexpr int most_components = 6;

/// What a law returns for a batch. Null is not wanted; the traction always is. `slope` is d traction_r / d opening_c at [(r * components +
/// c) * points + i] [Pa/m].
struct LawResponse {
  double* traction = nullptr;  // Pa
  double* slope = nullptr;     // Pa/m
  double* now = nullptr;       // memory at the end of the step
  double* end = nullptr;       // `mean` only: traction at the end of the step [Pa]
  double* next = nullptr;      // `mean` only: the slope that a short step onwards will have, for first guesses; in the layout of `slope`
  double* plain = nullptr;     // with a joint filter: the path average of the law alone, without the filter [Pa]; `end`, `next` are needed
};

struct FusedEvaluation;

/// Scales of the normal direction of a law: what warnings, variations and drawings need to know of it.
struct LawScales {
  bool opens = true;           // false: bonded for good
  double strength = 0;         // Pa, in tension
  double closure = 0;          // Pa, compression that closes a gap for good, > 0
  double opening = 0;          // m, over which it softens
  double least_stiffness = 0;  // Pa/m: the law exists above it alone
};

/// Another law of the catalog that has the same answer, by other means. The parameters that both laws have keep their values.
struct EquivalentLaw {
  std::string_view name;
  std::vector<std::pair<std::string_view, double>> parameters;  // that this law does not have; SI
};

/// What the contact under a whole footing looks like, for which one point with rotations stands.
struct FootingContact {
  double open_share = 0;              // of the area
  double max_gap = 0, least_gap = 0;  // m, at the edges; all edges open: least_gap > 0
  // How much of its strength the ground uses, up to 1; 0 where it has no such limit
  double bearing_utilisation = 0, sliding_utilisation = 0;
  double bearing_capacity = 0;  // N, of a vertical load alone
};

/// A traction law: traction from opening, with memory.
class InterfaceLaw {
 public:
  virtual ~InterfaceLaw() = default;
  /// Number of memory variables of a point; all start at zero.
  virtual int num_history(int components) const = 0;
  /// Traction at the end of a step that goes from opening `from` to `to`. In statics and dynamics (`traction = "end"`).
  virtual void respond(const Batch&, const double* from, const double* to, const double* old, const LawResponse&) const = 0;
  /// Path-averaged traction of the step, 1/(to - from) * integral of t d(opening) along the law's own path (docs/theory, eq (11)), and its
  /// slope with respect to `to`.
  virtual void mean(const Batch&, const double* from, const double* to, const double* old, const LawResponse&) const = 0;
  /// `mean` for Newton's method in one pass where there is one component, see fused.h; false where the law does not offer it for these
  /// paths.
  virtual bool fused(const FusedEvaluation&) const { return false; }
  /// Energy per area [J/m2] that is stored at this opening and memory, and that was dissipated since the beginning. Either may be null.
  virtual void energy(const Batch&, const double* opening, const double* history, double* stored, double* dissipated) const = 0;
  /// Stiffness of a closed joint in compression [Pa/m], per component (normal last): for k*F_ii, the static base and suggestions.
  virtual void closed_stiffness(int components, double* stiffness) const = 0;
  virtual LawScales scales() const { return {}; }
  /// For `uplift trust`, which computes the case with it; none where no law of the catalog is equivalent.
  virtual std::optional<EquivalentLaw> equivalent() const { return {}; }
  /// Of a point with rotations, for the joint filter: the openings without what has yielded [m, rad], and the slope of the traction there,
  /// symmetric and without negative eigenvalues, row by row; all zero: no contact. A law that leaves this out has no joint filter.
  virtual void elastic(int /*components*/, const double* /*opening*/, const double* /*history*/, double* /*elastic*/,
                       double* /*slope*/) const {}
  /// Of a point with rotations: what its rows alone do not tell.
  virtual FootingContact contact(const Batch&, const double* /*opening*/, const double* /*history*/) const { return {}; }
};

/// A set that only bounds the contact force (p per point, N or Pa): the unilateral ray, the Coulomb cone. `force` and `trial` use the
/// tension-positive sign: compression is negative. The same batch layout. With P the projection and g the opening, penalty is p = P(e g)
/// and the augmented Lagrangian p = P(m + e g), m <- p.
class Cone {
 public:
  virtual ~Cone() = default;
  /// Friction coefficient; 0 for a frictionless contact.
  virtual double friction() const = 0;
  /// force = P(trial), and `slope` = d force_r / d trial_c in the layout of LawResponse::slope, or null. `force` may be `trial`.
  virtual void project(const Batch&, const double* trial, double* force, double* slope) const = 0;
};

std::span<const Entry<InterfaceLaw>* const> law_catalog();
std::span<const Entry<Cone>* const> cone_catalog();
/// Laws and cones together, as the case file sees them (`[interface.law]`).
std::span<const PartInfo* const> interface_behaviours();

}  // namespace uplift
