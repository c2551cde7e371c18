#pragma once
#include <string>
#include <vector>

#include "uplift/mesh/mesh.h"

// Opens a conforming mesh along named surfaces, so that both sides can part there.
namespace uplift {

/// The two faces of one face of an opened surface, as cells of the mesh. Their nodes stand in corresponding order, numbered with the normal
/// from the lower to the upper side (edges a-b of plane meshes: normal (dy, -dx)). Where the surface ends inside the continuum both have
/// the same node.
struct FacePair {
  CellId lower, upper;
};
/// Two nodes at the same place, one on either side.
struct NodePair {
  int lower = 0, upper = 0;
  auto operator<=>(const NodePair&) const = default;  // NOLINT(modernize-use-nullptr): false alarm of clang-tidy 14
};
struct OpenedSurface {
  std::string name;
  std::vector<FacePair> faces;  // in the order of the group
  std::vector<NodePair> pairs;  // ascending, each once; none where the surface ends inside
};

/// Opens the mesh along groups of faces (edges in plane meshes) of which each lies between a cell of the lower side and one of the upper
/// side. The lower side are the cells of the groups `lower`; all other cells are the upper side.
/// - Around each node of the surfaces, cells that share faces not on the surfaces stay together; places are never compared. So nodes where
/// the
///   surface ends inside the continuum stay single, nodes where it meets the outer boundary or a closed corner are doubled.
/// - The lower side keeps its nodes, the upper side gets the new ones, appended to the mesh. No node gets more than one double in one call.
/// - Groups: the surface's faces stay with the lower side (in all groups that hold them); the faces of the upper side become the new group
///   "<name>_upper". Faces in other groups go with the cell that they belong to. Cells without one (beams, points) go with the upper side,
///   unless one of their groups is in `lower`. A group of nodes that has a node gets its double too.
/// - Surfaces that meet (bottom and wall of one raft) belong into one call. Surfaces with different lower sides are opened one after
/// another,
///   crossings included; the pairs of earlier ones are then out of date: take `pairs_of` again (their faces stay right).
/// Throws InputError: surface or lower group absent (with the nearest name), faces not between the two sides, a node at which the surface
/// branches so that two nodes are not enough, "<name>_upper" exists already, nothing to open. The mesh is unchanged then.
std::vector<OpenedSurface> split(Mesh& mesh, const std::vector<std::string>& surfaces, const std::vector<std::string>& lower,
                                 const Where& where);

/// Pairs of different nodes of faces opened before.
std::vector<NodePair> pairs_of(const Mesh& mesh, const std::vector<FacePair>& faces);

}  // namespace uplift
