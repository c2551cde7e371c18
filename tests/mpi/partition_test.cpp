// Which unknowns the ranks have: on a mesh whose nodes have arbitrary numbers, as those of mesh generators, the parts are those of a
// partition.
#include "uplift/distributed/partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <tuple>

#include "mpi/mesh_support.h"
#include "unit/case/cut_support.h"
#include "uplift/distributed/ranks.h"
#include "uplift/model/matrix_sum.h"
#include "uplift/model/numbering.h"
#include "uplift/run/run.h"
#include "uplift/run/run_state.h"

namespace uplift {
namespace {

using namespace support;

/// A grid of n x n x n vertices of `unknowns` each, with the eight corners of every cell as a set. `number`: of each vertex.
PartitionGraph cube(int n, const std::vector<int>& number, int unknowns) {
  std::vector<PetscInt> member;
  std::vector<std::size_t> start{0};
  for (int z = 0; z + 1 < n; ++z)
    for (int y = 0; y + 1 < n; ++y)
      for (int x = 0; x + 1 < n; ++x) {
        for (int corner = 0; corner < 8; ++corner)
          member.push_back(number[static_cast<std::size_t>(((z + (corner >> 2)) * n + y + (corner >> 1 & 1)) * n + x + (corner & 1))]);
        start.push_back(member.size());
      }
  return {std::vector<PetscInt>(number.size(), unknowns), std::move(start), std::move(member)};
}

TEST(Partition, HaloOfACubeWithArbitraryNumbersIsThatOfPlanes) {
  constexpr int n = 16;
  std::vector<int> number(n * n * n);
  std::iota(number.begin(), number.end(), 0);
  // in halves, by planes x-y of the natural numbers: both have the plane of the other one
  const PartitionGraph natural = cube(n, number, 3);
  EXPECT_EQ(natural.halo(natural.ranges(2)), 2 * 3 * n * n);
  std::ranges::shuffle(number, std::mt19937(7));
  const PartitionGraph arbitrary = cube(n, number, 3);
  EXPECT_GT(arbitrary.halo(arbitrary.ranges(2)), 0.95 * 3 * n * n * n);  // nearly all are coupled with the other half
  for (const int parts : {2, 4, 8}) {
    const std::vector<PetscInt> part = arbitrary.divide(parts);
    EXPECT_EQ(part, arbitrary.divide(parts)) << "the same graph has the same partition";
    EXPECT_LE(arbitrary.imbalance(part, parts), 1.05);
    // halves, quarters and eighths by planes: 2, 4 and 6 planes of vertices, and the edges and corners where more than two parts meet
    EXPECT_LE(arbitrary.halo(part), 1.35 * 3 * n * n * 2 * std::log2(parts)) << parts;
  }
  EXPECT_LE(natural.halo(natural.divide(4)), natural.halo(natural.ranges(4)));
}

TEST(Partition, RangesShareTheUnknownsOfHeavyVertices) {
  const PartitionGraph chain({1, 1, 1, 1, 4, 1, 1, 1, 1}, {0}, {});
  EXPECT_EQ(chain.ranges(3), (std::vector<PetscInt>{0, 0, 0, 0, 1, 2, 2, 2, 2}));
  EXPECT_DOUBLE_EQ(chain.imbalance(chain.ranges(3), 3), 1);
}

const std::string on_soil = "title = \"block\"\nbonded = false\n[mesh]\nfile = \"block.msh\"\n" + solid("soil", 2e8, 0.3, 1900) +
                            solid("block", 3e10, 0.2, 2500) + solid("plate", 3e10, 0.2, 2500) + R"([[support]]
group = "bottom"
fixed = ["ux", "uy", "uz"]
[[rigid]]
name = "plate"
group = "plate"
[[tie]]
group = "left"
to = "right"
unknowns = ["ux"]
[[interface]]
name = "base"
surface = { group = "interface", lower = ["soil"] }
law = { type = "springs", K_n = 1e9, K_t = 1e9, tangential = "coulomb", friction = 0.7 }
[gravity]
acceleration = [0, 0, -9.81]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.1 }
[[ground_acceleration]]
name = "earthquake"
direction = [0.48, 0.36, -0.8]
amplitude = 60
function = "pulse"
[damping]
rayleigh = [{ frequency = 1, ratio = 0.04 }, { frequency = 8, ratio = 0.04 }]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.03
step = 5e-3
)";

