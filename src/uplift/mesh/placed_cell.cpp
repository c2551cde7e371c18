#include "uplift/mesh/placed_cell.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "uplift/math/lanes.h"
#include "uplift/mesh/cell_shapes.h"
#include "uplift/mesh/index.h"

namespace uplift {
namespace {

double largest_distance(std::span<const Vec3> corners) {
  double size = 0;
  for (const Vec3& corner : corners) size = std::max(size, (corner - corners.front()).norm());
  return size;
}

/// Shape functions in the centre of a linear cell, and then at its corners.
std::span<const CellShape> shapes_of(Cell cell) {
  static const auto all = [] {
    std::array<std::vector<CellShape>, num_cell_types> shapes;
    for (const CellInfo& type : all_cells()) {
      if (type.nodes != type.corners) continue;
      std::vector<CellShape>& of_cell = shapes[static_cast<std::size_t>(type.cell)];
      of_cell.push_back(cell_shape(type.cell, cell_centre(type.cell)));
      for (const auto& node : cell_nodes(type.cell)) of_cell.push_back(cell_shape(type.cell, {node[0], node[1], node[2]}));
    }
    return shapes;
  }();
  return all[static_cast<std::size_t>(cell)];
}

std::array<Vec3, 3> tangents(int dimension, const CellShape& shape, std::span<const Vec3> corners) {
  std::array<Vec3, 3> tangent{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (int k = 0; k < dimension; ++k) tangent[at(k)] = cell_tangent(shape, corners, k);
  return tangent;
}

/// A place [m] and the columns dx/dr_k of the Jacobian there.
struct Mapped {
  Vec3 place = Vec3::Zero();
  std::array<Vec3, 3> tangent{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

/// Of products of linear functions: in one pass over the corners, since warped cells are mapped at all points of all their parts.
template <std::size_t Dim>
Mapped mapped_product(Cell cell, std::span<const Vec3> corners, const Vec3& local) {
  const std::span<const std::array<double, 3>> nodes = cell_nodes(cell);
  Mapped here;
  for (std::size_t a = 0; a < (std::size_t{1} << Dim); ++a) {
    std::array<double, Dim> factor;
    double value = 1;
    for (std::size_t k = 0; k < Dim; ++k) value *= factor[k] = (1 + nodes[a][k] * local[static_cast<Index>(k)]) / 2;
    here.place += value * corners[a];
    for (std::size_t k = 0; k < Dim; ++k) {
      double slope = nodes[a][k] / 2;
      for (std::size_t m = 0; m < Dim; ++m)
        if (m != k) slope *= factor[m];
      here.tangent[k] += slope * corners[a];
    }
  }
  return here;
}

Mapped mapped(Cell cell, std::span<const Vec3> corners, const Vec3& local) {
  if (cell == Cell::hex8) return mapped_product<3>(cell, corners, local);
  if (cell == Cell::quad4) return mapped_product<2>(cell, corners, local);
  const CellShape shape = cell_shape(cell, local);
  return {cell_position(shape, corners), tangents(info(cell).dimension, shape, corners)};
}

/// The Jacobian is the same everywhere; `middle`: in the centre.
bool has_parallel_sides(Cell cell, std::span<const Vec3> corners, const std::array<Vec3, 3>& middle, double size) {
  if (is_simplex(cell)) return true;
  const double tolerance = 1e-10 * size;
  for (const CellShape& shape : shapes_of(cell).subspan(1))
    for (int k = 0; k < info(cell).dimension; ++k)
      if ((cell_tangent(shape, corners, k) - middle[at(k)]).norm() > tolerance) return false;
  return true;
}

/// Gradients of the local coordinates; of those that the cell does not have 0.
std::array<Vec3, 3> dual_tangents(int dimension, std::array<Vec3, 3> t) {
  std::array<Vec3, 3> dual{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  if (dimension == 1) t[1] = std::abs(t[0].x()) < 0.9 * t[0].norm() ? Vec3::UnitX() : Vec3::UnitY();
  if (dimension < 3) t[2] = cross(t[0], t[1]);
  if (dimension == 1) t[1] = cross(t[2], t[0]);
  const double volume = t[0].dot(cross(t[1], t[2]));
  for (int k = 0; k < dimension; ++k) dual[at(k)] = cross(t[at((k + 1) % 3)], t[at((k + 2) % 3)]) / volume;
  return dual;
}

}  // namespace

bool is_simplex(Cell cell) {
  return info(cell).corners == info(cell).dimension + 1;
}

double cell_measure(int dimension, const std::array<Vec3, 3>& tangent) {
  if (dimension == 1) return tangent[0].norm();
  const Vec3 area = cross(tangent[0], tangent[1]);
  return dimension == 2 ? area.norm() : std::abs(area.dot(tangent[2]));
}

Vec3 local_coordinates(Cell cell, std::span<const Vec3> corners, const Vec3& place) {
  constexpr double enough = 1e-8;  // Newton's method squares it
  const int dimension = info(cell).dimension;
  Vec3 local = cell_centre(cell);
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Mapped here = mapped(cell, corners, local);
    const Vec3 miss = place - here.place;
    const std::array<Vec3, 3> dual = dual_tangents(dimension, here.tangent);
    const Vec3 change(dual[0].dot(miss), dual[1].dot(miss), dual[2].dot(miss));
    local += change;
    if (change.norm() < enough) break;
  }
  return local;
}

PlacedCell::PlacedCell(Cell cell, std::span<const Vec3> corners) : type_(cell), count_(corners.size()), middle_(cell_centre(cell)) {
  assert(info(cell).nodes == info(cell).corners && count_ == at(info(cell).corners));
  std::copy(corners.begin(), corners.end(), corners_.begin());
  const int dimension = info(cell).dimension;
  const CellShape& shape = shapes_of(cell).front();
  centre_ = cell_position(shape, corners);
  tangent_ = tangents(dimension, shape, corners);
  dual_ = dual_tangents(dimension, tangent_);
  measure_ = cell_measure(dimension, tangent_);
  size_ = largest_distance(corners);
  parallel_ = has_parallel_sides(cell, corners, tangent_, size_);
}

Vec3 PlacedCell::local(const Vec3& place) const {
  if (!parallel_) return local_coordinates(type_, corners(), place);
  const Vec3 from = place - centre_;
  return middle_ + Vec3(dual_[0].dot(from), dual_[1].dot(from), dual_[2].dot(from));
}

std::array<double, max_corners> PlacedCell::shares(const Vec3& local) const {
  std::array<double, max_corners> share{};
  const std::span<const std::array<double, 3>> nodes = cell_nodes(type_);
  const int dimension = info(type_).dimension;
  if (count_ == std::size_t{1} << static_cast<unsigned>(dimension)) {  // products of linear functions
    for (std::size_t a = 0; a < count_; ++a) {
      share[a] = 1;
      for (std::size_t k = 0; k < at(dimension); ++k) share[a] *= (1 + nodes[a][k] * local[static_cast<Index>(k)]) / 2;
    }
    return share;
  }
  const CellShape shape = cell_shape(type_, local);
  std::copy_n(shape.value.begin(), count_, share.begin());
  return share;
}

Vec3 PlacedCell::place(const Vec3& local) const {
  const std::array<double, max_corners> share = shares(local);
  Vec3 sum = Vec3::Zero();
  for (std::size_t a = 0; a < count_; ++a) sum += share[a] * corners_[a];
  return sum;
}

double PlacedCell::measure(const Vec3& local) const {
  if (parallel_) return measure_;
  const int dimension = info(type_).dimension;
  return cell_measure(dimension, mapped(type_, corners(), local).tangent);
}

void PlacedCell::find(std::span<const Vec3> places, std::span<Vec3> local, std::span<double> measure) const {
  if (type_ == Cell::hex8 && !parallel_) return find_in_warped(places, local, measure);
  for (std::size_t i = 0; i < places.size(); ++i) {
    local[i] = this->local(places[i]);
    measure[i] = this->measure(local[i]);
  }
}

namespace {

/// Places or directions side by side in the registers.
struct LaneVec {
  Lanes x, y, z;
  [[gnu::always_inline]] friend LaneVec operator+(const LaneVec& a, const LaneVec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  [[gnu::always_inline]] friend LaneVec operator-(const LaneVec& a, const LaneVec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  [[gnu::always_inline]] friend LaneVec operator*(const Lanes& f, const LaneVec& a) { return {f * a.x, f * a.y, f * a.z}; }
  [[gnu::always_inline]] friend Lanes dot(const LaneVec& a, const LaneVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  [[gnu::always_inline]] friend LaneVec cross(const LaneVec& a, const LaneVec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

/// A trilinear mapping x = c_0 + c_1 r + c_2 s + c_3 t + c_4 r s + c_5 s t + c_6 t r + c_7 r s t.
using Trilinear = std::array<LaneVec, 8>;

Trilinear trilinear(std::span<const Vec3> corners) {
  Trilinear made{};
  const std::span<const std::array<double, 3>> nodes = cell_nodes(Cell::hex8);
  for (std::size_t m = 0; m < made.size(); ++m) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t a = 0; a < made.size(); ++a) {
      const auto& [r, s, t] = nodes[a];
      const std::array<double, 8> sign{1, r, s, t, r * s, s * t, t * r, r * s * t};
      sum += sign[m] / 8 * corners[a];
    }
    made[m] = {sum[0], sum[1], sum[2]};
  }
  return made;
}

/// One iteration of Newton's method; the squares of the changes, and the volumes over that of the reference cell before it.
[[gnu::always_inline]] inline Lanes improve(const Trilinear& c, const LaneVec& place, LaneVec& local, Lanes& measure) {
  const auto [r, s, t] = local;
  const LaneVec a = c[1] + s * c[4] + t * (c[6] + s * c[7]);  // tangents
  const LaneVec b = c[2] + r * c[4] + t * (c[5] + r * c[7]);
  const LaneVec d = c[3] + s * c[5] + r * (c[6] + s * c[7]);
  const LaneVec miss = place - (c[0] + r * a + s * (c[2] + t * c[5]) + t * c[3]);
  const LaneVec across = cross(b, d), turned = cross(miss, a);
  const Lanes volume = dot(a, across), inverse = 1 / volume;
  const LaneVec change = inverse * LaneVec{dot(miss, across), -dot(d, turned), dot(b, turned)};  // Cramer's rule
  local = local + change;
  measure = absolute(volume);
  return dot(change, change);
}

}  // namespace

/// As local_coordinates, for as many places at once as a register holds.
void PlacedCell::find_in_warped(std::span<const Vec3> places, std::span<Vec3> local, std::span<double> measure) const {
  constexpr double enough = 1e-8;  // Newton's method squares it
  const Trilinear map = trilinear(corners());
  for (std::size_t first = 0; first < places.size(); first += at(lanes)) {
    const auto component = [&](Index k) { return Lanes([&](auto lane) { return places[std::min(first + lane, places.size() - 1)][k]; }); };
    const LaneVec place{component(0), component(1), component(2)};
    LaneVec found{0, 0, 0};
    Lanes volume;  // over that of the reference cell
    for (int iteration = 0; iteration < 30; ++iteration)
      if (largest(improve(map, place, found, volume)) < enough * enough) break;
    improve(map, place, found, volume);  // for the volume
    for (std::size_t i = 0; i < at(lanes) && first + i < places.size(); ++i) {
      local[first + i] = Vec3(found.x[i], found.y[i], found.z[i]);
      measure[first + i] = volume[i];
    }
  }
}

}  // namespace uplift
