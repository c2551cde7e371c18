#pragma once
#include <span>
#include <utility>
#include <vector>

#include "uplift/elements/scratch.h"
#include "uplift/model/model.h"

namespace uplift {

/// What yielding adds to the linear bulk at one state: the internal force is K u + force.
struct PlasticState {
  std::vector<double> history;  // of all elements with memory
  std::vector<double> parts;    // of each of them: its part of `full`, then that of the energy
  Vector full, force;           // N: on the full unknowns, on the free ones
  double energy = 0;            // J
};

/// The elements of a model that have a memory, as solids that can yield. Their linear part is in the model's matrices.
class PlasticBulk {
 public:
  /// Refers to the model, which must stay alive.
  explicit PlasticBulk(const Model& model);
  bool any() const { return !elements_.empty(); }
  std::size_t num_history() const { return history_; }
  /// The state of an accepted history; an empty one is the natural state.
  PlasticState state(std::vector<double> history) const;
  /// The step that is updated: from a history to the instant of its end.
  struct Update {
    const PlasticState& old;
    MotionInstant at;
    double duration;  // s; 0 in a static stage
  };
  /// Answers displacements (free unknowns) at the end of the step. `size` (null: not wanted), free unknowns, receives the sums of the
  /// elements' absolute forces [N]: what the balance is judged by.
  BulkResponse respond(const Vector& displacement, const Update& step, PlasticState& now, Vector* size) const;
  /// Symmetric part of the consistent tangent less the elastic stiffness, free x free, of the state that `respond` has just given.
  /// `whole`: whether this is all of the tangent (associated flow).
  Sparse softening(const Vector& displacement, const Update& step, const PlasticState& now, bool& whole) const;

  /// Of a state: recoverable energy less u.(K u)/2 of the linear bulk [J].
  double energy(const Vector& displacement, MotionInstant at, const PlasticState& state) const;
  /// Work of the mean stress on the plastic strain of a step [J].
  double dissipated(const Vector& from, MotionInstant before, const PlasticState& old, const Vector& to, MotionInstant after,
                    const PlasticState& now) const;
  /// Work that moving supports do on the forces of yielding in a step [J].
  double support_work(MotionInstant before, const PlasticState& old, MotionInstant after, const PlasticState& now) const;

 private:
  struct One {
    const Element* element;
    std::size_t first, size;            // of its history
    std::size_t unknowns, first_index;  // of the model in index_
    std::size_t first_part;             // in PlasticState::parts
  };
  /// The places of an element's unknowns among the full ones.
  std::span<const int> places(const One& one) const { return std::span(index_).subspan(one.first_index, one.unknowns); }
  void of_element(const One& one, const Vector& full, Vector& result) const;
  static std::span<const double> history_of(const One& one, const std::vector<double>& all) {
    return std::span(all).subspan(one.first, one.size);
  }
  /// Keeps scratch_.inelastic as the part of an element.
  void keep_part(const One& one, PlasticState& state) const;
  /// Sums up the parts.
  void add_parts(PlasticState& state) const;

  const Model& model_;
  std::vector<One> elements_;
  std::vector<int> index_;
  std::size_t history_ = 0, parts_ = 0;  // their numbers
  Sparse spread_, reduction_;            // |T|^T: free x full; T
  /// Room for one element at a time. An object of this class serves one thread.
  struct Scratch {
    ElementScratch element;
    Inelastic inelastic;
    Vector displacement, force, sizes;
  };
  mutable Scratch scratch_;
};

}  // namespace uplift
