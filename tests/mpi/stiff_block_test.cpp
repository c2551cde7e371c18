#include "uplift/distributed/stiff_block.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "unit/case/cut_support.h"
#include "uplift/distributed/ranks.h"
#include "uplift/linear/large.h"
#include "uplift/model/matrix_sum.h"

namespace uplift {
namespace {

using namespace support;

TEST(StiffBlock, IsMadeOfTheUnknownsThatAreStifferThanTheRest) {
  constexpr int n = 20000;
  Vector scale = Vector::Constant(n, 1e-3), mass = Vector::Constant(n, 2e5);  // shares of 0.2
  EXPECT_TRUE(stiff_unknowns(scale, mass).empty());
  for (int i = 0; i < n; ++i) mass[i] *= 1 + 0.5 * std::sin(i);  // a soil that varies by a factor of three
  EXPECT_TRUE(stiff_unknowns(scale, mass).empty());
  std::vector<int> building;
  for (int i = 5; i < 8000; i += 8) building.push_back(i), mass[i] *= 0.01;
  mass[21] = 0;  // one of them without mass
  EXPECT_EQ(stiff_unknowns(scale, mass), building);
  mass[4] *= 0.9;  // of the soil
  EXPECT_EQ(stiff_unknowns(scale, mass), building);
  // of two soils none can be factorised
  for (int i = 0; i < n; ++i) mass[i] = i % 3 == 0 ? 2e5 : 2e3;
  EXPECT_TRUE(stiff_unknowns(scale, mass).empty());
  EXPECT_TRUE(stiff_unknowns(Vector::Ones(1), Vector::Ones(1)).empty());
}

/// Rows of a chain of springs to ground between neighbours, `stiff` times as stiff from unknown 10 to 20, with a unit diagonal.
Sparse chain(int rows, double stiff) {
  Matrix a = Matrix::Identity(rows, rows);
  for (int i = 0; i + 1 < rows; ++i) {
    const double k = i >= 10 && i < 20 ? stiff : 1;
    a(i, i) += k, a(i + 1, i + 1) += k;
    a(i, i + 1) -= k, a(i + 1, i) -= k;
  }
  const Vector scale = a.diagonal().cwiseSqrt().cwiseInverse();
  return Sparse((scale.asDiagonal() * a * scale.asDiagonal()).sparseView());
}

/// M^-1 x of the preconditioner of a system on one process.
Vector precondition(const System& system, const Vector& x) {
  Vector result(x.size());
  PC pc = nullptr;
  Vec given = nullptr, answer = nullptr;
  KSPGetPC(system.solver(), &pc);
  VecCreateSeqWithArray(PETSC_COMM_SELF, 1, static_cast<PetscInt>(x.size()), x.data(), &given);
  VecCreateSeqWithArray(PETSC_COMM_SELF, 1, static_cast<PetscInt>(x.size()), result.data(), &answer);
  EXPECT_EQ(PCApply(pc, given, answer), 0);
  VecDestroy(&given);
  VecDestroy(&answer);
  return result;
}

LocalRows rows_of(const Sparse& a) {
  LocalRows rows;
  rows.start.assign(a.outerIndexPtr(), a.outerIndexPtr() + a.cols() + 1);
  rows.column.assign(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros());
  rows.value.assign(a.valuePtr(), a.valuePtr() + a.nonZeros());
  return rows;
}

/// One process, so that its answers can be looked at: the others take no part.
TEST(StiffBlock, PreconditionerIsSymmetricAndTheInverseOfItsBlock) {
  constexpr int n = 40;
  const Sparse a = chain(n, 1e4);
  const std::vector<PetscInt> stiff{10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20};
  System system(PETSC_COMM_SELF);
  ASSERT_EQ(system.set(rows_of(a), n).why, "");
  system.set_stiff(stiff);
  ASSERT_EQ(system.prepare(SolverOptions("-ksp_type cg -pc_type jacobi")).why, "");
  EXPECT_NE(system.remark().find("11 unknowns"), std::string::npos) << system.remark();
  Matrix m(n, n);
  for (int j = 0; j < n; ++j) m.col(j) = precondition(system, Vector::Unit(n, j));
  EXPECT_LE((m - m.transpose()).norm(), 1e-13 * m.norm());
  Matrix block(11, 11), inverse(11, 11);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const bool of_block = i >= 10 && i <= 20 && j >= 10 && j <= 20;
      if (of_block)
        block(i - 10, j - 10) = a.coeff(i, j), inverse(i - 10, j - 10) = m(i, j);
      else
        EXPECT_EQ(m(i, j), i == j ? 1 : 0) << i << " " << j;
    }
  EXPECT_LE((block * inverse - Matrix::Identity(11, 11)).norm(), 1e-10);
  for (int trial = 1; trial <= 5; ++trial) {
    Vector x(n), y(n);
    for (int i = 0; i < n; ++i) x[i] = std::sin(1.618 * trial * (i + 1) * (i + 1)), y[i] = std::cos(2.3 * trial * (i + 1));
    EXPECT_NEAR(x.dot(precondition(system, y)), y.dot(precondition(system, x)), 1e-12 * m.norm());
    EXPECT_GT(x.dot(precondition(system, x)), 0);
  }
}

/// Then the iterations tell why the matrix is none.
TEST(StiffBlock, WithoutAFactorTheDiagonalStays) {
  constexpr int n = 40;
  Sparse a = chain(n, 1e4);
  a.coeffRef(12, 13) = a.coeffRef(13, 12) = -1.5;  // stiffer than both ends together
  System system(PETSC_COMM_SELF);
  ASSERT_EQ(system.set(rows_of(a), n).why, "");
  system.set_stiff({12, 13});
  EXPECT_NE(system.prepare(SolverOptions("-ksp_type cg -pc_type jacobi")).why.find("INDEFINITE"), std::string::npos);
  EXPECT_NE(system.remark().find("2 unknowns of stiff parts are not factorised"), std::string::npos) << system.remark();
  EXPECT_LE((precondition(system, Vector::Unit(n, 12)) - Vector::Unit(n, 12)).norm(), 1e-15);
}

/// A building of bricks on soil, or a mast of beams on a rigid raft, and a step of 5 ms.
std::string building(const std::string& solver, const std::string& young, bool of_bricks) {
  const std::string
      block = of_bricks ? "[mesh.soil_box.block]\nwidth = 4\nlength = 4\nheight = 12\nsize = 2\n" : "",
      solid = of_bricks ? "[[solid]]\ngroup = \"block\"\nE = " + young + "\npoisson = 0.2\ndensity = 1500\n" : "",
      mast = of_bricks ? ""
                       : "[nodes]\nfoot = [0, 0, 2]\ntip = [0, 0, 32]\n[[rigid]]\nname = \"plate\"\nnode = \"foot\"\ngroup = \"raft\"\n"
                         "[[beam]]\nname = \"mast\"\nnodes = [\"foot\", \"tip\"]\nE = " +
                             young + "\nI_y = 20\nI_z = 20\nJ = 30\nA = 8\nup = [1, 0, 0]\ndensity = 2500\nelements = 15\n";
  return fmt::format("solver = {{ type = \"petsc\"{} }}\n", solver) + R"(title = "building"
bonded = false
[mesh.soil_box.soil]
width = 32
length = 28
size = 2
[[mesh.soil_box.soil.layers]]
thickness = 14
size = 2
[mesh.soil_box.raft]
width = 8
length = 8
height = 2
size = 2
)" + block +
         R"([[solid]]
group = "soil_1"
shear_wave_speed = 250
poisson = 0.3
density = 1900
[[solid]]
group = "raft"
poisson = 0.2
density = 2500
E = )" + young +
         "\n" + solid + mast + R"([[support]]
