#include "uplift/mesh/cut.h"

#include <benchmark/benchmark.h>

#include "uplift/mesh/box.h"

// A plane through a million cells: where few of them are cut, as under a raft, and where all are.
namespace {

using namespace uplift;

void cut_cells(benchmark::State& state, const Mesh& mesh, Vec3 normal, double level) {
  normal.normalize();
  std::size_t faces = 0;
  for (auto _ : state) {
    state.PauseTiming();
    Mesh whole = mesh;
    state.ResumeTiming();
    faces = cut(whole, {{{"volume"}, {normal, level}, {{{}, "above"}}}}, {{}}).front().size();
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
BENCHMARK(plane_level)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(space_level)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(space_inclined)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(space_every_cell)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
