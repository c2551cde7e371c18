#pragma once
#include <vector>

#include "uplift/dynamics/step.h"
#include "uplift/run/result.h"

namespace uplift {

/// Makes the displacements of frames from the coordinates of the solution. Those of a reduced model come through its whole basis, which
/// takes as long as several steps: the basis is read once for many pictures.
class Pictures {
 public:
  /// `frames` must outlive it and keep what is added to it.
  Pictures(const Model& model, const RunPlan& plan, std::vector<Frame>& frames);
  /// Adds a frame of this state; its displacements may come later.
  void add(Frame frame, const State& state);
  /// Makes all displacements that are still missing.
  void finish();
  /// Those of a single picture.
  Vector displacement(MotionInstant at, const Vector& coordinates) const;

 private:
  static constexpr int together = 16;
  /// Number of displacements of a picture, and the full unknown of each: all of them, or those of the pictured nodes.
  Index count() const;
  int unknown(Index i) const;
  /// Displacements of pictures from their coordinates, one picture a row, of `Rows` rows.
  template <int Rows>
  void make(const Matrix& coordinates, const std::vector<MotionInstant>& at, const std::vector<Vector*>& displacements) const;

  const Model& model_;
  const RunPlan& plan_;
  std::vector<Frame>& frames_;
  bool waits_ = false;                  // a frame gets its displacements with up to 15 others: the model is a reduced one
  Matrix coordinates_;                  // together x free unknowns, of the last frames
  std::vector<MotionInstant> instant_;  // of the frames whose displacements are missing
};

}  // namespace uplift
