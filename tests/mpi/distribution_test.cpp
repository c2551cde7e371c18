// Stiffness, damping and mass whose rows the ranks keep, beside those of the same model on one process.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "mpi/mesh_support.h"
#include "unit/case/cut_support.h"
#include "uplift/linear/large.h"
#include "uplift/model/matrix_sum.h"
#include "uplift/model/numbering.h"

namespace uplift {
namespace {

using namespace support;

constexpr const char* petsc = "solver = { type = \"petsc\" }\n";
constexpr const char* by_cells = "solver = { type = \"petsc\", options = \"-ksp_type cg -pc_type jacobi\" }\n";

/// Materials of a raft and of what stands on it.
const std::string building = R"([[solid]]
group = "raft"
E = 3e10
poisson = 0.2
density = 2500
[[solid]]
group = "block"
E = 5e9
poisson = 0.2
density = 1000
)";

/// Rayleigh damping, solids with a damping of their own, an absorbing bottom, sides that are tied to each other, a raft that is rigid, a
/// mast of beams with a mass and a dashpot, on a footing beside the soil.
const std::string tied = R"([mesh.soil_box.soil]
width = 24
size = 1
[[mesh.soil_box.soil.layers]]
thickness = 8
size = 1
[mesh.soil_box.raft]
width = 6
height = 1
size = 1
[mesh.soil_box.block]
width = 4
height = 6
size = 1
[[solid]]
group = "soil_1"
shear_wave_speed = 250
poisson = 0.3
density = 1900
)" + building + R"([[rigid]]
name = "plate"
group = "raft"
[nodes]
foot = [20, 9]
tip = [20, 15]
[[rigid]]
name = "footing"
node = "foot"
mass = 1e4
inertia = 7500
[[beam]]
name = "mast"
nodes = ["foot", "tip"]
E = 2e10
I = 0.02
A = 0.3
density = 2500
elements = 7
[[mass]]
node = "tip"
mass = 2000
[[dashpot]]
nodes = ["tip"]
direction = [1, 0]
damping = 3e4
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
stages = "static"
[[absorbing]]
group = "soil_bottom"
[[tie]]
group = "soil_left"
to = "soil_right"
unknowns = ["ux", "uy"]
[[interface]]
name = "underside"
surface = { group = "interface", lower = ["soil_1"] }
law = { type = "springs", K_n = 2e10, K_t = 1e10, tangential = "coulomb", friction = 0.7 }
[[interface]]
name = "sole"
footing = { body = "foot", width = 3, points = 5 }
law = { type = "springs", K_n = 1e8, K_t = 1e8, tangential = "bonded" }
[gravity]
acceleration = [0, -9.81]
[damping]
rayleigh = [{ frequency = 1, ratio = 0.04 }, { frequency = 8, ratio = 0.04 }]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.01
step = 1e-3
)";

/// A base that the mesh ignores, absorbing sides, no damping but theirs.
std::string cut() {
  return "[mesh]\nfile = \"cut.msh\"\n" + solid("volume", 2e8, 0.3, 1900) + solid("raft", 3e10, 0.2, 2500) +
         "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\", \"uz\"]\nstages = \"static\"\n" +
         "[[absorbing]]\ngroup = \"bottom\"\n[[absorbing]]\ngroup = \"left\"\n[[absorbing]]\ngroup = \"right\"\n"
         "[[interface]]\nname = \"base\"\ncut = { through = [\"volume\"], level = 3.37, upper = \"raft\", x = [-2, 2], y = [-1, 1], height "
         "= "
         "1.5 }\n"
         "law = { type = \"springs\", K_n = 1e9, K_t = 1e9, tangential = \"bonded\" }\n" +
         at_rest_stages;
}

/// The numbers of the serial program for the unknowns of a model.
std::vector<int> serial_numbers(const Model& model) {
  std::vector<int> number = numbers_by_nodes(model);
  if (!number.empty()) return number;
  number.resize(static_cast<std::size_t>(model.free()));
  std::iota(number.begin(), number.end(), 0);
  return number;
}

Vector renumbered(const std::vector<int>& number, Vector vector) {
  renumber(number, vector);
  return vector;
}

