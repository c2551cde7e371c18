#pragma once
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "uplift/case/build/names.h"
#include "uplift/case/case.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/elements/element_entry.h"
#include "uplift/model/builder.h"

// The steps by which a case becomes a model; used by build() alone.
namespace uplift {

/// Names and places met so far.
struct CaseNames {
  Names nodes{"node"}, functions{"function"}, interfaces{"interface"};
  Space space;
  std::vector<Place> positions;                                     // of the nodes
  std::vector<std::shared_ptr<const TimeFunction>> functions_made;  // then the records: null
  const std::vector<CaseRecord>* records = nullptr;
  const CaseOtherMotion* instead = nullptr;            // [[compare.motion]] of the run; null: as in the case
  double motion_factor = 1;                            // see RunSpec
  std::vector<FunctionUse>* functions_used = nullptr;  // the functions that are given out; null: they are not wanted
  /// Whether a function is a record, which has a unit.
  bool is_record(const std::optional<NameUsed>& function) const;
  double share = 0;                          // of the displacements of records, see MotionFunction
  std::shared_ptr<const CaseSolids> solids;  // null without a mesh
  int first_of_mesh = 0;                     // node of the model that the mesh's first node is
  Coordinates coordinates;                   // of the nodes up to the mesh's last
  std::vector<BeamLine> beams;               // met so far
  std::set<int> bare;                        // nodes that stand outside of what their cut cells fill
  /// A node that is named; InputError where nothing stands at it.
  int node(const NameUsed& name) const;
  std::vector<int> nodes_of(const std::vector<NameUsed>& used) const;
  /// Nodes of the model of a cell of the mesh, which there is.
  std::vector<int> nodes_of_cell(CellId cell) const;
  std::vector<int> nodes_of(const NodeOrGroup& of) const;
  /// The mesh that this group is of; InputError without one.
  const CaseSolids& mesh_for(const NameUsed& group) const;
  /// What drives something; absent: constant 1. `kind`: the quantity taken of a record, none where no motion can stand. `factor`: of
  /// the function.
  std::shared_ptr<const TimeFunction> function(const std::optional<NameUsed>& name, std::optional<MotionKind> kind = {},
                                               std::optional<double> factor = {}) const;

 private:
  std::shared_ptr<const TimeFunction> make_function(const std::optional<NameUsed>& name, std::optional<MotionKind> kind) const;
  int index_taken(const NameUsed& function) const;
};

/// Nodes, functions, elements, supports, motions, loads and damping. `tuned` is the mass of the tuned point masses [kg], one per such mass.
void add_nodes(const CaseInput& input, ModelBuilder& builder, CaseNames& names);
/// Nodes and solids of the mesh.
void add_mesh(const Case& read, ModelBuilder& builder, CaseNames& names);
/// Elements on faces of the mesh, and the waves that come in through absorbing ones; after the functions.
void add_faces(const Case& read, ModelBuilder& builder, const CaseNames& names);
/// A function times an amplitude.
std::shared_ptr<const TimeFunction> scaled(double factor, std::shared_ptr<const TimeFunction> function);
/// The force [N] that a load puts on the whole model when its function is 1.
Vec3 resultant_of_load(const CaseLoad& load, const Model& model);
/// Functions, then records.
void add_functions(const Case& read, CaseNames& names);
/// Nodes of beams: those of the mesh that have rotations.
std::set<int> beam_nodes(const CaseNames& names);
/// Beams between nodes and along groups of the mesh.
void add_beams(const Case& read, ModelBuilder& builder, CaseNames& names);
/// The master node of a rigid body: as named, else the node of its group that is nearest to the group's middle.
int master_of(const CaseBody& body, const CaseNames& names);
/// `at_rest`: with the supports that hold in static stages alone.
void add_structure(const Case& read, ModelBuilder& builder, CaseNames& names, const std::vector<double>& tuned, bool at_rest);
/// Supports and prescribed motions. Groups of two sides share the corner: it is held once, and moves where one of them moves.
void add_supports(const Case& read, ModelBuilder& builder, const CaseNames& names, bool at_rest);
/// Whether supports hold in static stages alone.
bool any_released(const CaseInput& input);
void add_loads(const CaseInput& input, ModelBuilder& builder, const CaseNames& names);
/// Initial displacements and velocities of the free unknowns; after the model is made.
void add_initial(const CaseInput& input, const CaseNames& names, BuiltCase& built);

/// Joint points of an interface with its lower nodes; with an elastic bed (unless `rigid_ground`) these are made here.
struct Joint {
  std::vector<JointPoint> points;
  InterfaceFacts facts;
  Place reference;
};
/// `open`: the faces that the mesh was opened at for it; `cut`: those that its plane has cut.
Joint make_joint(const CaseInterface& interface, const std::vector<FacePair>& open, const std::vector<CutFace>& cut, bool rigid_ground,
                 ModelBuilder& builder, CaseNames& names);

/// The underside of a [[foundation]], and its one point.
Footprint footprint_of(const CaseFoundation& foundation, Space space);
Joint foundation_joint(const CaseFoundation& foundation, const Footprint& footprint, const CaseNames& names);
/// Of [foundation.soil] with `radiation`; else null.
std::unique_ptr<const Element> radiation_dashpot(const CaseFoundation& foundation, const Footprint& footprint, const CaseNames& names);

/// Initial gaps that come from the geometry or from a table; of points with both sides.
void set_gaps(const CaseInterface& interface, std::vector<JointPoint>& points, const CaseNames& names);

/// Number of local components that a law or cone needs: 1 when it has no tangential part, else all of the space.
int components_of(const Values& behaviour, Space space);
/// The same joint with some of its points alone.
Joint with_points(const Joint& joint, std::vector<JointPoint> points);

}  // namespace uplift