/// Tetrahedra with nodes in arbitrary order: soil, a block on it with a joint between, a plate on the soil.
Mesh tetrahedra() {
  constexpr int across = 10, deep = 7;
  const auto part = [](int i, int j, int k) {
    const auto within = [](int at, int first, int end) { return at >= first && at < end; };
    if (k < deep) return 0;
    if (within(i, 4, 6) && within(j, 4, 6)) return 1;
    return k == deep && within(i, 1, 3) && within(j, 1, 3) ? 2 : -1;
  };
  const auto face = [](int of, Direction direction, int other) -> std::string {
    if (of == 0 && other == 1) return "interface";
    return of == 0 && other == -1 ? std::string(name_of(direction)) : "";
  };
  const Grid lines{uniform_lines(0, across, across), uniform_lines(0, across, across), uniform_lines(0, deep + 3, deep + 3)};
  return shuffled(with_cells(grid(lines, part, {"soil", "block", "plate"}, face), Cell::tet4), 11);
}

/// The process of each free unknown.
std::vector<int> process_of(const Model& model) {
  const std::vector<int>& firsts = model.distributed->stiffness->firsts();
  std::vector<int> process;
  for (int free = 0; free < model.free(); ++free)
    process.push_back(static_cast<int>(std::ranges::upper_bound(firsts, free) - firsts.begin()) - 1);
  return process;
}

/// Rows of other processes that each process is coupled with, all together.
std::size_t halo(const Sparse& matrix, const std::vector<int>& process) {
  std::set<std::pair<int, Index>> found;
  for (Index j = 0; j < matrix.cols(); ++j)
    for (Sparse::InnerIterator entry(matrix, j); entry; ++entry)
      if (const int other = process[static_cast<std::size_t>(entry.row())]; other != process[static_cast<std::size_t>(j)])
        found.emplace(other, j);
  return found.size();
}

TEST(Partition, PartsOfAnUnstructuredModel) {
  const Case serial_case = read_on(on_soil, tetrahedra());
  const Case petsc_case = read_on("solver = { type = \"petsc\" }\n" + on_soil, tetrahedra());
  const BuiltCase serial = build(serial_case, runs_of_case(serial_case).front());
  const BuiltCase spread = build(petsc_case, runs_of_case(petsc_case).front());
  const Model &one = serial.model, &other = spread.model;
  ASSERT_NE(other.distributed, nullptr);
  ASSERT_EQ(other.free(), one.free());
  const int processes = Ranks::all().count();
  const std::vector<int>& firsts = other.distributed->stiffness->firsts();
  ASSERT_EQ(std::ssize(firsts), processes + 1);
  EXPECT_EQ(firsts.back(), other.free());
  for (int process = 0; process < processes; ++process)
    EXPECT_LE(processes * (firsts[process + 1] - firsts[process]), 1.06 * other.free()) << process;
  const std::vector<int> process = process_of(other);
  // within a part the order is that before
  for (int free = 1; free < other.free(); ++free)
    EXPECT_TRUE(process[free] > process[free - 1] || other.kept[free - 1] < other.kept[free]) << free;
  // in one part: the unknowns of a node, of the joint, of the sides of a tie
  std::map<int, std::set<int>> of_nodes;
  for (int free = 0; free < other.free(); ++free) of_nodes[other.space.node_of(other.kept[free])].insert(process[free]);
  for (int full = 0; full < other.full_unknowns(); ++full)
    for (Sparse::InnerIterator entry(other.expansion, full); entry; ++entry)
      of_nodes[other.space.node_of(full)].insert(process[static_cast<std::size_t>(entry.row())]);
  for (const auto& [node, processes_of_node] : of_nodes) EXPECT_EQ(processes_of_node.size(), 1U) << node;
  ASSERT_EQ(other.interfaces.size(), 1U);
  std::set<int> of_joint;
  for (Index j = 0; j < other.interfaces[0].b.cols(); ++j)
    if (Sparse::InnerIterator(other.interfaces[0].b, j)) of_joint.insert(process[static_cast<std::size_t>(j)]);
  EXPECT_EQ(of_joint.size(), 1U);
  if (processes == 1) return;
  // beside equal ranges of the numbers of the mesh
  std::vector<int> by_number, by_part(static_cast<std::size_t>(one.free()));
  for (int free = 0; free < one.free(); ++free) by_number.push_back(static_cast<int>(std::int64_t{free} * processes / one.free()));
  const std::vector<int> to_serial = numbers_by_nodes(other);
  for (int free = 0; free < other.free(); ++free) by_part[static_cast<std::size_t>(to_serial[free])] = process[free];
  const double before = static_cast<double>(halo(one.stiffness, by_number)), now = static_cast<double>(halo(one.stiffness, by_part));
  RecordProperty("halo_by_number", std::to_string(before));
  RecordProperty("halo_by_part", std::to_string(now));
  fmt::print("{} ranks: halo of {:.0f} rows in place of {:.0f}, of {} unknowns\n", processes, now, before, one.free());
  EXPECT_LE(4 * now, before);
}

