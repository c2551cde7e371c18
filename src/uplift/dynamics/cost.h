#pragma once
#include <string>

#include "uplift/linear/rates.h"
#include "uplift/model/model.h"

namespace uplift {

/// What the analysis of a model will need beside the matrix of the step.
struct BulkUse {
  bool keeps_mass = true;   // a factor of M: for impact rules, and for recorded accelerations that only the balance tells (path average)
  bool propagates = false;  // a second factor of the size of the step's (impact rules `propagate`, and `project_hold` with damping)
  double damping = 1, mass = 1;  // of the matrix of a step, K + damping C + mass M [1/s], [1/s2]
  int step_sizes = 1;            // factors of the step kept: one more for every halving that happens
  bool impacts = false;          // a second set of interface blocks, of M
  double record_bytes = 0;       // what the run keeps of its steps
  bool statics = false;          // a static stage, which some solvers treat by another method than the steps
};

/// What the linear bulk of a run takes, known from symbolic analyses before anything large is made (about half of the time of the
/// factorisation). The factor of a static stage is as large as the step's, and gone before that is made.
struct BulkCost {
  FactorCost step, mass;
  double elsewhere_bytes = 0;  // the most that another process of a job holds of a factor; 0 without
  int touched = 0;             // unknowns that the interfaces touch
  double matrix_bytes = 0;     // K, M and C of the model, and the pair of K and M that the steps stream
  double interface_bytes = 0;  // dense blocks of the interface problem
  double record_bytes = 0;     // what the run keeps of its steps
  double bytes = 0;            // what the process will hold at its largest: what it has now (model, mesh, program) and all that is to come
  double available = 0;        // bytes that can still be taken; the model's own matrices are there already
  double factor_seconds = 0;   // of all factors, one after another
  double solve_seconds = 0;    // of one back-solve
  std::string refusal;         // why it cannot be run; empty when it fits
};

BulkCost predict_bulk(const Model& model, const LinearSolver& solver, const BulkUse& use);

}  // namespace uplift