/// The matrix of the terms, whole, in the order of the serial program. Its rows are kept as the columns of the serial program, which
/// round-off lets differ from the rows.
Sparse gathered(const std::vector<DistributedTerm>& terms, const std::vector<int>& number) {
  const Index rows = std::ssize(number);
  std::vector<Triplet> entries;
  Vector unit = Vector::Zero(rows), column(rows);
  for (Index j = 0; j < rows; ++j) {
    unit[j] = 1;
    terms.front().matrix->multiply(terms, unit, column);
    unit[j] = 0;
    for (Index i = 0; i < rows; ++i)
      if (column[i] != 0) entries.emplace_back(number[j], number[i], column[i]);
  }
  Sparse whole(rows, rows);
  whole.setFromTriplets(entries.begin(), entries.end());
  return whole;
}

/// Largest difference of two matrices, each entry with the weights 1/sqrt(A_ii) of both its unknowns.
double difference(const Sparse& one, const Sparse& other) {
  const Vector diagonal = other.diagonal();
  const Sparse rest = one - other;
  double most = 0;
  for (int j = 0; j < rest.outerSize(); ++j)
    for (Sparse::InnerIterator entry(rest, j); entry; ++entry)
      if (entry.value() != 0) most = std::max(most, std::abs(entry.value()) / std::sqrt(diagonal[entry.row()] * diagonal[j]));
  return most;
}

const std::string title = "title = \"rows\"\nbonded = false\n";

void compare(const std::string& text, const Mesh& mesh) {
  const Case serial_case = read_on(title + text, mesh), petsc_case = read_on(petsc + title + text, mesh);
  const BuiltCase serial = build(serial_case, runs_of_case(serial_case).front());
  {
    BuiltCase spread = build(petsc_case, runs_of_case(petsc_case).front());
    const Model &one = serial.model, &other = spread.model;
    const Index n = one.free();
    ASSERT_EQ(other.free(), n);
    ASSERT_GT(n, most_undistributed);
    ASSERT_NE(other.distributed, nullptr);
    const std::vector<int> to_serial = serial_numbers(other), to_ranks = inverse(to_serial);
    // bit for bit, and nothing of them is whole
    for (const auto& [matrix, terms] :
         {std::pair(&Model::stiffness, distributed_terms(other, 1, 0, 0)), std::pair(&Model::mass, distributed_terms(other, 0, 0, 1))}) {
      EXPECT_TRUE(Matrix(gathered(terms, to_serial)) == Matrix(one.*matrix)) << difference(gathered(terms, to_serial), one.*matrix);
      EXPECT_TRUE(renumbered(to_serial, diagonal_of(other, matrix)) == Vector((one.*matrix).diagonal()));
      EXPECT_EQ((other.*matrix).nonZeros(), 0);
      const std::vector<double>& entries = terms.front().matrix->entries();
      EXPECT_EQ(std::accumulate(entries.begin(), entries.end(), 0.0), static_cast<double>((one.*matrix).nonZeros()));
      const double share = static_cast<double>((one.*matrix).nonZeros()) / static_cast<double>(entries.size());
      EXPECT_LE(*std::max_element(entries.begin(), entries.end()), 1.3 * share);
    }
    // Rayleigh damping is added in another order
    EXPECT_EQ(other.damping.nonZeros(), 0);
    EXPECT_GT(one.damping.nonZeros(), 0);
    EXPECT_LE(difference(gathered(distributed_terms(other, 0, 1, 0), to_serial), one.damping), 1e-15);
    // a sum with a part that stands on rank 0, as it is multiplied and as it is solved with
    const auto extra = [&](int i, int j) {
      Sparse matrix(n, n);
      matrix.insert(i, i) = 2 * one.stiffness.coeff(3, 3);
      matrix.insert(std::min(i, j), std::max(i, j)) = 0.1 * one.stiffness.coeff(3, 3);
      matrix.insert(j, j) = 3 * one.stiffness.coeff(3, 3);
      return matrix;
    };
    const int last = static_cast<int>(n) - 1;
    OwnedSum sum = matrix_sum(other, 1, 50, 4e6);
    sum.here += extra(to_ranks[3], to_ranks[last]);
    const OwnedSum same = matrix_sum(one, 1, 50, 4e6);
    const Sparse whole = same.here + extra(3, last);
    const Vector x = Vector::LinSpaced(n, -1, 2), product = whole.selfadjointView<upper_triangle>() * x;
    EXPECT_LE((renumbered(to_serial, SymmetricSum(sum).times(renumbered(to_ranks, x))) - product).norm(), 1e-14 * product.norm());
    EXPECT_LE((renumbered(to_serial, SymmetricSum(sum).diagonal()) - whole.diagonal()).norm(), 1e-14 * whole.diagonal().norm());
    const Factorisation made = factorise(*spread.plan.solver, sum);
    ASSERT_NE(made.factor, nullptr) << made.why;
    Matrix found;
    made.factor->solve(renumbered(to_ranks, product), found);
    EXPECT_LE((renumbered(to_serial, found.col(0)) - x).norm(), 1e-9 * x.norm());
    // and back, with the numbers of the serial program
    Vector also = renumbered(to_ranks, x);
    make_whole(spread.model, {&also});
    EXPECT_TRUE(also == x);
    EXPECT_EQ(spread.model.distributed, nullptr);
    EXPECT_EQ(spread.model.kept, one.kept);
    EXPECT_TRUE(Matrix(spread.model.expansion) == Matrix(one.expansion));
    ASSERT_EQ(spread.model.time_loads.size(), one.time_loads.size());
    for (std::size_t k = 0; k < one.time_loads.size(); ++k) EXPECT_TRUE(spread.model.time_loads[k].shape == one.time_loads[k].shape);
    for (std::size_t k = 0; k < one.interfaces.size(); ++k)
      EXPECT_TRUE(Matrix(spread.model.interfaces[k].b) == Matrix(one.interfaces[k].b));
    for (const auto matrix : {&Model::stiffness, &Model::mass, &Model::damping})
      EXPECT_TRUE(Matrix(spread.model.*matrix) == Matrix(one.*matrix));
  }
}

