#pragma once
#include "uplift/math/linalg.h"

namespace uplift {

/// Shape functions of a line element at one point of [-1, 1] and their slopes. Nodes in order along the line: -1, 1 or -1, 0, 1.
struct LineShape {
  Vector value, slope;
};
/// Lagrange line with 2 or 3 nodes.
LineShape line_shape(int nodes, double xi);

/// Exact shape functions of the plane beam with constant section (Przemieniecki, Theory of Matrix Structural Analysis, 1968, section 11.4).
/// Unknowns (w1, r1, w2, r2), r = dw/dx - shear angle, counter-clockwise; phi = 12 E I / (G A_s L^2), 0 for Euler-Bernoulli.
struct BeamShape {
  Vec4 deflection;  // w
  Vec4 slope;       // dw/dx [1/m per m]
  Vec4 rotation;    // rotation of the section
};
/// `xi` in [0, 1], length in m.
BeamShape beam_shape(double xi, double length, double phi);

}  // namespace uplift
