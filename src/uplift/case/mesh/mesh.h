#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "uplift/case/case.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/elements/element_entry.h"
#include "uplift/mesh/cut.h"
#include "uplift/mesh/sides.h"
#include "uplift/mesh/split.h"
#include "uplift/model/model.h"

// The mesh of a case: where it comes from, how its interfaces are opened, what its cells are made of.
namespace uplift {

/// A mesh, cut and opened along the surfaces of the case's interfaces.
struct CaseMesh {
  Mesh mesh;
  std::optional<Mesh> pieces = {};  // the mesh as it is drawn, with the pieces of cut cells; absent: as it is
  const Mesh& drawn() const { return pieces ? *pieces : mesh; }
  std::string from;                                        // the file, or "soil_box"
  std::vector<std::vector<FacePair>> open;                 // per interface of the case; empty for one without a surface
  std::vector<std::vector<CutFace>> cut;                   // per interface of the case; empty for one without a cut
  std::map<std::string, std::vector<FreeFace>> free = {};  // named surfaces of the ground beside the outlines of cuts
};

/// Reads or makes the mesh, checks it, opens it. Surfaces with the same lower side are opened together, others one after another. Null when
/// the case has none. Throws InputError: both a file and a soil box or neither, groups and surfaces that do not fit.
std::shared_ptr<const CaseMesh> mesh_of_case(const Case& read, const MeshReader& read_mesh);

/// What the solids of a case are made of. Throws InputError unless every cell has exactly one of them. An edge is a side of a cell: in
/// space a face.
class CaseSolids {
 public:
  CaseSolids(const CaseInput& input, const CaseMesh& from);
  const Mesh& mesh() const { return *mesh_; }
  struct Solid {
    const CaseElement* table;
    SolidSection section;
    std::shared_ptr<const CellFilling> filling;
    std::vector<CellId> cells;
    const std::string& group() const { return table->group->name; }
    FillingBeside beside() const { return {section, group()}; }
  };
  const std::vector<Solid>& solids() const { return solids_; }
  /// Of a cell.
  const Solid& of(CellId cell) const;
  /// Of the cell that has this edge; null for an edge of none.
  const Solid* beside(CellId edge) const;
  /// Nodes of such an edge, numbered with the normal out of its cell; empty for an edge between two cells.
  std::vector<int> outward_nodes(CellId edge) const;
  /// Mean place of the nodes of the cell that has this edge, which must be one.
  Vec3 centre_beside(CellId edge) const;
  std::vector<int> nodes(const NameUsed& group) const;
  // Lines or edges of a group; InputError for a group of something else.
  const std::vector<CellId>& lines(const NameUsed& group) const;
  const std::vector<CellId>& edges(const NameUsed& group) const;
  /// The surface beside cuts that has this name; null: none.
  const std::vector<FreeFace>* free_surface(const std::string& name) const;
  /// Takes back what has been made to find edges, which is as large as the mesh; it is made again when an edge is asked for.
  void forget_edges() const { sides_.reset(); }

 private:
  /// The cells of one table.
  void add(const CaseElement& solid);

  const Mesh* mesh_;
  const std::map<std::string, std::vector<FreeFace>>* free_;
  const Sides& sides() const;

  std::vector<Solid> solids_;
  std::vector<CellId> cells_;
  std::vector<int> solid_of_;                   // of the cells
  mutable std::unique_ptr<const Sides> sides_;  // of the cells; null until it is asked for
};

/// Uniform traction on edges: nodes of the mesh with the integrals of their shape functions [m2].
std::vector<std::pair<int, double>> tributary_areas(const CaseSolids& solids, const std::vector<CellId>& edges);

/// The rule of a face of the mesh, or of the part of it that is filled, for its nodes in this order.
CellRule rule_on_face(const Mesh& mesh, CellId face, std::span<const int> nodes, int degree);

/// Cuts the mesh along the planes of the case's [interface.cut], and fills `cut`.
void cut_planes(const Case& read, CaseMesh& made);
/// Normal of the plane of a [interface.cut], from its lower to its upper side.
Vec3 normal_of_cut(const CaseCut& cut, int dimension);
double thickness_of(const CaseSolids& solids, const std::vector<CutFace>& faces, const CaseCut& cut);

/// Thickness of an opened surface [m]: the smaller one of the solids on both sides. Throws InputError at the table when it changes along
/// the surface.
double thickness_of(const CaseSolids& solids, const std::vector<FacePair>& faces, const CaseSurface& surface);

/// The piece of every node of the model, a number that all nodes have that hang together by rigid bodies, ties, inextensible beams and
/// those elements that join their nodes.
std::vector<int> pieces_of(const Model& model, const std::function<bool(const Element&)>& joins);
/// Which nodes of the model hang together with the given ones by elements, rigid bodies, ties and inextensible beams.
std::vector<char> part_of(const Model& model, const std::vector<int>& nodes);

}  // namespace uplift
