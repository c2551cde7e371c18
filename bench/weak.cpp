// Weak scaling of what a step takes on several ranks: a uniform block of soil of cubes of 1 m (V_s = 300 m/s, 8-node bricks with
// incompatible modes, held below), of which every rank has as many layers, for steps of 5 ms: the product with K + 4 M / dt2, and its
// solution by conjugate gradients with Jacobi's preconditioner to 1e-12; once with the entries of the matrix, once cell by cell with the
// matrix of one cube. Every number of ranks 1, 2, 4, ... up to those of the job is measured by itself. GB/s: of the entries, 12 bytes each;
// Gflop/s: two for an entry of the matrix or of a cube's. Usage: mpirun -n RANKS bench_weak [unknowns of a rank, default 100000]
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <thread>

#include "uplift/distributed/petsc.h"
#include "uplift/distributed/system.h"
#include "uplift/elements/solid.h"

namespace uplift {
namespace {

constexpr int across = 20;  // cubes along both sides of a layer
constexpr double step = 5e-3;

/// One cube's K + 4 M / dt2; its corners are numbered along x, then y, then z.
Matrix cube_matrix() {
  ElasticMaterial soil;
  soil.poisson = 0.3, soil.density = 2000, soil.young = 2 * (1 + 0.3) * 2000 * 300 * 300;
  SolidSection section;
  section.material = soil;
  std::vector<Vec3> corners;
  for (int c = 0; c < 8; ++c) corners.emplace_back(c & 1, c >> 1 & 1, c >> 2);
  const int nodes[] = {0, 1, 3, 2, 4, 5, 7, 6};  // as in VTK
  const Solid cube(Cell::hex8, nodes, std::make_shared<const std::vector<Vec3>>(corners), section);
  Matrix stiffness, mass;
  cube.form({&stiffness, &mass, nullptr});
  const Matrix sum = stiffness + 4 / (step * step) * mass;
  Matrix ordered(24, 24);
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b < 8; ++b) ordered.block<3, 3>(3 * nodes[a], 3 * nodes[b]) = sum.block<3, 3>(3 * a, 3 * b);
  return ordered;
}

/// Nodes at (x, y, z), z from 0 above the ground that holds the lowest cubes, which are those of z = -1.
struct Block {
  int layers;  // of nodes
  static constexpr int wide = across + 1, per_layer = wide * wide;
  bool cube(int x, int y, int z) const { return x >= 0 && x < across && y >= 0 && y < across && z >= -1 && z < layers - 1; }
};

/// The rows of the layers from `first` to below `last`, with a unit diagonal.
LocalRows rows_of(const Block& block, int first, int last, const Matrix& cube) {
  LocalRows rows;
  rows.start.push_back(0);
  const auto add = [&](int x, int y, int z, const auto& take) {  // every cube at a node, and which of its corners the node is
    for (int corner = 0; corner < 8; ++corner)
      if (block.cube(x - (corner & 1), y - (corner >> 1 & 1), z - (corner >> 2))) take(corner);
  };
  const auto diagonal = [&](int x, int y, int z, int d) {
    double sum = 0;
    add(x, y, z, [&](int corner) { sum += cube(3 * corner + d, 3 * corner + d); });
    return sum;
  };
  for (int z = first; z < last; ++z)
    for (int y = 0; y < Block::wide; ++y)
      for (int x = 0; x < Block::wide; ++x) {
        double sums[27][3][3] = {};
        bool there[27] = {};
        add(x, y, z, [&](int corner) {
          for (int other = 0; other < 8; ++other) {
            const int dx = (other & 1) - (corner & 1), dy = (other >> 1 & 1) - (corner >> 1 & 1), dz = (other >> 2) - (corner >> 2);
            const int place = dx + 1 + 3 * (dy + 1) + 9 * (dz + 1);
            if (z + dz < 0) continue;  // held
            there[place] = true;
            for (int d = 0; d < 3; ++d)
              for (int e = 0; e < 3; ++e) sums[place][d][e] += cube(3 * corner + d, 3 * other + e);
          }
        });
        for (int d = 0; d < 3; ++d) {
          const double own = diagonal(x, y, z, d);
          for (int place = 0; place < 27; ++place) {
            if (!there[place]) continue;
            const int nx = x + place % 3 - 1, ny = y + place / 3 % 3 - 1, nz = z + place / 9 - 1;
            for (int e = 0; e < 3; ++e) {
              rows.column.push_back(3 * (nz * Block::per_layer + ny * Block::wide + nx) + e);
              rows.value.push_back(sums[place][d][e] / std::sqrt(own * diagonal(nx, ny, nz, e)));
            }
          }
          rows.start.push_back(static_cast<PetscInt>(rows.column.size()));
        }
      }
  return rows;
}

/// The cubes that reach these layers, and the scale that makes the diagonal one.
ScaledCells cells_of(const Block& block, int first, int last, const Matrix& cube) {
  EqualCells cells{24, {}};
  for (int z = first - 1; z < std::min(last, block.layers - 1); ++z)
    for (int y = 0; y < across; ++y)
      for (int x = 0; x < across; ++x)
        for (int corner = 0; corner < 8; ++corner) {
          const int up = z + (corner >> 2), node = up * Block::per_layer + (y + (corner >> 1 & 1)) * Block::wide + x + (corner & 1);
          for (int d = 0; d < 3; ++d) cells.rows.push_back(up < 0 ? -1 : 3 * node + d);
        }
  const int rows = 3 * Block::per_layer;
  const auto made = std::make_shared<const RankCells>(first * rows, (last - first) * rows, std::vector{std::move(cells)});
  const Vector diagonal = made->diagonal({cube});
  ScaledCells scaled{made, {cube}, {}};
  for (const double entry : diagonal) scaled.scale.push_back(1 / std::sqrt(entry));
  return scaled;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Figures {
  double unknowns = 0, entries = 0, operations = 0, product = 0, solve = 0, iterations = 0, memory = 0;  // s, s, B of the largest rank
};

double most_of(double value, MPI_Comm ranks) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, ranks);
  return value;
}

