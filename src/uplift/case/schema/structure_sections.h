#pragma once
#include "uplift/case/schema/case_table.h"
#include "uplift/case/schema/profile.h"
#include "uplift/elements/element_entry.h"

// The structure, its supports, motions and loads: declarations, used by case/schema/sections.cpp alone, and what their tables are read
// into.
namespace uplift {

const Section& node_section();
struct CaseNode : CaseTable {
  std::string name;
  Vec3 position;
};
CaseNode case_node(const Values&, Space);

const Section& mass_section();
struct CaseMass : CaseTable {
  NameUsed node;
  std::optional<double> mass;  // kg; absent: it is tuned
  double tuned_frequency;      // Hz, of the model with this mass; 0: not tuned
  Vec3 inertia;                // kg m2 about the axes
};
CaseMass case_mass(const Values&, Space);

/// A table [[name]] for each element of the catalog that stands at one kind of place.
const std::vector<Section>& element_sections(ElementPlace place);
/// Where the elements of such a table stand. All other keys are for its entry.
struct CaseElement : CaseTable {
  const ElementEntry* entry;
  std::vector<NameUsed> nodes;
  std::optional<NameUsed> group;  // of the mesh
  // of elements on lines, which have either two nodes or a group
  NameUsed name;
  int pieces = 1;  // elements of each straight stretch
};
CaseElement case_element(const Values&, const ElementEntry& entry);

const Section& rigid_section();
struct CaseBody : CaseTable {
  std::optional<NameUsed> name, node, group;
  std::vector<NameUsed> slaves;
  double mass;                 // kg
  Vec3 inertia;                // kg m2 about the axes through the centre
  std::optional<Vec3> centre;  // m
};
CaseBody case_body(const Values&, Space);

const Section& support_section();
struct CaseSupport : CaseTable {
  NodeOrGroup of;
  std::vector<NameUsed> fixed;  // unknowns
  bool statics_only;            // released when the first dynamic stage begins
};
CaseSupport case_support(const Values&);

const Section& motion_section();
struct CaseMotion : CaseTable {
  NodeOrGroup of;
  std::string name;
  NameUsed direction;  // unknown
  bool turns;
  std::string amplitude;  // with a unit that depends on the function
  std::optional<NameUsed> function;
};
CaseMotion case_motion(const Values&);

const Section& ground_section();
struct CaseGround : CaseTable {
  std::string name;
  Vec3 direction;
  double amplitude;  // m/s2, of a record 1
  NameUsed function;
};
CaseGround case_ground(const Values&, Space);

const Section& gravity_section();
struct CaseGravity : CaseTable {
  Vec3 acceleration;  // m/s2
};
CaseGravity case_gravity(const Values&, Space);

const Section& function_section();
struct CaseFunction : CaseTable {
  NameUsed name;
  const Values* shape;
  std::optional<NameUsed> file;  // that the shape reads
};
CaseFunction case_function(const Values&);

const Section& load_section();
/// On a node a force or a moment, on a group exactly one of force, traction and pressure.
struct CaseLoad : CaseTable {
  NodeOrGroup of;
  std::string name;                // as stated, else from what it acts on
  std::optional<Vec3> force;       // N
  std::optional<Vec3> traction;    // Pa
  std::optional<double> pressure;  // Pa
  Vec3 moment;                     // N m about the axes
  std::optional<Profile> profile;
  std::optional<NameUsed> function;
};
CaseLoad case_load(const Values&, Space);

const Section& initial_section();
struct CaseInitial : CaseTable {
  /// Along and about the axes; null where they are not given.
  struct Motion {
    std::optional<Vec3> translation, rotation;
  };
  NodeOrGroup of;
  Motion displacement, velocity;  // m and rad, per s
  std::optional<Vec3> centre;     // m, of a group that rotates
};
CaseInitial case_initial(const Values&, Space);

}  // namespace uplift
