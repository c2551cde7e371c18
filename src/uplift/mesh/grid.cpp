#include "uplift/mesh/grid.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>

#include "uplift/mesh/convert.h"
#include "uplift/mesh/index.h"

namespace uplift {
namespace {

/// One piece of an axis on which the wanted length of a cell is linear in the place: h = h0 + rate * s.
struct Ramp {
  double length, h0, rate;
  /// Cells in the first s of the piece: integral of ds / h.
  double cells(double s) const { return std::abs(rate * s) < 1e-9 * h0 ? s / h0 : std::log1p(rate * s / h0) / rate; }
  /// The place at which so many cells are full: the inverse.
  double place(double n) const { return std::abs(rate * n) < 1e-9 ? n * h0 : h0 * std::expm1(rate * n) / rate; }
};

/// The wanted length of cells of a stretch: up from the left size, level at the largest, down to the right size.
/// h = start * rate / (growth - 1) + rate * s with rate = ln(growth): cells of one unit of the integral are then start * growth^i long.
std::vector<Ramp> ramps(double length, double left, double right, double largest, double growth) {
  const double rate = std::log(growth), scale = rate / (growth - 1);
  const double a = left < largest ? left * scale : largest, b = right < largest ? right * scale : largest;
  double up = (largest - a) / rate, down = (largest - b) / rate;
  if (up + down > length) {  // they meet below the largest size, or one slope reaches the other end
    up = std::clamp((length + (b - a) / rate) / 2, 0.0, length);
    down = length - up;
  }
  std::vector<Ramp> result;
  if (up > 0) result.push_back({up, a, rate});
  if (length - up - down > 0) result.push_back({length - up - down, largest, 0});
  if (down > 0) result.push_back({down, std::min(largest, b + rate * down), -rate});
  return result;
}

/// Lines inside and at the right end of a stretch, at equal steps of the number of cells.
void fill(std::vector<double>& lines, double to, double left, double right, double largest, double growth) {
  const double from = lines.back();
  const std::vector<Ramp> pieces = ramps(to - from, left, right, largest, growth);
  double all = 0;
  for (const Ramp& ramp : pieces) all += ramp.cells(ramp.length);
  constexpr double round_off = 1e-9;
  const int count = std::max(1, static_cast<int>(std::ceil(all - round_off)));
  std::size_t piece = 0;
  double before = 0, begin = from;
  for (int i = 1; i < count; ++i) {
    const double wanted = all * i / count;
    while (piece + 1 < pieces.size() && before + pieces[piece].cells(pieces[piece].length) < wanted) {
      before += pieces[piece].cells(pieces[piece].length);
      begin += pieces[piece].length;
      ++piece;
    }
    lines.push_back(begin + pieces[piece].place(wanted - before));
  }
  lines.push_back(to);
}

/// Numbers of the cells and nodes of a grid.
class GridCells {
 public:
  GridCells(const Grid& lines, const PartOf& part_of)
      : dimension_(lines.dimension()), nx_(count(lines.x)), ny_(count(lines.y)), nz_(dimension_ == 2 ? 1 : count(lines.z)) {
    parts_.reserve(at(nx_) * at(ny_) * at(nz_));
    for (int k = 0; k < nz_; ++k)
      for (int j = 0; j < ny_; ++j)
        for (int i = 0; i < nx_; ++i) parts_.push_back(part_of(i, j, k));
  }
  int part(std::array<int, 3> c) const {
    if (c[0] < 0 || c[1] < 0 || c[2] < 0 || c[0] >= nx_ || c[1] >= ny_ || c[2] >= nz_) return -1;
    return parts_[(at(c[2]) * at(ny_) + at(c[1])) * at(nx_) + at(c[0])];
  }
  /// Grid nodes of a cell in VTK order; returns how many.
  std::array<std::size_t, 8> nodes(std::array<int, 3> c) const {
    const std::size_t row = at(nx_) + 1, layer = row * (at(ny_) + 1), n = (at(c[2]) * (at(ny_) + 1) + at(c[1])) * row + at(c[0]);
    return {n, n + 1, n + 1 + row, n + row, n + layer, n + 1 + layer, n + 1 + row + layer, n + row + layer};
  }
  template <class Act>
  void for_each(Act&& act) const {
    for (int k = 0; k < nz_; ++k)
      for (int j = 0; j < ny_; ++j)
        for (int i = 0; i < nx_; ++i)
          if (const std::array c{i, j, k}; part(c) >= 0) act(c, part(c));
  }

