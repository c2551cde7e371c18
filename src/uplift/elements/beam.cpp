#include "uplift/elements/beam.h"

#include <cassert>

#include "uplift/math/quadrature.h"
#include "uplift/math/shapes.h"

namespace uplift {

namespace {

constexpr std::array<int, 4> bending_rows{1, 2, 4, 5};  // (w1, r1, w2, r2) inside (u1, w1, r1, u2, w2, r2)

void add_bending(const Mat4& bending, Matrix& local) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) local(bending_rows[i], bending_rows[j]) += bending(i, j);
}

}  // namespace

Beam::Beam(int a, int b, Vec2 position_a, Vec2 position_b, BeamSection section)
    : nodes_{a, b}, section_(section), length_((position_b - position_a).norm()), axes_(Matrix::Zero(6, 6)) {
  assert(length_ > 0 && section.bending > 0);
  const Vec2 x = (position_b - position_a) / length_;
  for (int end = 0; end < 6; end += 3) {
    axes_.block<2, 2>(end, end) << x.x(), x.y(), -x.y(), x.x();
    axes_(end + 2, end + 2) = 1;
  }
}

Mat3 Beam::axes() const {
  Mat3 axes = Mat3::Identity();
  axes.topLeftCorner<2, 2>() = axes_.topLeftCorner<2, 2>();
  return axes;
}

Matrix Beam::to_global(const Matrix& local) const {
  return axes_.transpose() * local * axes_;
}

Matrix Beam::local_stiffness() const {
  const double l = length_, phi = section_.shear_ratio(l), c = section_.bending / (1 + phi) / (l * l * l);
  Mat4 bending;
  bending << 12, 6 * l, -12, 6 * l,                         //
      6 * l, (4 + phi) * l * l, -6 * l, (2 - phi) * l * l,  //
      -12, -6 * l, 12, -6 * l,                              //
      6 * l, (2 - phi) * l * l, -6 * l, (4 + phi) * l * l;
  Matrix local = Matrix::Zero(6, 6);
  add_bending(c * bending, local);
  if (section_.axial) {
    const double k = *section_.axial / l;
    local(0, 0) = local(3, 3) = k;
    local(0, 3) = local(3, 0) = -k;
  }
  return local;
}

Matrix Beam::local_mass() const {
  Matrix local = Matrix::Zero(6, 6);
  const double l = length_, m = section_.mass_per_length * l, rotary = section_.rotary_per_length * l;
  if (section_.mass == BeamSection::Mass::lumped) local.diagonal() << m / 2, m / 2, rotary / 2, m / 2, m / 2, rotary / 2;
  if (section_.mass == BeamSection::Mass::consistent) {
    Mat4 bending = Mat4::Zero();
    const Quadrature gauss = gauss_legendre(4);  // exact: the integrand has degree 6
    for (int i = 0; i < gauss.point.size(); ++i) {
      const BeamShape shape = beam_shape((1 + gauss.point[i]) / 2, l, section_.shear_ratio(l));
      bending += gauss.weight[i] / 2 *
                 (m * shape.deflection * shape.deflection.transpose() + rotary * shape.rotation * shape.rotation.transpose());
    }
    add_bending(bending, local);
    local(0, 0) = local(3, 3) = m / 3;
    local(0, 3) = local(3, 0) = m / 6;
  }
  return local;
}

void Beam::form(Local local) const {
  if (local.stiffness) *local.stiffness = to_global(local_stiffness());
  if (local.mass) *local.mass = to_global(local_mass());
  if (local.damping) local.damping->setZero(6, 6);
}

double Beam::axial_force(const Vector& displacement) const {
  if (!section_.axial) return 0;
  const Vector local = axes_ * displacement;
  return *section_.axial / length_ * (local[3] - local[0]);
}

Vector Beam::end_forces(const Vector& displacement) const {
  return local_stiffness() * (axes_ * displacement);
}

/// For an axial force of 1 N.
Matrix Beam::local_geometric() const {
  Mat4 bending = Mat4::Zero();
  const Quadrature gauss = gauss_legendre(3);  // exact: the integrand has degree 4
  for (int i = 0; i < gauss.point.size(); ++i) {
    const BeamShape shape = beam_shape((1 + gauss.point[i]) / 2, length_, section_.shear_ratio(length_));
    bending += length_ * gauss.weight[i] / 2 * shape.slope * shape.slope.transpose();
  }
  Matrix local = Matrix::Zero(6, 6);
  add_bending(bending, local);
  return local;
}

void Beam::geometric(double axial, Matrix& stiffness) const {
  stiffness = axial * to_global(local_geometric());
}

namespace {

/// N, V, M at a distance x from a that balance the end forces at a alone, from the rows (fx, fy, m) of these.
Matrix beyond(const Matrix& at_a, double x) {
  Matrix rows = -at_a;
  rows.row(2) += x * at_a.row(1);
  return rows;
}

}  // namespace

/// Force of inertia [N], and its moment about the section [N m], of the part from a to the section, per acceleration of the ends (local
/// axes).
Matrix Beam::inertia_before(double xi) const {
  Matrix rows = Matrix::Zero(3, 6);
  if (section_.mass == BeamSection::Mass::lumped) {
    const Matrix mass = local_mass();
    if (xi > 0) rows += mass.topRows(3), rows.row(2) -= xi * length_ * mass.row(1);
    if (xi >= 1) rows += mass.bottomRows(3);
  }
  if (section_.mass != BeamSection::Mass::consistent) return rows;
  const Quadrature gauss = gauss_legendre(3);  // exact: the integrand has degree 4
  for (int i = 0; i < gauss.point.size(); ++i) {
    const double at = xi * (1 + gauss.point[i]) / 2, part = gauss.weight[i] / 2 * xi * length_;
    const double mass = part * section_.mass_per_length, rotary = part * section_.rotary_per_length;
    const BeamShape shape = beam_shape(at, length_, section_.shear_ratio(length_));
    rows(0, 0) += mass * (1 - at);
    rows(0, 3) += mass * at;
    for (int k = 0; k < 4; ++k) {
      rows(1, bending_rows[k]) += mass * shape.deflection[k];
      rows(2, bending_rows[k]) += mass * (at - xi) * length_ * shape.deflection[k] + rotary * shape.rotation[k];
    }
  }
  return rows;
}

SectionRows Beam::section(double xi) const {
  const double x = xi * length_;
  const Matrix geometric = local_geometric();
  SectionRows rows{.stiffness = beyond(local_stiffness().topRows(3), x),
                   .geometric = beyond(geometric.topRows(3), x),
                   .mass = beyond(local_mass().topRows(3), x) + inertia_before(xi)};
  const BeamShape shape = beam_shape(xi, length_, section_.shear_ratio(length_));
  for (int k = 0; k < 4; ++k) rows.geometric(2, bending_rows[k]) += shape.deflection[k];  // the axial force at its lever w(x) - w(a)
  rows.geometric(2, bending_rows[0]) -= 1;
  for (Matrix* each : {&rows.stiffness, &rows.geometric, &rows.mass}) *each = (*each * axes_).eval();
  return rows;
}

}  // namespace uplift