group = "soil_bottom"
fixed = ["ux", "uy", "uz"]
[[interface]]
name = "underside"
surface = { group = "interface", lower = ["soil_1"] }
law = { type = "springs", K_n = 2e10, K_t = 1e10, tangential = "bonded" }
[damping]
rayleigh = [{ frequency = 1, ratio = 0.04 }, { frequency = 8, ratio = 0.04 }]
[[stage]]
type = "dynamic"
duration = 0.01
step = "5 ms"
)";
}

struct Solved {
  std::string remark;
  long iterations = 0;
  Matrix x;
};

/// K + 2/dt C + 4/dt^2 M with a load on all unknowns, of the size sqrt(A_ii).
Solved solve(const std::string& text, double step = 5e-3) {
  const Case read = read_on(text, {});
  BuiltCase built = build(read, runs_of_case(read).front());
  const OwnedSum sum = matrix_sum(built.model, 1, 2 / step, 4 / (step * step));
  const Factorisation made = factorise(*built.plan.solver, sum);
  EXPECT_NE(made.factor, nullptr) << made.why;
  if (made.factor == nullptr) return {};
  Matrix load = SymmetricSum(sum).diagonal().cwiseSqrt();
  for (Index i = 0; i < load.rows(); ++i) load(i, 0) *= std::sin(1.618 * static_cast<double>(i + 1) * static_cast<double>(i + 1));
  Solved solved{made.remark, Ranks::all().iterations(), {}};
  made.factor->solve(load, solved.x);
  solved.iterations = Ranks::all().iterations() - solved.iterations;
  return solved;
}

