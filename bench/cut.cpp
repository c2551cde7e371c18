#include "uplift/mesh/cut.h"

#include <benchmark/benchmark.h>

#include <random>

#include "tests/simple_meshes.h"

// A plane through a million cells: where few of them are cut, as under a raft, and where all are, also where it divides all of them into
// simplices, or their faces are warped.
namespace {

using namespace uplift;

void cut_cells(benchmark::State& state, const Mesh& mesh, Vec3 normal, double level) {
  normal.normalize();
  std::size_t faces = 0;
  for (auto _ : state) {
    state.PauseTiming();
    Mesh whole = mesh;
    state.ResumeTiming();
    std::vector<std::vector<CutFace>> made = cut(whole, {{{"volume"}, {normal, level}, {{{}, "above"}}}}, {{}});
    state.PauseTiming();  // the end of the meshes is no part of it
    faces = made.front().size();
    made = {}, whole = {};
    state.ResumeTiming();
  }
  state.counters["cells"] = mesh.cells();
  state.counters["faces"] = static_cast<double>(faces);
}

std::vector<double> lines(int cells) {
  return uniform_lines(0, cells, cells);
}

void plane_level(benchmark::State& state) {
  cut_cells(state, rectangle(lines(1000), lines(1000)), {0, 1, 0}, 500.3);
}
void space_level(benchmark::State& state) {
  cut_cells(state, box(lines(100), lines(100), lines(100)), {0, 0, 1}, 50.3);
}
void space_inclined(benchmark::State& state) {
  cut_cells(state, box(lines(100), lines(100), lines(100)), {0.2, 0.1, 1}, 60.3);
}
void space_every_cell(benchmark::State& state) {
  cut_cells(state, box(lines(1000), lines(1000), lines(1)), {0, 0, 1}, 0.3);
}
void plane_every_cell(benchmark::State& state) {
  cut_cells(state, rectangle(lines(1000000), lines(1)), {0, 1, 0}, 0.3);
}
/// Through all rows, from the bottom to the top.
void plane_rows(benchmark::State& state) {
  cut_cells(state, rectangle(lines(1000), lines(1000)), {1, 0.3, 0}, 600.3);
}
void plane_rows_of_triangles(benchmark::State& state) {
  cut_cells(state, rectangle(lines(1000), lines(500), Cell::tri3), {1, 0.3, 0}, 600.3);
}
void space_tetrahedra(benchmark::State& state) {
  cut_cells(state, box(lines(55), lines(55), lines(55), Cell::tet4), {0.2, 0.1, 1}, 33.3);
}
void tetrahedra_every_cell(benchmark::State& state) {
  cut_cells(state, box(lines(409), lines(409), lines(1), Cell::tet4), {0, 0, 1}, 0.4);
}
void space_every_cell_inclined(benchmark::State& state) {
  cut_cells(state, box(lines(1000), lines(1000), lines(1)), {0.0003, 0.0002, 1}, 0.65);
}
void space_every_cell_warped(benchmark::State& state) {
  Mesh mesh = box(lines(1000), lines(1000), lines(1));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> move(-0.1, 0.1);
  for (Vec3& x : mesh.nodes)
    for (int k = 0; k < 3; ++k) x[k] += move(random);
  cut_cells(state, mesh, {0, 0, 1}, 0.4);
}
BENCHMARK(plane_level)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(plane_rows)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(plane_rows_of_triangles)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(space_level)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(space_inclined)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(space_tetrahedra)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(plane_every_cell)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(space_every_cell)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(tetrahedra_every_cell)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(space_every_cell_inclined)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(space_every_cell_warped)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
