#pragma once
#include <memory>
#include <optional>
#include <string>

#include "uplift/laws/normal.h"

// Tangential parts of interface laws, one of which stands beside any normal part. With the tangential opening d [m] (one or two
// components), the slip memory s [m], the elastic part e = d - s, and K the tangential stiffness [Pa/m]:
//   none        t = 0
//   bonded      t = K d
//   open_free   t = (1 - o) K e, o the openness of the normal part. When o grows, the lost part of (1 - o) K e^2/2 is dissipated; when o
//   falls, the
//               traction stays continuous (e shrinks by (1 - o_old)/(1 - o_new), which dissipates too); fully open, s follows d. No cycle
//               creates energy.
//   coulomb     |t| <= bound = cohesion (1 - damage) - friction min(t_n, 0), t = K e, slip along t.
// The joint filter of the scheme (laws/filter.h) is added to the path average of every part, for coulomb up to the bound.
// Source: docs/theory, sections 2 and 3; the energy argument is that of each update's docstring.
namespace uplift {

/// One call for all points of an interface, the normal part of the response being already there.
struct TangentialCall {
  const Batch& batch;
  const NormalLaw& normal;
  const double *from, *to;      // all components
  const double* normal_old;     // memory of the normal part at the beginning of the step
  const double* old;            // memory of the tangential part
  const LawResponse& response;  // all components; the slope has been set to zero where the normal part did not write
  double* now;                  // memory of the tangential part, or null
};

class TangentialPart {
 public:
  virtual ~TangentialPart() = default;
  virtual int num_history(int tangents) const = 0;
  virtual void respond(const TangentialCall&) const = 0;
  virtual void mean(const TangentialCall&) const = 0;
  /// Adds to `stored` and `dissipated` (either may be null).
  virtual void add_energy(const Batch&, const NormalLaw&, const double* opening, const double* normal_history, const double* history,
                          double* stored, double* dissipated) const = 0;
  virtual double stiffness() const = 0;  // Pa/m, faces pressed together
};

/// The part that the checked parameters name. `normal_stiffness` is the default of K_t. Throws InputError when a parameter that the part
/// needs is missing, and when one is given that it would not use.
std::unique_ptr<const TangentialPart> make_tangential(const Values&, double normal_stiffness);

/// Name of the part: `tangential` where it is given; else "coulomb" with a friction or cohesion, elastic ("bonded") with a stiffness, and
/// else the default of the law.
std::string tangential_kind(const Values&);
/// Of any law or cone; nothing where it has no key for it.
std::optional<std::string> stated_tangential(const Values& behaviour);
/// The kind where other keys decide on another one than that of the table.
std::optional<std::string> decided_tangential(const Values& behaviour);

/// The parameters that choose and describe the tangential part.
std::vector<Field> tangential_fields(const char* standard);

}  // namespace uplift
