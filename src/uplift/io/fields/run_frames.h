#pragma once
#include <map>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "uplift/case/case.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/io/fields/fields.h"
#include "uplift/run/force_rows.h"
#include "uplift/run/interface_viewer.h"

// What stands in the frames of a run; used by field_run*.cpp alone.
namespace uplift {

/// The faces of a run's interfaces, and what its states say of them.
class InterfaceFrames {
 public:
  /// Takes the interfaces that stand on surfaces of the mesh; there may be none.
  InterfaceFrames(const Case& read, const BuiltCase& built);
  const InterfaceMesh& mesh() const { return mesh_; }

  /// Of all places of the faces (see InterfaceMesh). Vectors are in the axes of the model. Where the surface ends inside the continuum
  /// there is nothing to open: all is zero and the status that of a closed joint.
  struct JointValues {
    std::vector<double> opening;   // m, > 0
    std::vector<double> slip;      // m, 3 each: of the upper side along the lower one
    std::vector<double> traction;  // Pa, 3 each: what the upper side exerts on the lower one
    std::vector<double> pressure;  // Pa, compression > 0
    std::vector<double> status;    // 0 open, 1 closed, 2 closed and slipping
  };
  JointValues at(const State& state) const;

 private:
  using Terms = std::vector<std::pair<int, double>>;  // joint points and their weights
  struct Surface {
    int interface = 0, first_row = 0;
    double friction = -1, cohesion = 0;  // coefficient, negative: no friction law; Pa
    GapRule rule;
    std::vector<Terms> places;
  };
  void add_point(const Surface& surface, const State& state, int point, JointValues& values) const;
  int status(const Surface& surface, double gap, double pressure, double shear) const;

  const Model* model_;
  double gap_tolerance_;
  InterfaceMesh mesh_;
  std::vector<Surface> surfaces_;
};

/// Section forces in the middle of every line of a run's beams, in the direction of the line (docs/theory, section 13).
class BeamFrames {
 public:
  /// Takes the beam of a group; `block` is its mesh.
  void add(const CaseElement& beam, const CaseSolids& solids, const BuiltCase& built, const FieldMesh& block);
  std::size_t beams() const { return first_.size(); }
  /// Component after component, of all lines of all beams; for a ForceMeter.
  const std::vector<const ForceQuantity*>& quantities() const { return quantities_; }
  /// Names of the components, and their values where `values` (one per quantity) are not empty.
  std::vector<FieldValues> fields(std::size_t beam, const std::vector<double>& values) const;

 private:
  Space space_;
  std::vector<std::size_t> first_, lines_;  // of each beam: its first quantity, its lines
  std::vector<std::unique_ptr<const ForceQuantity>> held_;
  std::vector<const ForceQuantity*> quantities_;
};

/// The frames of a run: a block for each solid, one for each beam of a group, and one for the faces of all interfaces, "interfaces".
class RunFrames {
 public:
  /// `fields` is [output.fields]. Throws InputError: no mesh, quantities and groups that are not there.
  RunFrames(const CaseFields& fields, const Case& read, const BuiltCase& built);
  const std::vector<FieldMesh>& blocks() const { return blocks_; }
  /// Names and kinds, and section forces where there are any; no other values.
  FieldFrame empty(const std::vector<double>& section_forces = {}) const;
  /// Forces in the beams that `of` wants the values of.
  const std::vector<const ForceQuantity*>& section_forces() const { return beams_.quantities(); }
  /// Acceleration [free unknowns]; null: nothing moves. `time` is the frame's.
  FieldFrame of(const State& state, const Vector* acceleration, const std::vector<double>& section_forces, double time) const;

 private:
  bool wants(std::string_view quantity) const;
  std::vector<double> motion(const FieldMesh& block, const Vector& full) const;
  std::vector<double> of_elements(std::size_t block, std::size_t output, const Vector& full, const std::vector<double>& history) const;

  const Model* model_;
  std::vector<std::string> quantities_;  // empty: all
  std::vector<FieldMesh> blocks_;
  std::vector<std::vector<const Element*>> solids_;               // of the first blocks, in the order of their cells
  std::map<const Element*, std::size_t> first_history_;           // of the elements with memory: where the state has it
  std::map<int, std::vector<std::pair<int, double>>> followers_;  // nodes of the pieces of cut cells, as in Mesh
  InterfaceFrames interfaces_;
  BeamFrames beams_;                    // of the blocks behind those of the solids
  std::size_t stride_ = 0, first_ = 0;  // unknowns of a node; the first of the mesh's first node
  int dimension_ = 2;
};

}  // namespace uplift
