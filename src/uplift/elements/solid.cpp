#include "uplift/elements/solid.h"

#include <algorithm>
#include <cassert>

#include "uplift/elements/solid_rules.h"
#include "uplift/math/dense.h"
#include "uplift/mesh/cell_shapes.h"

namespace uplift {

namespace {

std::unique_ptr<const int[]> copy_of(std::span<const int> nodes) {
  auto copy = std::make_unique_for_overwrite<int[]>(nodes.size());
  std::ranges::copy(nodes, copy.get());
  return copy;
}

/// Without incompatible modes.
std::shared_ptr<const SolidSection> compatible(const SolidSection& section) {
  auto made = std::make_shared<SolidSection>(section);
  made->incompatible_modes = false;
  return made;
}

}  // namespace

Solid::Solid(Cell cell, std::span<const int> nodes, Coordinates coordinates, std::shared_ptr<const SolidSection> section,
             const CellRule* part)
    : cell_(cell),
      dimension_(info(cell).dimension),
      nodes_(copy_of(nodes)),
      coordinates_(std::move(coordinates)),
      section_(std::move(section)),
      part_(part ? std::make_unique<const CellRule>(*part) : nullptr) {
  if (part_ && section_->incompatible_modes) section_ = compatible(*section_);  // their patch test is that of whole cells
  assert(dimension_ >= 2 && static_cast<int>(nodes.size()) == info(cell).nodes);
  assert(section_->thickness > 0);
}

void Solid::form(Local local) const {
  if (local.stiffness) form_stiffness(*local.stiffness);
  if (local.mass) form_mass(*local.mass);
  if (local.damping) local.damping->setZero(unknowns(), unknowns());
}

int Solid::num_points() const {
  return part_ ? static_cast<int>(part_->weight.size()) : solid_tables(cell_).stiffness.points();
}

std::shared_ptr<const SolidTables> Solid::tables() const {
  if (part_) return std::make_shared<const SolidTables>(part_tables(cell_, *part_));
  return {std::shared_ptr<const SolidTables>(), &solid_tables(cell_)};
}

int Solid::num_modes() const {
  return section_->incompatible_modes ? num_bubbles(cell_) : 0;
}

double Solid::volume() const {
  double sum = 0;
  for (const PointGradient& at : gradients()) sum += at.volume;
  return sum;
}

Stress Solid::elastic_stress(const Strain& strain) const {
  const bool flat = dimension_ == 2 && section_->plane == PlaneState::stress;
  const double mu = section_->material.shear(),
               lambda = flat ? section_->material.plane_lame(PlaneState::stress) : section_->material.lame();
  Stress stress;
  stress.head<3>() = 2 * mu * strain.head<3>();
  stress.head<3>().array() += lambda * strain.head<3>().sum();
  stress.tail<3>() = mu * strain.tail<3>();
  if (flat) stress[2] = 0;
  return stress;
}

Vector Solid::mode_amplitudes(const std::vector<PointGradient>& points, const Vector& displacement) const {
  // no force on the modes: K_aa alpha = -K_au u; the right-hand side is the force of the compatible stress
  const int nodes = static_cast<int>(this->nodes().size()), modes = num_modes(), n = dimension_ * modes;
  Vector force = Vector::Zero(n);
  Matrix stiffness = Matrix::Zero(n, n);
  for (const PointGradient& at : points) {
    Strain strain = Strain::Zero();
    add_strain(at, dimension_, 0, nodes, displacement.data(), strain);
    add_force(at, dimension_, nodes, modes, elastic_stress(strain), force.data());
    for (int c = 0; c < n; ++c) {
      const Vec3 unit = Vec3::Unit(c % dimension_);
      Strain of_mode = Strain::Zero();
      add_strain(at, dimension_, nodes + c / dimension_, 1, unit.data(), of_mode);
      add_force(at, dimension_, nodes, modes, elastic_stress(of_mode), stiffness.col(c).data());
    }
  }
  return -Cholesky(stiffness).solve(force);
}

std::vector<Stress> Solid::point_stress(const Vector& displacement) const {
  assert(displacement.size() == unknowns());
  const int nodes = static_cast<int>(this->nodes().size()), modes = num_modes();
  const std::vector<PointGradient> points = gradients();
  const Vector amplitude = modes > 0 ? mode_amplitudes(points, displacement) : Vector();
  std::vector<Stress> stress;
  stress.reserve(points.size());
  for (const PointGradient& at : points) {
    Strain strain = Strain::Zero();
    add_strain(at, dimension_, 0, nodes, displacement.data(), strain);
    if (modes > 0) add_strain(at, dimension_, nodes, modes, amplitude.data(), strain);
    stress.push_back(elastic_stress(strain));
  }
  return stress;
}

std::vector<Stress> Solid::extrapolate(const std::vector<Stress>& at_points) const {
  const std::shared_ptr<const SolidTables> made = tables();
  const Matrix& to_nodes = made->to_nodes;
  std::vector<Stress> at_nodes(this->nodes().size(), Stress::Zero());
  for (Index a = 0; a < to_nodes.rows(); ++a)
    for (Index p = 0; p < to_nodes.cols(); ++p)
      at_nodes[static_cast<std::size_t>(a)] += to_nodes(a, p) * at_points[static_cast<std::size_t>(p)];
  return at_nodes;
}

std::vector<double> Solid::extrapolate(const std::vector<double>& at_points) const {
  const std::shared_ptr<const SolidTables> made = tables();
  const Matrix& to_nodes = made->to_nodes;
  const Vector at_nodes = to_nodes * ConstMap(at_points.data(), to_nodes.cols());
  return {at_nodes.begin(), at_nodes.end()};
}

std::vector<double> Solid::in_one_list(const std::vector<Stress>& all) {
  std::vector<double> list;
  for (const Stress& each : all) list.insert(list.end(), each.begin(), each.end());
  return list;
}

std::vector<Stress> Solid::node_stress(const Vector& displacement) const {
  return extrapolate(point_stress(displacement));
}

std::vector<ElementOutput> Solid::outputs() const {
  return {{"stress", "Pa", 6}};
}

std::vector<double> Solid::at_nodes(std::size_t, const Vector& displacement, std::span<const double>) const {
  return in_one_list(node_stress(displacement));
}

}  // namespace uplift