/// Median over repetitions of the slowest rank's time of one product.
double product_seconds(const System& system, MPI_Comm ranks) {
  Vec x = nullptr, y = nullptr;
  MatCreateVecs(system.matrix(), &x, &y);
  VecSet(x, 1);
  std::vector<double> times;
  for (int k = 0; k < 60; ++k) {
    MPI_Barrier(ranks);
    const double start = now();
    MatMult(system.matrix(), x, y);
    times.push_back(most_of(now() - start, ranks));
  }
  VecDestroy(&x);
  VecDestroy(&y);
  std::ranges::sort(times);
  return times[times.size() / 2];
}

Figures measure(MPI_Comm ranks, int layers_of_a_rank, bool by_cells) {
  int rank = 0, count = 1;
  MPI_Comm_rank(ranks, &rank);
  MPI_Comm_size(ranks, &count);
  const Block block{layers_of_a_rank * count};
  const PetscInt unknowns = 3 * block.layers * Block::per_layer;
  System system(ranks);
  const int first = rank * layers_of_a_rank, last = first + layers_of_a_rank;
  LocalRows none;
  none.start.assign(static_cast<std::size_t>(unknowns / count) + 1, 0);
  SystemOutcome outcome = by_cells ? system.set(std::move(none), unknowns, {}, cells_of(block, first, last, cube_matrix()))
                                   : system.set(rows_of(block, first, last, cube_matrix()), unknowns);
  if (outcome.ok()) outcome = system.prepare(SolverOptions("-ksp_type cg -pc_type jacobi"));
  Figures figures;
  figures.unknowns = unknowns, figures.entries = system.nonzeros();
  figures.operations = 2 * (by_cells ? 24.0 * 24 * across * across * block.layers : figures.entries);
  if (!outcome.ok()) return figures;
  std::vector<double> load(static_cast<std::size_t>(unknowns / count)), solution(load.size());
  for (std::size_t i = 0; i < load.size(); ++i) load[i] = std::sin(1.618 * static_cast<double>(i % 1000) * static_cast<double>(i % 1000));
  figures.product = product_seconds(system, ranks);
  MPI_Barrier(ranks);
  const double start = now();
  outcome = system.solve(load.data(), solution.data(), 1);
  figures.solve = most_of(now() - start, ranks);
  figures.iterations = static_cast<double>(system.iterations());
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  figures.memory = most_of(1024 * static_cast<double>(usage.ru_maxrss), ranks);
  return figures;
}

/// All ranks, those that are not measured asleep.
void wait_for_all() {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Ibarrier(PETSC_COMM_WORLD, &request);
  for (int done = 0; done == 0;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void print_figures(const Petsc& petsc, int layers) {
  if (petsc.rank() == 0)
    fmt::print("{:>6} {:>8} {:>10} {:>12} {:>11} {:>9} {:>11} {:>9} {:>11} {:>9} {:>12}\n", "ranks", "by", "unknowns", "product ms",
               "efficiency", "GB/s", "CG s", "CG its", "efficiency", "Gflop/s", "MB per rank");
  Figures one[2];
  for (int count = 1;; count = std::min(2 * count, petsc.ranks())) {
    MPI_Comm some = MPI_COMM_NULL;
    MPI_Comm_split(PETSC_COMM_WORLD, petsc.rank() < count ? 0 : MPI_UNDEFINED, petsc.rank(), &some);
    for (const bool by_cells : {true, false}) {  // the memory is the most so far
      if (some == MPI_COMM_NULL) continue;
      const Figures it = measure(some, layers, by_cells);
      Figures& alone = one[by_cells ? 1 : 0];
      if (count == 1) alone = it;
      const double per_iteration = it.solve / it.iterations, first = alone.solve / alone.iterations;
      if (petsc.rank() == 0)
        fmt::print("{:6} {:>8} {:10.0f} {:12.3f} {:10.0f}% {:9.1f} {:11.3f} {:9.0f} {:10.0f}% {:9.1f} {:12.0f}\n", count,
                   by_cells ? "cells" : "entries", it.unknowns, 1e3 * it.product, 100 * alone.product / it.product,
                   12e-9 * it.entries / it.product, it.solve, it.iterations, 100 * first / per_iteration, 1e-9 * it.operations / it.product,
                   1e-6 * it.memory);
      std::fflush(stdout);
    }
    if (some != MPI_COMM_NULL) MPI_Comm_free(&some);
    wait_for_all();
    if (count == petsc.ranks()) return;
  }
}

}  // namespace
}  // namespace uplift

int main(int count, char** words) {
  const uplift::Petsc petsc;
  const double wanted = count > 1 ? std::atof(words[1]) : 1e5;
  const int layers = std::max(2, static_cast<int>(std::lround(wanted / (3 * uplift::Block::per_layer))));
  uplift::print_figures(petsc, layers);
}
