#include "uplift/elements/space_beam.h"

#include <cassert>

namespace uplift {

namespace {

constexpr int end_unknowns = 12;
constexpr int turn_a = 3, turn_b = 9;                          // r_x
constexpr std::array<int, 6> rows_xy{0, 1, 5, 6, 7, 11};       // of the plane beam's (u, w, r) at a and b: u_x, u_y, r_z
constexpr std::array<int, 6> rows_xz{0, 2, 4, 6, 8, 10};       // u_x, u_z, -r_y
constexpr std::array<double, 6> signs_xz{0, 1, -1, 0, 1, -1};  // the axial part is taken once, from x-y

Beam plane_beam(double length, double bending, double shear, double rotary, std::optional<double> axial, const SpaceBeamSection& section) {
  const BeamSection plane{.bending = bending,
                          .axial = axial,
                          .shear = shear,
                          .mass_per_length = section.mass_per_length,
                          .rotary_per_length = rotary,
                          .mass = section.mass};
  return {0, 1, Vec2::Zero(), Vec2(length, 0), plane};
}

/// The local matrix of the two plane beams.
Matrix both_planes(const Matrix& xy, const Matrix& xz) {
  Matrix local = Matrix::Zero(end_unknowns, end_unknowns);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      local(rows_xy[i], rows_xy[j]) += xy(i, j);
      local(rows_xz[i], rows_xz[j]) += signs_xz[i] * signs_xz[j] * xz(i, j);
    }
  return local;
}

/// Adds [same, other; other, same] in the two rotations about x.
void add_torsion(double same, double other, Matrix& local) {
  local(turn_a, turn_a) += same;
  local(turn_b, turn_b) += same;
  local(turn_a, turn_b) += other;
  local(turn_b, turn_a) += other;
}

Matrix to_global(const Mat3& axes, const Matrix& local) {
  Matrix global(end_unknowns, end_unknowns);
  for (int i = 0; i < end_unknowns; i += 3)
    for (int j = 0; j < end_unknowns; j += 3) global.block<3, 3>(i, j) = axes.transpose() * local.block<3, 3>(i, j) * axes;
  return global;
}

}  // namespace

std::optional<Mat3> beam_axes(const Vec3& along, const std::optional<Vec3>& up) {
  const double length = along.norm();
  if (!(length > 0)) return std::nullopt;
  const Vec3 x = along / length;
  const bool upright = cross(Vec3::UnitZ(), x).norm() < 1e-3;
  const Vec3 towards = up ? *up : upright ? Vec3::UnitX() : Vec3::UnitZ();
  const Vec3 across = cross(towards, x);
  if (!(across.norm() > 1e-6 * towards.norm())) return std::nullopt;
  const Vec3 y = across.normalized();
  Mat3 axes;
  axes.row(0) = x;
  axes.row(1) = y;
  axes.row(2) = cross(x, y);
  return axes;
}

SpaceBeam::SpaceBeam(int a, int b, const Vec3& position_a, const Vec3& position_b, const SpaceBeamSection& section,
                     const std::optional<Vec3>& up)
    : nodes_{a, b},
      axes_(beam_axes(position_b - position_a, up).value()),
      xy_(plane_beam((position_b - position_a).norm(), section.bending_z, section.shear_y, section.rotary_z, section.axial, section)),
      xz_(plane_beam((position_b - position_a).norm(), section.bending_y, section.shear_z, section.rotary_y, std::nullopt, section)),
      torsion_(section.torsion / length()),
      polar_inertia_(section.polar.value_or(section.rotary_y + section.rotary_z) * length()),
      mass_(section.mass) {
  assert(section.torsion > 0);
}

Vector SpaceBeam::to_local(const Vector& global) const {
  Vector local(end_unknowns);
  for (int i = 0; i < end_unknowns; i += 3) local.segment<3>(i) = axes_ * global.segment<3>(i);
  return local;
}

