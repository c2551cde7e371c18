#include "uplift/elements/absorbing.h"

#include <cassert>
#include <cmath>

#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"

namespace uplift {

namespace {

/// Shape functions, normal and area of the points of a face.
struct FacePoint {
  CellShape shape;
  Vec3 normal;
  double area;  // m2
};

std::vector<FacePoint> face_points(Cell cell, const CellRule& rule, std::span<const int> nodes, const std::vector<Vec3>& coordinates,
                                   double thickness) {
  std::vector<Vec3> positions;
  for (const int node : nodes) positions.push_back(coordinates[static_cast<std::size_t>(node)]);
  std::vector<FacePoint> points;
  for (std::size_t p = 0; p < rule.point.size(); ++p) {
    const CellShape shape = cell_shape(cell, rule.point[p]);
    const Vec3 area = cell_area_vector(shape, positions, cell);
    assert(area.norm() > 0);
    points.push_back({shape, area.normalized(), rule.weight[p] * area.norm() * thickness});
  }
  return points;
}

}  // namespace

AbsorbingFace::AbsorbingFace(Cell cell, std::span<const int> nodes, Coordinates coordinates, AbsorbingSection section, const CellRule* part)
    : cell_(cell),
      dimension_(info(cell).dimension + 1),
      nodes_(nodes.begin(), nodes.end()),
      coordinates_(std::move(coordinates)),
      section_(section),
      rule_(part ? *part : cell_rule(cell, info(cell).nodes == info(cell).corners ? 3 : 5)) {  // N_a N_b on plane faces
  assert((dimension_ == 2 || dimension_ == 3) && static_cast<int>(nodes_.size()) == info(cell).nodes);
  assert(section_.material.density > 0 && section_.thickness > 0);
}

double AbsorbingFace::area() const {
  double sum = 0;
  for (const FacePoint& p : face_points(cell_, rule_, nodes_, *coordinates_, dimension_ == 2 ? section_.thickness : 1)) sum += p.area;
  return sum;
}

Matrix AbsorbingFace::damping() const {
  const auto points = face_points(cell_, rule_, nodes_, *coordinates_, dimension_ == 2 ? section_.thickness : 1);
  const auto n = nodes_.size();
  double all = 0, of_squares = 0;  // the area, and the sum of int N_a^2 dA
  for (const FacePoint& p : points) {
    all += p.area;
    for (std::size_t a = 0; a < n; ++a) of_squares += p.area * p.shape.value[a] * p.shape.value[a];
  }
  const bool scaled = cell_ == Cell::tri6 || cell_ == Cell::quad8;
  const double normal = section_.material.density * section_.material.p_wave_speed();
  const double tangential = section_.material.density * section_.material.s_wave_speed();
  Matrix c = Matrix::Zero(dimension_ * static_cast<Index>(n), dimension_ * static_cast<Index>(n));
  for (const FacePoint& p : points) {
    const Mat3 impedance = tangential * Mat3::Identity() + (normal - tangential) * p.normal * p.normal.transpose();
    const auto add = [&](std::size_t a, std::size_t b, double area) {
      c.block(dimension_ * static_cast<Index>(a), dimension_ * static_cast<Index>(b), dimension_, dimension_) +=
          area * impedance.topLeftCorner(dimension_, dimension_);
    };
    for (std::size_t a = 0; a < n; ++a) {
      const double value = p.shape.value[a];
      if (section_.lumped) {
        add(a, a, p.area * (scaled ? value * value * all / of_squares : value));
      } else {
        for (std::size_t b = 0; b < n; ++b) add(a, b, p.area * (value * p.shape.value[b]));
      }
    }
  }
  return c;
}

void AbsorbingFace::form(Local local) const {
  const Index n = dimension_ * static_cast<Index>(nodes_.size());
  if (local.stiffness) local.stiffness->setZero(n, n);
  if (local.mass) local.mass->setZero(n, n);
  if (local.damping) *local.damping = damping();
}

Vector AbsorbingFace::incident(const Vec3& motion) const {
  Vector everywhere(dimension_ * static_cast<Index>(nodes_.size()));
  for (Index a = 0; a < everywhere.size(); a += dimension_) everywhere.segment(a, dimension_) = motion.head(dimension_);
  return 2 * damping() * everywhere;
}

Vec3 wave_motion(Wave wave, int dimension, double azimuth) {
  if (dimension == 2) {
    assert(wave != Wave::sh);
    return wave == Wave::p ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
  }
  if (wave == Wave::p) return {0, 0, 1};
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  return wave == Wave::sv ? Vec3(c, s, 0) : Vec3(-s, c, 0);
}

}  // namespace uplift
