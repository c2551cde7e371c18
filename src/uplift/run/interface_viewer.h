#pragma once
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "uplift/interface/facets.h"
#include "uplift/model/model.h"
#include "uplift/run/base_motion.h"
#include "uplift/run/step_record.h"

namespace uplift {

/// How a joint opens: a bonded one never does, and one that holds tension t, as a law of the caller's may, is stretched by t/K_n before
/// (docs/theory, section 2).
struct GapRule {
  bool opens = true;
  double softness = 0;  // 1/K_n [m/Pa]; 0: no tension is held
  /// m, from the opening [m] and the traction at the same instant [Pa, tension > 0]; negative where the joint is closed.
  double gap(double opening, double traction) const {
    return opens ? opening - softness * std::max(traction, 0.0) : std::min(opening, 0.0);
  }
  /// Whether gaps are other than the openings.
  bool differs() const { return !opens || softness > 0; }
};
GapRule gap_rule(const Interface& interface);

/// Looks at all interfaces of a model quickly: arms and areas are laid out once.
class InterfaceViewer {
 public:
  /// `bases`: nodes of the upper side of every interface, `facets`: the surface of each; either may be empty.
  InterfaceViewer(const Model& model, double gap_tolerance, const std::vector<std::vector<int>>& bases = {},
                  const std::vector<std::shared_ptr<const Facets>>& facets = {});
  /// Forces are the means over the step, gaps those at its end. `views`: of all interfaces, or empty. `radiation`: forces of the dashpots
  /// beside foundations at the same rows; null: there are none.
  void look(const State& state, std::vector<InterfaceView>& views, const Vector* radiation = nullptr);
  /// How an interface stands; `view` is what look() saw of it.
  BasePose pose(const State& state, std::size_t interface, const InterfaceView& view) const;

 private:
  struct Layout {
    int first = 0, points = 0, translations = 0, normal = 0;  // normal: its first row
    Vector area, inverse_area, along, across;                 // along t and along n from the reference point [m]
    std::array<Vector, 2> slope_weight;
    Space space;
    Matrix resultant_rows;  // in space, and where the normals differ; else empty: the sums are then taken directly
    double total = 0;       // m2
    PositiveShare share;    // empty: points count as a whole
    double stiffness = 0;   // Pa/m of the closed joint; infinite for constraints
    bool bonded = false;    // it may pull: the tension share is asked for
    GapRule rule;
    std::vector<Facets::Corner> corners;    // of the surface that are no points: openings are extrapolated to them
    bool at_edge = false;                   // pressures too
    bool plane = false;                     // openings are those of a plane, closed ones too: they are extrapolated wherever they are
    bool plane_tractions = false;           // of a bonded joint: so are its tractions
    const InterfaceLaw* footing = nullptr;  // the law of a point with rotations, which stands for a whole footing; else null
    Batch batch;
    int first_history = 0;
  };
  void look_at_footing(const Layout& layout, const Vector& opening, const Vector& force, const Vector& history, const Vector* radiation,
                       InterfaceView& view) const;
  void look_at_points(const Layout& layout, const State& state, InterfaceView& view);
  /// `more`: forces that are added; null: none.
  static Resultant resultant_by_rows(const Layout& layout, const Vector& force, const Vector* more = nullptr);
  double open_share(const Layout& layout, const double* gap, const double* force, const InterfaceView& view);
  double tension_share(const Layout& layout, const double* force);
  static double edge_pressure(const Layout& layout, const double* force);
  static bool pulls_at_edge(const Layout& layout, const double* force);
  double edge_opening(const Layout& layout, const double* gap) const;
  void look_at_plane(const Layout& layout, const double* gap, InterfaceView& view);
  double share_above(const Layout& layout, double level, const double* value);
  static double pulling_points(const Layout& layout, const double* force);
  const double* gaps(const Layout& layout, const double* opening, const double* force);
  std::vector<Layout> layouts_;
  std::vector<BaseMotion> bases_;
  double tolerance_;
  Vector value_, gap_;  // at the points of one interface
};

}  // namespace uplift
