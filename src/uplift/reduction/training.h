#pragma once
#include <functional>
#include <string>
#include <vector>

#include "uplift/linear/solver.h"
#include "uplift/model/model.h"

namespace uplift {

/// How a basis is made.
struct TrainingOptions {
  double frequency = 25;                         // Hz: the basis represents motions up to about this frequency; the bells last its period
  int size = 0;                                  // coordinates; 0: as many as the target asks for
  double target = 2e-4;                          // of the transfer error, where `size` is 0
  int most = 300;                                // coordinates at most, beside the exact ones
  std::vector<int> floors = {};                  // full unknowns whose velocities the transfer error includes
  bool loads_floors = false;                     // forces at these are among the loads that the basis is made from
  std::function<bool(double share)> go_on = {};  // told of the share that is done; false ends the training
};

/// A basis of the free unknowns, orthonormal in the energy K + w^2 M, and how well it answers.
struct Basis {
  Matrix vectors;               // free unknowns x coordinates
  int rigid = 0;                // the first of them are motions that neither stiffness nor interfaces resist
  double energy_frequency = 0;  // w [rad/s]
  double transfer_error = 0;
  int columns = 0;  // of the marches
  std::string why;  // why there is none; empty where there is
};

/// The basis of docs/theory/reduced_models.md: proper orthogonal decomposition of the answers of the linear model, its interfaces open, to
/// one bell of force at every interface row and at every load.
Basis train(const Model& model, const LinearSolver& solver, const TrainingOptions& options);

}  // namespace uplift
