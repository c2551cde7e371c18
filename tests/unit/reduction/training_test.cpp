// What a basis answers, in the frequency domain: with the harmonic answers of the whole structure, which no march makes.
#include "uplift/reduction/training.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <complex>
#include <numbers>

#include "uplift/dynamics/bulk.h"
#include "uplift/reduction/projection.h"
#include "uplift/session/steps.h"

namespace uplift::training_test {
namespace {

using ComplexMatrix = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic>;

/// A block of 10 x 10 x 5 m on 25 points with friction, on shallow soil.
constexpr const char* block = R"(
title = "block"
bonded = false
[mesh.soil_box.soil]
width = 15
length = 15
size = 2.5
[[mesh.soil_box.soil.layers]]
thickness = 2.5
size = 2.5
[mesh.soil_box.block]
width = 10
height = 5
size = 2.5
[[solid]]
group = "soil_1"
E = "200 MPa"
poisson = 0.3
density = 2000
[[solid]]
group = "block"
E = "20 GPa"
poisson = 0.2
density = 2500
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy", "uz"]
[[interface]]
name = "underside"
surface = { group = "interface", lower = ["soil_1"] }
law = { type = "springs", K_n = 2e10, K_t = 1e10, tangential = "coulomb", friction = 0.7 }
[gravity]
acceleration = [0, 0, -9.81]
[[function]]
name = "shake"
shape = { type = "ricker", frequency = 3 }
[[ground_acceleration]]
direction = [1, 0, 0]
function = "shake"
[damping]
rayleigh = [{ frequency = 2, ratio = 0.07 }, { frequency = 10, ratio = 0.07 }]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = 2e-3
)";

struct Structure {
  Matrix stiffness, damping, mass, rows, floors;
  /// Displacements of the floors and openings for harmonic forces of size 1 at the rows.
  ComplexMatrix answers(double w) const {
    const std::complex<double> i(0, 1);
    const ComplexMatrix dynamic = stiffness.cast<std::complex<double>>() + i * w * damping - w * w * mass;
    const ComplexMatrix u = dynamic.partialPivLu().solve(rows.transpose().cast<std::complex<double>>().eval());
    ComplexMatrix all(floors.rows() + rows.rows(), rows.rows());
    all << floors * u, rows * u;
    return all;
  }
  Structure in(const Matrix& v) const {
    return {v.transpose() * stiffness * v, v.transpose() * damping * v, v.transpose() * mass * v, rows * v, floors * v};
  }
};

struct Errors {
  double floors = 0, openings = 0;
};

/// Largest errors over frequencies up to 29 Hz: 2-norms over all rows that are loaded and all answers, shares of the whole structure's.
Errors errors(const Structure& whole, const Matrix& basis) {
  const Structure reduced = whole.in(basis);
  Errors most;
  for (const double frequency : {3.0, 9.0, 17.0, 29.0}) {
    const ComplexMatrix full = whole.answers(2 * std::numbers::pi * frequency), part = reduced.answers(2 * std::numbers::pi * frequency);
    const Index floors = whole.floors.rows(), rows = whole.rows.rows();
    most.floors = std::max(most.floors, (full - part).topRows(floors).norm() / full.topRows(floors).norm());
    most.openings = std::max(most.openings, (full - part).bottomRows(rows).norm() / full.bottomRows(rows).norm());
  }
  return most;
}

// Forces at the floors are among the loads of the training. Without them the floors answer the rows with an error of 8e-3, because the
// rows and the ground hardly deform the block.
TEST(Training, OfManyRowsAnswersFloorsAsWellAsOpenings) {
  const LoadedCase read = load_case_text(block, "case.toml", "test", MeshFiles::in_process);
  const BuiltCase built = build_run(read, runs_of_case(read.read).front());
  const Model& model = built.model;
  const Sparse b = stack_interfaces(model);
  ASSERT_EQ(b.rows(), 75);
  TrainingOptions options{.frequency = 30, .size = 160, .loads_floors = true};
  for (int axis = 0; axis < 3; ++axis) options.floors.push_back(model.space.unknowns() * built.top + axis);
  Matrix floors(3, model.free());
  for (Index k = 0; k < 3; ++k) floors.row(k) = Matrix(model.expansion.col(options.floors[static_cast<std::size_t>(k)])).transpose();
  const Structure whole{Matrix(model.stiffness), Matrix(model.damping), Matrix(model.mass), Matrix(b), floors};
  const Basis basis = train(model, *built.plan.solver, options);
  ASSERT_EQ(basis.why, "");
  EXPECT_LE(basis.transfer_error, options.target);
  const Errors found = errors(whole, basis.vectors);
  EXPECT_LT(found.openings, 2e-3);
  EXPECT_LT(found.floors, 2e-3);
}

}  // namespace
}  // namespace uplift::training_test