TEST(Partition, RunOnAnUnstructuredMeshIsThatOfOneProcess) {
  const Case serial_case = read_on(on_soil, tetrahedra());
  BuiltCase serial = build(serial_case, runs_of_case(serial_case).front());
  const RunResult one = run(serial.model, serial.plan, serial.behaviours);
  ASSERT_EQ(to_string(one.status), "completed") << one.reason;
  EXPECT_GT(one.max_opening.value, 1e-5);
  for (const std::string options : {"", "-ksp_type cg -pc_type jacobi"}) {
    const Case petsc_case = read_on("solver = { type = \"petsc\", options = \"" + options + "\" }\n" + on_soil, tetrahedra());
    BuiltCase spread = build(petsc_case, runs_of_case(petsc_case).front());
    const RunResult other = run(spread.model, spread.plan, spread.behaviours);
    ASSERT_EQ(to_string(other.status), "completed") << other.reason;
    EXPECT_NEAR(other.max_opening.value, one.max_opening.value, 1e-8 * one.max_opening.value);
    EXPECT_NEAR(other.final_energy.strain, one.final_energy.strain, 1e-8 * one.final_energy.strain);
    EXPECT_NEAR(other.final_energy.kinetic, one.final_energy.kinetic, 1e-8 * one.energy_scale);
  }
}

/// What another number of ranks goes on from: the states that a run hands out are in the order of the nodes.
TEST(Partition, StatesAreHandedOutInTheOrderOfTheNodes) {
  const Case serial_case = read_on(on_soil, tetrahedra());
  const Case petsc_case = read_on("solver = { type = \"petsc\" }\n" + on_soil, tetrahedra());
  BuiltCase serial = build(serial_case, runs_of_case(serial_case).front()), spread = build(petsc_case, runs_of_case(petsc_case).front());
  std::vector<RunState> of_serial, of_spread;
  const auto keeping = [](std::vector<RunState>& states) {
    Keeping keeps;
    keeps.keep = [&states](const RunState& state) { states.push_back(state); };
    keeps.every = 5;
    return keeps;
  };
  const Keeping one = keeping(of_serial), other = keeping(of_spread);
  run(serial.model, serial.plan, serial.behaviours, {}, {}, &one);
  const RunResult whole = run(spread.model, spread.plan, spread.behaviours, {}, {}, &other);
  ASSERT_EQ(of_serial.size(), 1U);
  ASSERT_EQ(of_spread.size(), 1U);
  const Vector &expected = of_serial[0].march.state.displacement, &found = of_spread[0].march.state.displacement;
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-8 * expected.cwiseAbs().maxCoeff());
  // and it goes on from the state of the serial run
  Keeping from;
  from.every = 5;
  from.from = &of_serial[0];
  const RunResult rest = run(spread.model, spread.plan, spread.behaviours, {}, {}, &from);
  ASSERT_EQ(to_string(rest.status), "completed") << rest.reason;
  EXPECT_NEAR(rest.final_energy.strain, whole.final_energy.strain, 1e-8 * whole.final_energy.strain);
  EXPECT_NEAR(rest.max_opening.value, whole.max_opening.value, 1e-8 * whole.max_opening.value);
}

}  // namespace
}  // namespace uplift