TEST(Distribution, RowsOfTiesRigidBodiesBeamsDashpotsAndAbsorbingFaces) {
  compare(tied, {});
}

TEST(Distribution, RowsOfACutInterfaceInSpace) {
  compare(cut(), box(uniform_lines(-4, 4, 8), uniform_lines(-2, 2, 4), uniform_lines(0, 6, 6)));
}

TEST(Distribution, RowsOfNodesInArbitraryOrder) {
  compare(cut(), shuffled(box(uniform_lines(-4, 4, 8), uniform_lines(-2, 2, 4), uniform_lines(0, 6, 6)), 5));
}

/// Two layers, of cells of two sizes, on a base that is held; a raft and a block on them, of too few cells for a class; a side that rolls.
const std::string layers = R"([mesh.soil_box.soil]
width = 16
length = 12
size = 2
[[mesh.soil_box.soil.layers]]
thickness = 2
size = 1
[[mesh.soil_box.soil.layers]]
thickness = 6
size = 2
[mesh.soil_box.raft]
width = 4
length = 4
height = 1
size = 2
[mesh.soil_box.block]
width = 4
length = 4
height = 4
size = 2
[[solid]]
group = "soil_1"
shear_wave_speed = 250
poisson = 0.3
density = 1900
[[solid]]
group = "soil_2"
shear_wave_speed = 400
poisson = 0.25
density = 2000
mass = "lumped"
damping_beta = 1e-3
)" + building + R"([[support]]
group = "soil_bottom"
fixed = ["ux", "uy", "uz"]
[[support]]
group = "soil_left"
fixed = ["ux"]
[[interface]]
name = "underside"
surface = { group = "interface", lower = ["soil_1"] }
law = { type = "springs", K_n = 2e10, K_t = 1e10, tangential = "bonded" }
[damping]
rayleigh = [{ frequency = 1, ratio = 0.04 }, { frequency = 8, ratio = 0.04 }]
[[stage]]
type = "dynamic"
duration = 0.01
step = 1e-3
)";