 private:
  static int count(const std::vector<double>& lines) { return static_cast<int>(lines.size()) - 1; }
  int dimension_, nx_, ny_, nz_;
  std::vector<int> parts_;
};

/// Makes the nodes that a cell has; the number of each grid node, -1 for those of no cell.
std::vector<int> make_nodes(Mesh& mesh, const Grid& lines, const GridCells& cells) {
  const std::size_t nx = lines.x.size(), ny = lines.y.size(), nz = std::max<std::size_t>(1, lines.z.size());
  std::vector<int> number(nx * ny * nz, -1);
  const std::size_t corners = mesh.dimension == 2 ? 4 : 8;
  cells.for_each([&](std::array<int, 3> c, int) {
    const auto n = cells.nodes(c);
    for (std::size_t a = 0; a < corners; ++a) number[n[a]] = 0;
  });
  const auto count = static_cast<std::size_t>(std::ranges::count(number, 0));
  mesh.nodes.reserve(count + count / 16);  // surfaces that are opened add some
  for (std::size_t g = 0; g < number.size(); ++g) {
    if (number[g] < 0) continue;
    number[g] = static_cast<int>(mesh.nodes.size());
    mesh.nodes.emplace_back(lines.x[g % nx], lines.y[g / nx % ny], mesh.dimension == 2 ? 0.0 : lines.z[g / (nx * ny)]);
  }
  return number;
}

/// Sides of quadrilaterals and bricks: which way, and where the neighbour is.
struct Way {
  Direction direction;
  int side;  // in side_of
  std::array<int, 3> step;
};
constexpr Way plane_ways[] = {
    {Direction::bottom, 0, {0, -1, 0}}, {Direction::right, 1, {1, 0, 0}}, {Direction::top, 2, {0, 1, 0}}, {Direction::left, 3, {-1, 0, 0}}};
constexpr Way space_ways[] = {{Direction::left, 0, {-1, 0, 0}}, {Direction::right, 1, {1, 0, 0}},   {Direction::front, 2, {0, -1, 0}},
                              {Direction::back, 3, {0, 1, 0}},  {Direction::bottom, 4, {0, 0, -1}}, {Direction::top, 5, {0, 0, 1}}};

}  // namespace

std::vector<double> graded_lines(double from, const std::vector<Stretch>& stretches, double growth) {
  assert(growth > 1 && !stretches.empty());
  const std::size_t n = stretches.size();
  std::vector<double> size(n + 1), lines{from};  // size: of the cells at the ends of stretches
  for (std::size_t i = 0; i <= n; ++i) size[i] = std::min(stretches[i > 0 ? i - 1 : 0].size, stretches[i < n ? i : n - 1].size);
  const auto length = [&](std::size_t i) { return stretches[i].to - (i ? stretches[i - 1].to : from); };
  for (std::size_t i = 0; i < n; ++i) size[i + 1] = std::min(size[i + 1], size[i] + (growth - 1) * length(i));
  for (std::size_t i = n; i-- > 0;) size[i] = std::min(size[i], size[i + 1] + (growth - 1) * length(i));
  for (std::size_t i = 0; i < n; ++i) {
    assert(stretches[i].to > lines.back() && stretches[i].size > 0);
    fill(lines, stretches[i].to, size[i], size[i + 1], stretches[i].size, growth);
  }
  return lines;
}

std::string_view name_of(Direction direction) {
  constexpr std::string_view names[] = {"left", "right", "front", "back", "bottom", "top"};
  return names[static_cast<std::size_t>(direction)];
}

Mesh grid(const Grid& lines, const PartOf& part_of, const std::vector<std::string>& names, const FaceName& face_name) {
  Mesh mesh;
  mesh.dimension = lines.dimension();
  const GridCells cells(lines, part_of);
  const std::vector<int> number = make_nodes(mesh, lines, cells);
  const bool plane = mesh.dimension == 2;
  const Cell type = plane ? Cell::quad4 : Cell::hex8, face = plane ? Cell::line2 : Cell::quad4;
  mesh.blocks = {{type, {}}, {face, {}}};
  const std::span<const Way> ways = plane ? std::span<const Way>(plane_ways) : std::span<const Way>(space_ways);
  std::vector<Group> parts(names.size(), Group{mesh.dimension, {}, {}});
  CellBlock &volumes = mesh.blocks[0], &faces = mesh.blocks[1];
  std::vector<std::size_t> counts(names.size(), 0);
  cells.for_each([&](std::array<int, 3>, int part) { ++counts[at(part)]; });
  for (std::size_t p = 0; p < names.size(); ++p) parts[p].cells.reserve(counts[p]);
  volumes.nodes.reserve(std::accumulate(counts.begin(), counts.end(), std::size_t{0}) * at(info(type).nodes));
  cells.for_each([&](std::array<int, 3> c, int part) {
    const auto corners = cells.nodes(c);
    parts[at(part)].cells.push_back({0, volumes.count()});
    for (std::size_t a = 0; a < at(info(type).nodes); ++a) volumes.nodes.push_back(number[corners[a]]);
    for (const Way& way : ways) {
      const int other = cells.part({c[0] + way.step[0], c[1] + way.step[1], c[2] + way.step[2]});
      if (other == part) continue;
      const std::string name = face_name(part, way.direction, other);
      if (name.empty()) continue;
      Group& group = mesh.groups[name];
      group.dimension = mesh.dimension - 1;
      group.cells.push_back({1, faces.count()});
      for (const int a : side_of(type, way.side)) faces.nodes.push_back(number[corners[at(a)]]);
    }
  });
  for (std::size_t p = 0; p < names.size(); ++p)
    if (!parts[p].cells.empty()) mesh.groups[names[p]] = std::move(parts[p]);
  if (faces.nodes.empty()) mesh.blocks.pop_back();
  return mesh;
}

Mesh with_cells(Mesh mesh, Cell cell) {
  assert(info(cell).dimension == mesh.dimension);
  const Cell linear = info(cell).linear;
  if (linear == Cell::tri3 || linear == Cell::tet4) mesh = to_simplices(mesh);
  if (linear == Cell::wedge6) mesh = to_wedges(mesh);
  if (cell != linear) mesh = to_second_degree(mesh, cell == Cell::quad9 || cell == Cell::hex27);
  return mesh;
}

}  // namespace uplift
