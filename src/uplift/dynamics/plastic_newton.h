#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "uplift/dynamics/condensed.h"
#include "uplift/dynamics/plastic_bulk.h"
#include "uplift/math/line_search.h"

// The outer Newton of a step with yielding solids:
//     K_eff du + w r(u0 + du) + B^T P = R     r: what yielding adds to the internal force of the linear bulk, w its weight in the scheme
// Every iteration solves a whole linear step with the same interface inside,
//     (K_eff + D) du + B^T P = y,             y = R - w r(u_k) + D du_k
// with D = 0 (modified Newton: the elastic factor that is there anyway) or D = w (consistent tangent - elastic stiffness). The change of y
// from one iteration to the next is the residual of the whole balance. Modified iterations are accelerated by Anderson's mixing (Walker &
// Ni, SIAM J. Numer. Anal. 49 (2011) 1715-1735). From the first tangent of associated flow on, every iteration takes a new
// one, and as much of its step as a line search on the work of the residual allows (math/line_search.h): of y, from that of the state where
// it begins. The symmetric part of another tangent stays for as long as mixing makes use of it.
// A load step after one that took tangents begins where the last one would go on to. The first iteration of a step in time takes for r its
// value at the beginning and what the last two steps have added, extrapolated.
namespace uplift {

struct PlasticOptions {
  /// Automatic: elastic factor first, tangents where five iterations have left more than slow^5 of the residual. Full: a new tangent
  /// after every iteration that made the residual smaller: quadratic for associated flow; with the symmetric part of another tangent it may
  /// go round in circles.
  enum class Newton { automatic, modified, full } newton = Newton::automatic;
  double slow = 0.7;
  double tolerance = 1e-11;  // of the sizes of the yielding solids' forces
  int iterations = 100;
};

class PlasticNewton {
 public:
  /// Makes a solver of K_eff + D, or tells why not.
  using Make = std::function<std::unique_ptr<StepSolver>(const Sparse& d, std::string& why)>;
  /// `stiffness`: its diagonal weighs the unknowns in norms, so that units play no part.
  PlasticNewton(const PlasticBulk& bulk, Vector diagonal, const PlasticOptions& options);
  ~PlasticNewton();
  /// The end of a step: what the bulk remembers at its beginning, and the instant of its end.
  struct Step {
    const Vector& right;
    const StepStart& start;
    const PlasticState& old;
    MotionInstant at;
    double weight = 1;    // w
    double duration = 0;  // s; 0 in a static stage
    double share = 0;     // of the static stage that it covers; 0 in time
  };
  /// `increment` and `now` receive the end of the step.
  Outcome solve(const Step& step, StepSolver& elastic, const Make& make, Vector& increment, PlasticState& now);
  /// The next step does not begin with what the last ones would go on to.
  void forget();
  /// The solver of the last iteration, with the interface problem and its solution.
  StepSolver& last() const { return *last_; }
  /// Residuals of the iterations of the last step, of the size of the forces.
  const std::vector<double>& residuals() const { return residuals_; }

 private:
  class Mixing;
  bool wants_tangent(int since) const;
  bool soften(const Step& step, const Make& make, const Vector& increment, const PlasticState& now);
  bool begin_newton(const Step& step, const Make& make, const Vector& increment, const PlasticState& now);
  void begin_search(const Vector& increment);
  bool searches_on(const Vector& increment);
  bool shorten_search();
  Outcome iterate(const Step& step, const Make& make, Vector& increment, PlasticState& now);
  bool expect_flow(const Step& step, const Make& make, Vector& increment, PlasticState& now);
  void remember_flow(const Step& step, const Vector& increment);
  void expect_growth(const Step& step);
  void remember_growth(const Step& step, const PlasticState& now);

  const PlasticBulk& bulk_;
  PlasticOptions options_;
  Vector weight_, size_, given_, change_;  // given_: y
  std::unique_ptr<Mixing> mixing_;
  Vector moved_;
  struct Search {
    Vector given, rest, increment;  // y of the state where the step begins, its residual and its increment
    Vector way;                     // the increment of the whole step; empty until it is known
    LineSearch line;
  };
  std::optional<Search> search_;
  Vector flow_;                    // increment of the last load step
  double flow_share_ = 0;          // of the static stage that it covered; 0: none that took a tangent
  Vector growth_, growth_before_;  // of the yielding solids' forces in the last two steps [N]
  double duration_ = 0;            // of those steps; 0: none is known
  Sparse softening_;
  bool whole_ = true;  // softening_ is that of the whole tangent
  std::unique_ptr<StepSolver> tangent_;
  StepSolver* last_ = nullptr;
  std::vector<double> residuals_;
};

}  // namespace uplift
