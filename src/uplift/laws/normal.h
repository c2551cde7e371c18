#pragma once
#include <memory>

#include "uplift/laws/law.h"

// The normal part of an interface law: opening [m] > 0 apart, traction [Pa] > 0 tension, one component. A tangential part is put beside it
// once for all laws (tangential.h, joint.h). A simple law derives from PointLaw and writes one function for one point; a law that must be
// fast derives from NormalLaw and writes its loops over the points.
namespace uplift {

struct FusedEvaluation;

/// Memory of one point in a structure of arrays.
struct Memory {
  const double* all;  // of all points; none of a law without memory
  int stride, point = 0;
  const double& operator[](int variable) const { return all[variable * stride + point]; }
};

/// A quantity between 0 and 1 along the path of one step, with its derivatives with respect to the opening at the end of the step [1/m].
struct Along {
  double begin = 0, end = 0, end_slope = 0;
  double mean = 0, mean_slope = 0;  // path average
};

/// A quantity that varies smoothly: its path average is the mean of its end values.
inline Along smoothly(double begin, double end, double end_slope) {
  return {begin, end, end_slope, 0.5 * (begin + end), 0.5 * end_slope};
}

/// What a tangential part must know of the surface: both quantities are monotone along a path.
struct Surface {
  double traction = 0;  // normal traction at the end of the step [Pa]
  Along openness;       // 0: the faces transfer shear fully; 1: they do not touch
  Along damage;         // part of the bond that is broken for good (springs have none: part that does not touch)
};

/// The normal part of a law. `Batch` has one component; memory, replies and rules are those of InterfaceLaw.
class NormalLaw {
 public:
  virtual ~NormalLaw() = default;
  virtual int num_history() const = 0;
  virtual void respond(const Batch&, const double* from, const double* to, const double* old, const LawResponse&) const = 0;
  virtual void mean(const Batch&, const double* from, const double* to, const double* old, const LawResponse&) const = 0;
  /// `mean` for Newton's method in one pass, see fused.h; false where the law does not offer it for these paths.
  virtual bool fused(const FusedEvaluation&) const { return false; }
  virtual void energy(const Batch&, const double* opening, const double* history, double* stored, double* dissipated) const = 0;
  /// Stiffness in compression [Pa/m].
  virtual double stiffness() const = 0;
  /// Coefficient of the dashpot that acts while the faces are in contact [Pa s/m].
  virtual double dashpot() const { return 0; }
  virtual LawScales scales() const { return {}; }
  virtual std::optional<EquivalentLaw> equivalent() const { return {}; }
  /// False where the traction is never positive.
  virtual bool carries_tension() const { return true; }
  /// The surface of one point along a step of duration `step` [s]; `from` = `to` asks for the state at that opening.
  virtual Surface surface(double step, double from, double to, Memory old) const = 0;
};

/// Answer of a law for one point and one step.
struct Point {
  double mean, mean_slope;  // path average [Pa], d mean/d to [Pa/m]
  double end, end_slope;    // at the end of the step
  Along openness = {}, damage = {};
};

/// Energies per area of one point [J/m2]; `dissipated` depends on the memory alone.
struct PointEnergy {
  double stored, dissipated;
};

/// A normal law written for one point. At most four memory variables.
class PointLaw : public NormalLaw {
 public:
  static constexpr int most_history = 4;

  /// The step from -> to [m] within `step` seconds; memory at its end goes to `now` (num_history() values).
  virtual Point advance(double step, double from, double to, Memory old, double* now) const = 0;
  virtual PointEnergy energy_at(double opening, Memory history) const = 0;

  void respond(const Batch&, const double* from, const double* to, const double* old, const LawResponse&) const final;
  void mean(const Batch&, const double* from, const double* to, const double* old, const LawResponse&) const final;
  void energy(const Batch&, const double* opening, const double* history, double* stored, double* dissipated) const final;
  Surface surface(double step, double from, double to, Memory old) const final;
};

}  // namespace uplift
