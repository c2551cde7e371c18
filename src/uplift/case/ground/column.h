#pragma once
#include "uplift/elements/solid.h"
#include "uplift/linear/solver.h"
#include "uplift/model/builder.h"
#include "uplift/model/wave_functions.h"
#include "uplift/run/plan.h"

namespace uplift {

/// A part of a soil column between two heights: line2, or line3 with a node in the middle.
struct ColumnLayer {
  double low = 0, high = 0;  // m
  bool quadratic = false;
  SolidSection section;
  double beta = 0;  // s, stiffness-proportional damping of the solid
};

/// A wave that comes up the column.
struct ColumnWave {
  double shear = 0, compression = 0;             // its particle motion: horizontal, upwards
  std::shared_ptr<const TimeFunction> velocity;  // of the incoming wave alone [m/s]
  std::string name = {};                         // of the load that it is at the foot of the model
};

/// The free field: a column of unit area of level ground under a wave that comes up vertically, one-dimensional in height,
///   rho u'' = (G u,z),z   (horizontal),   rho w'' = ((lambda + 2 G) w,z),z   (vertical),
/// free at the top, with the viscous boundary of the incident wave at its foot. Marched once through the dynamic stages with their schemes
/// and steps, by the elements (degree, mass, damping) of the ground beside it, so that nothing differs from ground that moves with it.
class FreeField final : public WaveFunctions {
 public:
  /// Layers from the foot to the top, without gaps.
  FreeField(std::vector<ColumnLayer> layers, ColumnWave wave, BulkDamping damping, const std::vector<Stage>& stages,
            std::shared_ptr<const LinearSolver> solver);
  /// Heights of the nodes, ascending [m].
  const std::vector<double>& heights() const { return heights_; }
  /// Number of functions: velocities [m/s] of all nodes (horizontal, vertical of each), then displacements [m] likewise.
  int functions() const { return 4 * static_cast<int>(heights_.size()); }
  /// Between steps velocities are linear and displacements are their integral.
  void values(double time, Vector& values) const override;
  std::string_view load() const override { return wave_.name; }
  std::shared_ptr<const TimeFunctions> under(std::shared_ptr<const TimeFunction> velocity, double step, double duration) const override;
  /// Why the march ended early; empty when it did not.
  const std::string& why() const { return why_; }

 private:
  void march(const std::vector<Stage>& stages);
  void keep(const Model& model, const State& state);

  std::vector<ColumnLayer> layers_;
  ColumnWave wave_;
  BulkDamping damping_;
  std::shared_ptr<const LinearSolver> solver_;
  std::vector<double> heights_, times_;
  std::vector<Vector> states_;  // per time: as values()
  std::string why_;
};

}  // namespace uplift