Matrix SpaceBeam::local_stiffness() const {
  Matrix xy, xz;
  xy_.form({.stiffness = &xy});
  xz_.form({.stiffness = &xz});
  Matrix local = both_planes(xy, xz);
  add_torsion(torsion_, -torsion_, local);
  return local;
}

Matrix SpaceBeam::local_mass() const {
  Matrix xy, xz;
  xy_.form({.mass = &xy});
  xz_.form({.mass = &xz});
  Matrix local = both_planes(xy, xz);
  if (mass_ == BeamSection::Mass::consistent) add_torsion(polar_inertia_ / 3, polar_inertia_ / 6, local);
  if (mass_ == BeamSection::Mass::lumped) add_torsion(polar_inertia_ / 2, 0, local);
  return local;
}

void SpaceBeam::form(Local local) const {
  if (local.stiffness) *local.stiffness = to_global(axes_, local_stiffness());
  if (local.mass) *local.mass = to_global(axes_, local_mass());
  if (local.damping) local.damping->setZero(end_unknowns, end_unknowns);
}

Vector SpaceBeam::end_forces(const Vector& displacement) const {
  return local_stiffness() * to_local(displacement);
}

namespace {

/// N, V_y, V_z, T, M_y, M_z from the N, V, M of the two planes; the moment of the plane x-z turns about -y.
Matrix both_sections(const Matrix& xy, const Matrix& xz) {
  Matrix rows = Matrix::Zero(6, end_unknowns);
  for (int k = 0; k < 6; ++k) {
    rows(0, rows_xy[k]) += xy(0, k);
    rows(1, rows_xy[k]) += xy(1, k);
    rows(5, rows_xy[k]) += xy(2, k);
    rows(2, rows_xz[k]) += signs_xz[k] * xz(1, k);
    rows(4, rows_xz[k]) -= signs_xz[k] * xz(2, k);
  }
  return rows;
}

}  // namespace

SectionRows SpaceBeam::section(double xi) const {
  const SectionRows xy = xy_.section(xi), xz = xz_.section(xi);
  SectionRows rows{.stiffness = both_sections(xy.stiffness, xz.stiffness),
                   .geometric = both_sections(xy.geometric, xz.geometric),
                   .mass = both_sections(xy.mass, xz.mass)};
  rows.stiffness(3, turn_a) = -torsion_;
  rows.stiffness(3, turn_b) = torsion_;
  const double polar = polar_inertia_;
  if (mass_ == BeamSection::Mass::consistent) {  // less what lies before the section: the integral of 1 - s and s from 0 to xi
    rows.mass(3, turn_a) = polar * (-1.0 / 3 + xi - xi * xi / 2);
    rows.mass(3, turn_b) = polar * (-1.0 / 6 + xi * xi / 2);
  }
  if (mass_ == BeamSection::Mass::lumped) {
    if (xi <= 0) rows.mass(3, turn_a) = -polar / 2;
    if (xi >= 1) rows.mass(3, turn_b) = polar / 2;
  }
  Matrix axes = Matrix::Zero(end_unknowns, end_unknowns);
  for (int i = 0; i < end_unknowns; i += 3) axes.block<3, 3>(i, i) = axes_;
  for (Matrix* each : {&rows.stiffness, &rows.geometric, &rows.mass}) *each = (*each * axes).eval();
  return rows;
}

double SpaceBeam::axial_force(const Vector& displacement) const {
  const Vector local = to_local(displacement);
  Vector stretch = Vector::Zero(6);
  stretch[0] = local[0];
  stretch[3] = local[6];
  return xy_.axial_force(stretch);
}

void SpaceBeam::geometric(double axial, Matrix& stiffness) const {
  Matrix xy, xz;
  xy_.geometric(axial, xy);
  xz_.geometric(axial, xz);
  stiffness = to_global(axes_, both_planes(xy, xz));
}

}  // namespace uplift
