#pragma once
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/case/case.h"

namespace uplift {

/// What drawings of a model show beside its nodes and beams, in nodes of the model and groups of the mesh, in the order of the case.
struct DrawnParts {
  struct Mass {
    int node;
    double mass;  // kg
  };
  /// Of a node, or of all nodes of a group.
  struct Support {
    int node;  // -1: of the group
    std::string group;
    std::vector<std::string> fixed;
    bool statics_only;
  };
  /// With an empty force it is a moment, which is not drawn.
  struct Load {
    std::string name;
    int node;  // -1: of the group
    std::string group;
    std::vector<double> force;  // as the case states it [N, or Pa on a group], of a pressure its resultant [N]
  };
  /// A spring or dashpot.
  struct Link {
    int node, other;  // other: -1: fixed ground
    std::string_view symbol;
  };
  struct AbsorbingFace {
    std::string group;
    bool free_field, incident;
  };
  /// A rigid plate above an interface; its outline is InterfaceFacts::corners.
  struct Body {
    std::size_t interface;
    int node;
    bool foundation;    // of one point with rotations
    int along, across;  // points that stand on a grid up to the edges; 0: they do not
  };
  int first_of_mesh = 0;            // number of nodes of the case; those of the mesh follow
  std::vector<std::string> solids;  // groups of cells
  std::vector<Mass> masses;
  std::vector<Support> supports;
  std::vector<Load> loads;
  std::vector<Link> links;
  std::vector<AbsorbingFace> absorbing;
  std::vector<Body> bodies;  // in the order of the interfaces of the model

  /// Nodes that anything of this stands on.
  std::set<int> nodes() const;
  /// The body above an interface; null: none.
  const Body* body_above(std::size_t interface) const;
};

DrawnParts drawn_parts(const Case&, const BuiltCase&);

/// Nodes of the drawing of a model in space, ascending: those of the surfaces of solids, of the case, of beams and of rigid bodies.
std::vector<int> nodes_drawn_in_space(const Case&, const BuiltCase&, const DrawnParts&);

/// Pictures of so many nodes in space that the report shows at most: it stays below about 500 kB.
std::size_t most_pictures_in_space(std::size_t nodes);

}  // namespace uplift
