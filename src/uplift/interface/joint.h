#pragma once
#include <utility>
#include <vector>

#include "uplift/base/error.h"
#include "uplift/elements/space.h"
#include "uplift/math/linalg.h"
#include "uplift/math/quadrature.h"

// Zero-thickness joints as lists of points (Goodman's joint; Cherubini, Richard & Frau, eqs 9-14): every point has an area and sees
//   opening = R^T (u_upper - u_lower),   R = (t, n) in the plane, (t1, t2, n) in space, n from the lower to the upper side (local_axis).
namespace uplift {

/// One joint of an interface before the unknowns are numbered: either side follows nodes by shape functions.
struct JointPoint {
  Place position{};                               // m
  Place normal{0, 1};                             // from lower to upper
  double area = 0;                                // m2, > 0
  double stiffness = 1;                           // of the ground here over its mean: factor on the tractions of the law
  double gap = 0;                                 // m, initial
  double water = 0;                               // Pa: pressure of the water in the joint, on both faces
  std::vector<std::pair<int, double>> upper;      // node, shape function
  std::vector<std::pair<int, double>> lower;      // empty: fixed ground
  bool rigid_upper = false, rigid_lower = false;  // the node's rotation acts too, through the offset position - node
};

enum class FootingRule {
  nodal,     // composite trapezoid, ends with half weight
  midpoint,  // equal cells
  gauss      // one Gauss rule over the whole width
};

/// A rigid footing on fixed ground: points spread over its width, in space over a rectangle, all on the motion of one body.
struct Footing {
  int body = 0;          // node
  Place centre{};        // m: middle of the base
  Place normal{0, 1};    // out of the ground
  double width = 0;      // m, along t
  double thickness = 1;  // m out of the plane
  int points = 0;        // along t; nodal: at least 2
  FootingRule rule = FootingRule::nodal;
  double gap = 0;  // m
  // in space: a rectangle, `width` along t1 turned by `azimuth` about the normal, `length` [m] across; then `thickness` is 1
  double length = 0;
  int points_across = 0;
  double azimuth = 0;  // rad
  // Rocking stiffness over that of a uniform bed, for tilting the width and the length (laws/soil_bed.h); 0: uniform. One that the points
  // can have.
  double ratio = 0, ratio_across = 0;
};
/// The rule along one side.
Quadrature footing_rule(FootingRule rule, int points);
/// Points in the order of t; in space those along the width first, line after line. Throws InputError (at `where`) when the width or the
/// number of points makes no sense.
std::vector<JointPoint> footing_points(const Footing& footing, const Where& where);
/// Corners of its underside: the two edges in the plane, four corners in space.
std::vector<Place> footing_corners(const Footing& footing);

/// A node of one side with its place.
struct SideNode {
  int node = 0;
  Place position;
};

/// Isolated node pairs (eq 13, point joints), each with the same tributary area; `lower` empty: fixed ground below each node. `space`: of
/// the model, for messages.
/// Throws InputError when the sides have different numbers of nodes or an upper node lies on the wrong side of its lower one.
std::vector<JointPoint> pair_points(const std::vector<SideNode>& upper, const std::vector<SideNode>& lower, const Place& normal,
                                    double area, double gap, Space space, const Where& where);

enum class LineQuadrature {
  nodal,  // Lobatto: points at the node pairs, diagonal matrices, no traction oscillation for stiff joints
  gauss   // as many Gauss points as node pairs
};

/// In the plane: line joint elements through node pairs that are listed in order along the line: the upper side lies to the left of the
/// walking direction, so that n is the direction turned by +90 degrees. Neighbouring elements share their end pair.
struct LineJoint {
  std::vector<SideNode> upper, lower;  // lower empty: fixed ground
  int nodes_per_element = 2;           // or 3 (end, middle, end)
  LineQuadrature quadrature = LineQuadrature::nodal;
  double thickness = 1;  // m
  double gap = 0;        // m
};
/// With the nodal rule the shares of neighbouring elements in a common pair are added to one point, unless their normals differ.
/// Throws InputError on wrong numbers of nodes, coincident nodes, and sides that are exchanged.
std::vector<JointPoint> line_points(const LineJoint& joint, const Where& where);

}  // namespace uplift