const std::string cg = ", options = \"-ksp_type cg -pc_type jacobi\"", diagonal = ", stiff_block = false",
                  with_entries = ", static_options = \"-pc_type gamg\"";

double difference(const Matrix& one, const Matrix& other) {
  return (one - other).norm() / other.norm();
}

/// Their numbers are printed: tests/mpi/test_mpi.py compares them between numbers of ranks.
TEST(StiffBlock, ABuildingDoesNotMakeItsSoilMoreIterations) {
  for (const bool of_bricks : {true, false}) {
    const char* what = of_bricks ? "bricks" : "beams";
    const Solved block = solve(building(cg, "3e10", of_bricks)), without = solve(building(cg + diagonal, "3e10", of_bricks)),
                 entries = solve(building(cg + with_entries, "3e10", of_bricks)), direct = solve(building("", "3e10", of_bricks));
    std::printf("stiff block, %s: %ld iterations, without %ld: %s\n", what, block.iterations, without.iterations, block.remark.c_str());
    EXPECT_LE(3 * block.iterations, without.iterations);
    EXPECT_NE(block.remark.find("unknowns of stiff parts are factorised"), std::string::npos) << block.remark;
    EXPECT_EQ(without.remark, "");
    EXPECT_EQ(direct.remark, "");
    EXPECT_NEAR(static_cast<double>(entries.iterations), static_cast<double>(block.iterations), 2);  // the same block, of entries alone
    EXPECT_LE(difference(block.x, direct.x), 1e-9);
    EXPECT_LE(difference(without.x, direct.x), 1e-9);
    EXPECT_LE(difference(entries.x, direct.x), 1e-9);
  }
}

TEST(StiffBlock, StepsOfAnyLengthHaveTheirOwn) {
  for (const double step : {2.5e-3, 1e-2}) {
    const Solved block = solve(building(cg, "3e10", true), step), without = solve(building(cg + diagonal, "3e10", true), step);
    std::printf("stiff block, step of %g s: %ld iterations, without %ld\n", step, block.iterations, without.iterations);
    EXPECT_LE(2 * block.iterations, without.iterations);
    EXPECT_LE(difference(block.x, without.x), 1e-9);
  }
}

TEST(StiffBlock, SoilAloneIsSolvedWithTheDiagonalToTheLastBit) {
  const Solved given = solve(building(cg, "3e8", true)), without = solve(building(cg + diagonal, "3e8", true));
  EXPECT_EQ(given.remark, "");
  EXPECT_EQ(given.iterations, without.iterations);
  EXPECT_TRUE(given.x == without.x);
}

}  // namespace
}  // namespace uplift