/// The model of which equal cells have no entries on the ranks, beside the serial one, with vectors of all signs: products, diagonals and
/// what is solved with them. `share`: at most that part of the entries is left.
void compare_by_cells(const std::string& text, const Mesh& mesh, double share) {
  const Case serial_case = read_on(title + text, mesh), petsc_case = read_on(by_cells + title + text, mesh);
  const BuiltCase serial = build(serial_case, runs_of_case(serial_case).front());
  BuiltCase spread = build(petsc_case, runs_of_case(petsc_case).front());
  const Model &one = serial.model, &other = spread.model;
  const Index n = one.free();
  ASSERT_EQ(other.free(), n);
  ASSERT_NE(other.distributed, nullptr);
  ASSERT_NE(other.distributed->cells, nullptr);
  const std::vector<int> to_serial = serial_numbers(other), to_ranks = inverse(to_serial);
  struct Of {
    double k, c, m;
  };
  for (const auto& [k, c, m] : {Of{1, 0, 0}, Of{0, 1, 0}, Of{0, 0, 1}, Of{1, 50, 4e6}}) {
    const Sparse whole = k * one.stiffness + c * one.damping + m * one.mass;
    const std::vector<DistributedTerm> terms = distributed_terms(other, k, c, m);
    Vector diagonal = Vector::Zero(n), size(n), x(n), product(n);
    for (const DistributedTerm& term : terms) diagonal += term.factor * renumbered(to_serial, term.matrix->diagonal());
    EXPECT_LE((diagonal - whole.diagonal()).cwiseAbs().maxCoeff(), 1e-13 * whole.diagonal().maxCoeff());
    for (Index i = 0; i < n; ++i) size[i] = 1 / std::sqrt(std::max(diagonal[i], 1e-30));  // no unit is larger than another
    for (int trial = 1; trial <= 3; ++trial) {
      for (Index i = 0; i < n; ++i) x[i] = size[i] * std::sin(1.618 * trial * static_cast<double>(i + 1) * static_cast<double>(i + 1));
      terms.front().matrix->multiply(terms, renumbered(to_ranks, x), product);
      renumber(to_serial, product);
      EXPECT_LE((product - whole * x).cwiseProduct(size).cwiseAbs().maxCoeff(), 1e-13) << k << " " << c << " " << m;
    }
  }
  const auto entries = [&](const DistributedMatrix& matrix) {
    return std::accumulate(matrix.entries().begin(), matrix.entries().end(), 0.0);
  };
  EXPECT_LE(entries(*other.distributed->stiffness), share * static_cast<double>(one.stiffness.nonZeros()));
  EXPECT_LE(entries(*other.distributed->mass), share * static_cast<double>(one.mass.nonZeros()));
  const OwnedSum sum = matrix_sum(other, 1, 50, 4e6);
  const Sparse whole = one.stiffness + 50 * one.damping + 4e6 * one.mass;
  const Factorisation made = factorise(*spread.plan.solver, sum);
  ASSERT_NE(made.factor, nullptr) << made.why;
  const Vector x = Vector::LinSpaced(n, -1, 2), load = whole * x;
  Matrix found;
  made.factor->solve(renumbered(to_ranks, load), found);
  EXPECT_LE((renumbered(to_serial, found.col(0)) - x).norm(), 1e-9 * x.norm());
}

TEST(Distribution, EqualCellsAsTheirSum) {
  compare_by_cells(layers, {}, 0.5);
}

TEST(Distribution, EqualCellsAmongTiesRigidBodiesBeamsAndDashpots) {
  compare_by_cells(tied, {}, 0.5);
}

TEST(Distribution, EqualCellsOfNodesInArbitraryOrder) {
  compare_by_cells(cut(), shuffled(box(uniform_lines(-4, 4, 8), uniform_lines(-2, 2, 4), uniform_lines(0, 6, 6)), 5), 0.9);
}

TEST(Distribution, EqualCellsBesideCutOnes) {
  compare_by_cells(cut(), box(uniform_lines(-4, 4, 8), uniform_lines(-2, 2, 4), uniform_lines(0, 6, 6)), 0.9);
}

TEST(Distribution, TunedMassIsThatOfTheWholeMatrices) {
  std::string text = "title = \"mast\"\nbonded = false\n" + tied;
  const std::string mass = "mass = 2000\n";
  text.replace(text.find(mass), mass.size(), "tuned_frequency = 2\n");
  const Case serial_case = read_on(text, {}), petsc_case = read_on(petsc + text, {});
  const double one = build(serial_case, runs_of_case(serial_case).front()).tuned_mass;
  EXPECT_GT(one, 0);
  EXPECT_NEAR(build(petsc_case, runs_of_case(petsc_case).front()).tuned_mass, one, 1e-12 * one);
}

TEST(Distribution, RunIsThatOfTheWholeMatrices) {
  const Case serial_case = read_on(title + tied, {}), petsc_case = read_on(petsc + title + tied, {});
  BuiltCase serial = build(serial_case, runs_of_case(serial_case).front()), spread = build(petsc_case, runs_of_case(petsc_case).front());
  const RunResult one = run(serial.model, serial.plan, serial.behaviours), other = run(spread.model, spread.plan, spread.behaviours);
  ASSERT_EQ(to_string(one.status), "completed") << one.reason;
  ASSERT_EQ(to_string(other.status), "completed") << other.reason;
  EXPECT_NEAR(other.final_energy.strain, one.final_energy.strain, 1e-9 * one.final_energy.strain);
  EXPECT_NEAR(other.max_opening.value, one.max_opening.value, 1e-9 * std::abs(one.max_opening.value) + 1e-15);
}

}  // namespace
}  // namespace uplift
