#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "uplift/interface/joint.h"
#include "uplift/model/element_sum.h"
#include "uplift/model/matrix_home.h"
#include "uplift/model/model.h"

namespace uplift {

/// Damping of the bulk. Stiffness damping never acts across an interface: the interface's stiffness has no part in it.
struct BulkDamping {
  double alpha = 0;           // 1/s, mass-proportional
  double beta = 0;            // s, stiffness-proportional (all parts)
  std::vector<double> modal;  // damping ratios of the first modes of the bonded model (last one repeated if `modal_count` is larger)
  int modal_count = 0;
};
/// Alpha and beta with the given damping ratios at two frequencies [Hz]: ratio = alpha/(2 w) + beta w/2.
BulkDamping rayleigh(double frequency_1, double ratio_1, double frequency_2, double ratio_2);

struct InterfaceSpec {
  std::string name;
  int components = 2;  // 1: normal only; else 2 in the plane, 3 in space; more with rotations
  int rotations = 0;   // see Batch: 1 in the plane, 3 in space
  std::vector<JointPoint> points;
  Place reference;
  std::unique_ptr<const InterfaceLaw> law;  // one of the two
  std::unique_ptr<const Cone> cone;
  std::string behaviour;
  std::optional<Footprint> footprint;  // see Interface
};

/// Collects the parts of a model, then eliminates supports, rigid bodies and inextensible beams and assembles. Mistakes that only show here
/// (repeated or contradicting constraints, an interface inside out) are thrown as InputError with the place given at add time.
class ModelBuilder {
 public:
  explicit ModelBuilder(Space space = {}) : space_(space) {}
  Space space() const { return space_; }
  /// Returns the number of the node; its full unknowns are space().at(number, ...). `alias`: a second name, see Model.
  int add_node(std::string name, Place position, Where where, std::string alias = {});
  void add_element(std::unique_ptr<const Element> element, Where where);
  /// Room for so many more: lists that grow take up to twice what they need.
  void reserve(std::size_t nodes, std::size_t elements);
  int num_elements() const { return static_cast<int>(elements_.size()); }
  /// The unknown stays zero. `repeats`: a support that follows from other constraints is left out instead of refused (a plane of symmetry
  /// that holds several nodes of a rigid body).
  void fix(int node, Dof dof, Where where, bool repeats = false);
  /// The unknown follows a function [m, rad].
  void prescribe(int node, Dof dof, std::shared_ptr<const TimeFunction> motion, std::string name, Where where);
  /// The same motion of several nodes. Those whose motion follows from the others are left out.
  void prescribe(const std::vector<int>& nodes, Dof dof, std::shared_ptr<const TimeFunction> motion, std::string name, const Where& where);
  /// Both nodes have the same value of one unknown. A tie that follows from other constraints is left out.
  void tie_equal(int a, int b, Dof dof, Where where);
  /// The node, which has no element of its own, moves as these nodes with these weights.
  void follow(int node, const std::vector<std::pair<int, double>>& of, const Where& where);
  /// The sum of full unknowns times factors is zero; the first one is eliminated where that is possible.
  void relate(std::vector<std::pair<int, double>> terms, Where where);
  /// The slave's translations and rotations follow the master rigidly (small displacements); chains are allowed.
  void tie_rigid(int master, int slave, Where where);
  /// The distance of the two nodes does not change (beam without axial flexibility).
  void inextensible(int a, int b, Where where);
  void add_interface(InterfaceSpec spec, Where where);
  /// A force pattern of (full unknown, value) pairs [N, N m] times a function (null: constant). `dead`: static stages apply it.
  void add_load(std::string name, std::vector<std::pair<int, double>> pattern, std::shared_ptr<const TimeFunction> function, bool dead,
                Where where);
  /// Forces that follow many functions of time at once (see TimeLoadTable): entries (full unknown, function, value).
  void add_feed(std::string name, std::vector<Triplet> pattern, int functions, std::shared_ptr<const TimeFunctions> values);
  /// Interfaces keep tangential components that supports and constraints hold still.
  void keep_tangents() { keeps_tangents_ = true; }
  /// Gravity [m/s2] on all masses: a dead load.
  void set_gravity(Place acceleration, Where where);
  /// Ground acceleration in the frame that moves with the ground: inertia forces -M r a(t), r the unit translation along `direction`.
  void add_ground_acceleration(Place direction, std::shared_ptr<const TimeFunction> acceleration, std::string name, Where where);
  void set_damping(BulkDamping damping);
  /// Where the rows of the matrices are distributed if the model is not small and has no modal damping; null: they are whole.
  void set_home(std::shared_ptr<const MatrixHome> home) { home_ = std::move(home); }
  /// The finished model; the builder is empty afterwards.
  Model finish();

 private:
  struct Support {
    int node;
    Dof dof;
    int motion;  // -1: fixed
    Where where;
    bool repeats;
  };
  struct Pair {
    int first, second;  // master, slave or ends of a link
    Where where;
  };
  struct Equal {
    int first, second;
    Dof dof;
    Where where;
  };
  struct Relation {
    std::vector<std::pair<int, double>> terms;
    Where where;
  };
  struct TableOfLoads {
    std::string name;
    std::vector<Triplet> pattern;
    int functions;
    std::shared_ptr<const TimeFunctions> values;
  };
  struct Motion {
    std::string name;
    std::shared_ptr<const TimeFunction> function;
  };
  struct Load {
    std::string name;
    std::vector<std::pair<int, double>> pattern;  // full unknowns
    std::shared_ptr<const TimeFunction> function;
    bool dead;
    Where where;
  };

  std::string name_of(int full_unknown) const;
  void eliminate(Model& model, Matrix& motion_shapes) const;
  ElementSum sum(Matrix* Local::*wanted) const { return {space_, elements_, wanted}; }
  std::vector<int> resisted(const Model& model) const;
  void assemble(Model& model) const;
  bool is_distributed(const Model& model) const;
  void distribute(Model& model) const;
  void drop_dead_tangents(const Model& model, const Matrix& motion_shapes);
  void place_interfaces(Model& model);
  Vector water_load(const Model& model, std::size_t interface) const;  // full unknowns
  void refuse_inside_out(const InterfaceSpec& spec, const Where& where) const;
  std::vector<Vec3> structure_of(const InterfaceSpec& spec, bool upper, std::vector<int>& nodes) const;
  void make_drives(Model& model, const Matrix& motion_shapes) const;
  void make_motions(Model& model, const Matrix& shapes) const;

  Space space_;
  std::vector<Node> nodes_;
  std::unordered_set<std::string> node_names_;
  std::map<std::string, int, std::less<>> second_names_;
  std::vector<std::unique_ptr<const Element>> elements_;
  std::vector<Support> supports_;
  std::vector<Pair> ties_, links_;
  std::vector<Equal> equals_;
  std::vector<Relation> relations_;
  std::vector<Motion> motions_;
  std::vector<InterfaceSpec> interfaces_;
  std::vector<Where> interface_where_;
  std::vector<Load> loads_;
  std::vector<GroundAcceleration> grounds_;
  std::vector<TableOfLoads> tables_;
  bool keeps_tangents_ = false;
  Vec3 gravity_ = Vec3::Zero();
  BulkDamping damping_;
  std::shared_ptr<const MatrixHome> home_;
};

}  // namespace uplift
