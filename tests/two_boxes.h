#pragma once
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "uplift/elements/solid.h"

// Shared by tests and benchmarks. Matrices of a block on soil without a model: two boxes of 4-node quads or 8-node bricks with node pairs
// between them.
namespace uplift {

/// Free unknowns: (ux, uy) or (ux, uy, uz) of every node, the soil's bottom left out. Rows of B: openings of the node pairs (block less
/// soil), and with `slips` the differences along x as well.
struct TwoBoxes {
  Sparse stiffness, mass, b;
  int dimension = 2;
  Vector area;  // per row [m2]: tributary
};

struct TwoBoxesPlan {
  std::array<int, 3> soil{12, 12, 6};  // cells along x, y and up; y is not there in 2D
  int block_width = 4, block_height = 4;
  int dimension = 2;
  SolidSection::Mass mass = SolidSection::Mass::consistent;
  bool slips = true;
  double size = 1;     // m
  double stiff = 100;  // the block's modulus over the soil's
};

inline TwoBoxes two_boxes(const TwoBoxesPlan& plan) {
  const int d = plan.dimension, up = d - 1;
  const auto positions = std::make_shared<std::vector<Vec3>>();
  std::vector<std::pair<int, int>> pairs;
  std::vector<double> areas;
  std::vector<Triplet> k_entries, m_entries;
  std::vector<std::unique_ptr<Solid>> solids;
  std::vector<char> held;

  const auto box = [&](std::array<int, 3> cells, std::array<int, 3> from, const ElasticMaterial& material, bool bottom_held) {
    if (d == 2) cells[1] = 0;
    const int first = static_cast<int>(positions->size());
    const auto node = [&](int i, int j, int k) { return first + (k * (cells[1] + 1) + j) * (cells[0] + 1) + i; };
    for (int k = 0; k <= cells[2]; ++k)
      for (int j = 0; j <= cells[1]; ++j)
        for (int i = 0; i <= cells[0]; ++i) {
          const Vec3 at = plan.size * Vec3(from[0] + i, from[1] + j, from[2] + k);
          positions->push_back(d == 2 ? Vec3(at.x(), at.z(), 0) : at);
          held.push_back(bottom_held && k == 0);
        }
    SolidSection section;
    section.material = material;
    section.mass = plan.mass;
    std::vector<std::vector<int>> list;
    for (int k = 0; k < cells[2]; ++k)
      for (int j = 0; j < std::max(1, cells[1]); ++j)
        for (int i = 0; i < cells[0]; ++i) {
          if (d == 2)
            list.push_back({node(i, 0, k), node(i + 1, 0, k), node(i + 1, 0, k + 1), node(i, 0, k + 1)});
          else
            list.push_back({node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k), node(i, j, k + 1),
                            node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)});
        }
    const auto share = std::make_shared<const std::vector<Vec3>>(*positions);
    for (const auto& nodes : list) solids.push_back(std::make_unique<Solid>(d == 2 ? Cell::quad4 : Cell::hex8, nodes, share, section));
  };
  const int side = (plan.soil[0] - plan.block_width) / 2, height = plan.soil[2];
  const int depth = d == 2 ? 0 : (plan.soil[1] - plan.block_width) / 2;
  box(plan.soil, {0, 0, 0}, {200e6, 0.3, 2000}, true);
  const int block_first = static_cast<int>(positions->size()), wide = plan.block_width + 1;
  if (plan.block_height > 0)
    box({plan.block_width, plan.block_width, plan.block_height}, {side, depth, height}, {plan.stiff * 200e6, 0.2, 2500}, false);
  for (int j = 0; plan.block_height > 0 && j < (d == 2 ? 1 : wide); ++j)
    for (int i = 0; i < wide; ++i) {
      const int below = (height * (d == 2 ? 1 : plan.soil[1] + 1) + depth + j) * (plan.soil[0] + 1) + side + i;
      pairs.emplace_back(below, block_first + j * wide + i);
      const bool edge_i = i == 0 || i == wide - 1, edge_j = d == 3 && (j == 0 || j == wide - 1);
      areas.push_back((edge_i ? 0.5 : 1) * (edge_j ? 0.5 : 1) * std::pow(plan.size, d - 1));
    }

  std::vector<int> number(positions->size() * static_cast<std::size_t>(d), -1);
  int free = 0;
  for (std::size_t n = 0; n < positions->size(); ++n)
    for (int c = 0; c < d; ++c)
      if (!held[n]) number[n * static_cast<std::size_t>(d) + static_cast<std::size_t>(c)] = free++;
  const auto unknown = [&](int node, int c) { return number[static_cast<std::size_t>(d * node + c)]; };
  Matrix k, m;
  for (const auto& solid : solids) {
    solid->form({&k, &m, nullptr});
    const auto nodes = solid->nodes();
    for (Index j = 0; j < k.cols(); ++j)
      for (Index i = 0; i < k.rows(); ++i) {
        const int row = unknown(nodes[static_cast<std::size_t>(i / d)], static_cast<int>(i % d)),
                  col = unknown(nodes[static_cast<std::size_t>(j / d)], static_cast<int>(j % d));
        if (row < 0 || col < 0) continue;
        if (k(i, j) != 0) k_entries.emplace_back(row, col, k(i, j));
        if (m(i, j) != 0) m_entries.emplace_back(row, col, m(i, j));
      }
  }
  TwoBoxes result;
  result.dimension = d;
  result.stiffness.resize(free, free);
  result.stiffness.setFromTriplets(k_entries.begin(), k_entries.end());
  result.mass.resize(free, free);
  result.mass.setFromTriplets(m_entries.begin(), m_entries.end());
  const int points = static_cast<int>(pairs.size()), components = plan.slips ? 2 : 1;
  std::vector<Triplet> b;
  result.area.resize(points * components);
  for (int p = 0; p < points; ++p)
    for (int c = 0; c < components; ++c) {
      const int row = c * points + p, along = c == components - 1 ? up : 0;
      b.emplace_back(row, unknown(pairs[static_cast<std::size_t>(p)].second, along), 1.0);
      b.emplace_back(row, unknown(pairs[static_cast<std::size_t>(p)].first, along), -1.0);
      result.area[row] = areas[static_cast<std::size_t>(p)];
    }
  result.b.resize(points * components, free);
  result.b.setFromTriplets(b.begin(), b.end());
  return result;
}

}  // namespace uplift
