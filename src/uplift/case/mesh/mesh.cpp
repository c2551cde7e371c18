#include "uplift/case/mesh/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <limits>
#include <numeric>
#include <set>

#include "uplift/base/text.h"
#include "uplift/case/build/model.h"
#include "uplift/linear/memory.h"
#include "uplift/mesh/absent_group.h"
#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"
#include "uplift/mesh/facing.h"
#include "uplift/mesh/index.h"
#include "uplift/mesh/parts.h"
#include "uplift/mesh/shift.h"
#include "uplift/mesh/soil_box.h"

namespace uplift {
namespace {

Mesh make_soil_box(const SoilBox& made, const Values& box) {
  // At least: stiffness and mass of one node for each element, with 3 x 81 or 2 x 18 numbers of 12 bytes each; the factor takes more.
  const double bytes = made.dimension == 3 ? 6000 : 900;
  return soil_box(made, box.where(), box.path() + ".", available_memory() / bytes);
}

/// Whether the faces of a surface are drawn apart; the mesh is opened at others.
bool drawn_apart(const CaseSurface& surface) {
  return surface.lower_group.has_value();
}

/// Groups of interfaces whose surfaces have the same lower side, in the order of the case.
std::vector<std::vector<std::size_t>> opened_together(const std::vector<CaseInterface>& interfaces) {
  std::vector<std::vector<std::size_t>> together;
  std::vector<std::vector<std::string>> sides;
  for (std::size_t k = 0; k < interfaces.size(); ++k) {
    const CaseSurface* surface = interfaces[k].surface();
    if (!surface || drawn_apart(*surface)) continue;
    std::vector<std::string> lower = surface->lower;
    std::ranges::sort(lower);
    const auto same = std::ranges::find(sides, lower);
    if (same == sides.end()) {
      sides.push_back(std::move(lower));
      together.push_back({k});
    } else {
      together[static_cast<std::size_t>(same - sides.begin())].push_back(k);
    }
  }
  return together;
}

void open_surfaces(const std::vector<CaseInterface>& interfaces, CaseMesh& made) {
  made.open.resize(interfaces.size());
  for (const std::vector<std::size_t>& together : opened_together(interfaces)) {
    std::vector<std::string> surfaces;
    for (const std::size_t k : together) surfaces.push_back(interfaces[k].surface()->group->name);
    const CaseSurface& first = *interfaces[together.front()].surface();
    std::vector<OpenedSurface> opened = split(made.mesh, surfaces, first.lower, first.group->where());
    for (std::size_t i = 0; i < together.size(); ++i) made.open[together[i]] = std::move(opened[i].faces);
  }
  for (std::size_t k = 0; k < interfaces.size(); ++k)
    if (const CaseSurface* surface = interfaces[k].surface(); surface && drawn_apart(*surface))
      made.open[k] = facing_pairs(made.mesh, surface->lower_group->name, surface->upper_group->name, surface->upper_group->where());
}

const Group& group_named(const Mesh& mesh, const NameUsed& used, const std::string& what) {
  const auto found = mesh.groups.find(used.name);
  if (found != mesh.groups.end()) return found->second;
  throw absent_group(mesh, used.name, used.where(), used.path(), what);
}

/// What a group holds, in the words of its mesh: cells fill it, edges (in space: faces) bound them.
std::string dimension_word(const Mesh& mesh, int dimension) {
  const char* word = dimension == 0 ? "nodes" : dimension == mesh.dimension ? "cells" : dimension == 2 ? "faces" : "edges";
  return std::string("a group of ") + word;
}

/// The first group of cells that holds the cell, or the cell itself, for messages.
std::string owner_of(const Mesh& mesh, CellId cell) {
  for (const auto& [name, group] : mesh.groups)
    if (group.dimension == mesh.dimension && std::ranges::binary_search(group.cells, cell)) return in_quotes(name);
  return describe_cell(mesh, cell);
}

/// A mesh of beams needs no solids.
bool beams_alone(const CaseInput& input) {
  return input.elements_at(ElementPlace::cells).empty() &&
         std::ranges::any_of(input.elements_at(ElementPlace::lines), [](const CaseElement& beam) { return beam.group.has_value(); });
}

/// Faces that do not lie in a plane of equal z are taken for a mesh in space, which has nothing to be solid.
void check_solid(const Mesh& mesh, const NameUsed& file) {
  const auto fills = [&](const CellBlock& block) { return info(block.cell).dimension == mesh.dimension; };
  if (mesh.dimension == 2 || std::ranges::any_of(mesh.blocks, fills)) return;
  std::string found = "no solid cells";
  for (const char axis : {'x', 'y', 'z'}) {
    const auto along = [&](const Vec3& point) { return point[axis - 'x']; };
    const auto [least, most] = std::ranges::minmax(mesh.nodes, {}, along);
    found += fmt::format("{} {} from {:g} to {:g}", axis == 'x' ? ", nodes with" : ",", axis, along(least), along(most));
  }
  fail(file, "cells of space (tet, hex, wedge), or a mesh in the plane: x to the right, y up, all z equal", found);
}

}  // namespace

std::shared_ptr<const CaseMesh> mesh_of_case(const Case& read, const MeshReader& read_mesh) {
  const std::optional<CaseMeshSource>& mesh = read.input->mesh;
  if (!mesh) {
    for (const CaseInterface& interface : read.input->interfaces) {
      const char* key = interface.surface() ? "surface" : interface.cut() ? "cut" : nullptr;
      if (key != nullptr) fail(interface, key, fmt::format("a [mesh] for the {}", key), "none");
    }
    for (const ElementPlace place : {ElementPlace::cells, ElementPlace::faces})
      if (const auto& tables = read.input->elements_at(place); !tables.empty())
        fail(tables.front(), "", "a [mesh] with this group", "none");
    return nullptr;
  }
  auto made = std::make_shared<CaseMesh>();
  if (mesh->file) {
    assert(read_mesh);
    const Where where = mesh->file->where();
    made->from = (std::filesystem::path(read.file).parent_path() / mesh->file->name).lexically_normal().string();
    made->mesh = read_mesh(made->from, where, mesh->name);
    check_mesh(made->mesh, {made->from, 0});
    if (!beams_alone(*read.input)) check_solid(made->mesh, *mesh->file);
  } else {
    made->from = "soil_box";
    made->mesh = make_soil_box(*mesh->soil_box, *mesh->box_table);
  }
  cut_planes(read, *made);
  open_surfaces(read.input->interfaces, *made);
  if (!made->mesh.parts.empty()) made->pieces = drawn_mesh(made->mesh);
  return made;
}

CaseSolids::CaseSolids(const CaseInput& input, const CaseMesh& from) : mesh_(&from.mesh), free_(&from.free), cells_(full_cells(from.mesh)) {
  solid_of_.assign(cells_.size(), -1);
  for (const CaseElement& solid : input.elements_at(ElementPlace::cells)) add(solid);
  const auto bare = std::ranges::find(solid_of_, -1);
  if (bare != solid_of_.end())
    throw InputError(input.mesh->where(), "solid", "a [[solid]] for every cell of the mesh",
                     "none for " + owner_of(*mesh_, cells_[static_cast<std::size_t>(bare - solid_of_.begin())]));
}

const Sides& CaseSolids::sides() const {
  if (sides_ == nullptr) sides_ = std::make_unique<const Sides>(*mesh_, cells_);
  return *sides_;
}

void CaseSolids::add(const CaseElement& solid) {
  const Group& group = group_named(*mesh_, *solid.group, "a group of cells");
  if (group.dimension != mesh_->dimension || group.cells.empty())
    fail(*solid.group, "a group of cells", dimension_word(*mesh_, group.dimension));
  for (const CellId cell : group.cells) {
    int& solid_here = solid_of_[static_cast<std::size_t>(std::ranges::lower_bound(cells_, cell) - cells_.begin())];
    if (solid_here >= 0)
      fail(*solid.group, "cells without another solid",
           fmt::format("{}, which belongs to the solid {} too", describe_cell(*mesh_, cell), in_quotes(solids_[at(solid_here)].group())));
    solid_here = static_cast<int>(solids_.size());
  }
  std::shared_ptr<const CellFilling> filling = solid.entry->fill(*solid.table, mesh_->dimension);
  const SolidSection section = filling->section();
  solids_.push_back({&solid, section, std::move(filling), group.cells});
}

const CaseSolids::Solid& CaseSolids::of(CellId cell) const {
  const auto found = std::ranges::lower_bound(cells_, cell);
  assert(found != cells_.end() && *found == cell);
  return solids_[at(solid_of_[static_cast<std::size_t>(found - cells_.begin())])];
}

const CaseSolids::Solid* CaseSolids::beside(CellId edge) const {
  const int side = sides().find(mesh_->type(edge), mesh_->cell(edge));
  return side < 0 ? nullptr : &solids_[at(solid_of_[at(side / Sides::stride)])];
}

std::vector<int> CaseSolids::outward_nodes(CellId edge) const {
  const int side = sides().find(mesh_->type(edge), mesh_->cell(edge));
  std::vector<int> nodes;
  if (side >= 0 && sides().twin(side) < 0) sides().nodes_of(*mesh_, side, nodes);
  return nodes;
}

Vec3 CaseSolids::centre_beside(CellId edge) const {
  const int side = sides().find(mesh_->type(edge), mesh_->cell(edge));
  assert(side >= 0);
  const std::span<const int> nodes = mesh_->cell(cells_[at(side / Sides::stride)]);
  Vec3 sum = Vec3::Zero();
  for (const int node : nodes) sum += mesh_->nodes[at(node)];
  return sum / static_cast<double>(nodes.size());
}

std::vector<int> CaseSolids::nodes(const NameUsed& group) const {
  std::vector<int> found = nodes_of(*mesh_, group_named(*mesh_, group, "a group of the mesh"));
  if (found.empty()) fail(group, "a group with nodes", "an empty one");
  return found;
}

const std::vector<CellId>& CaseSolids::lines(const NameUsed& name) const {
  const Group& group = group_named(*mesh_, name, "a group of lines");
  if (group.dimension != 1 || group.cells.empty()) fail(name, "a group of lines", dimension_word(*mesh_, group.dimension));
  return group.cells;
}

const std::vector<CellId>& CaseSolids::edges(const NameUsed& name) const {
  const std::string wanted = dimension_word(*mesh_, mesh_->dimension - 1);
  const Group& group = group_named(*mesh_, name, wanted);
  if (group.dimension != mesh_->dimension - 1 || group.cells.empty()) fail(name, wanted, dimension_word(*mesh_, group.dimension));
  for (const CellId edge : group.cells)
    if (!beside(edge))
      fail(name, mesh_->dimension == 2 ? "edges of cells" : "faces of cells", describe_cell(*mesh_, edge) + " beside no cell");
  return group.cells;
}

const std::vector<FreeFace>* CaseSolids::free_surface(const std::string& name) const {
  const auto found = free_->find(name);
  return found != free_->end() ? &found->second : nullptr;
}

std::vector<std::pair<int, double>> tributary_areas(const CaseSolids& solids, const std::vector<CellId>& edges) {
  const Mesh& mesh = solids.mesh();
  std::vector<std::pair<int, double>> areas;
  std::vector<Vec3> positions;
  for (const CellId edge : edges) {
    const Cell cell = mesh.type(edge);
    const double thickness = solids.beside(edge)->section.thickness;
    const std::span<const int> nodes = mesh.cell(edge);
    positions.clear();
    for (const int node : nodes) positions.push_back(mesh.nodes[at(node)]);
    const CellRule rule = rule_on_face(mesh, edge, nodes, 4);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      double area = 0;
      for (std::size_t i = 0; i < rule.point.size(); ++i) {
        const CellShape shape = cell_shape(cell, rule.point[i]);
        area += rule.weight[i] * shape.value[a] * cell_area_vector(shape, positions, cell).norm() * thickness;
      }
      areas.emplace_back(nodes[a], area);
    }
  }
  return areas;
}

CellRule rule_on_face(const Mesh& mesh, CellId face, std::span<const int> nodes, int degree) {
  const Cell cell = mesh.type(face);
  if (!mesh.part(face)) return cell_rule(cell, degree);
  std::vector<Vec3> before, now;
  for (const int node : mesh.cell(face)) before.push_back(mesh.nodes[at(node)]);
  for (const int node : nodes) now.push_back(mesh.nodes[at(node)]);
  CellRule rule = rule_of_part(mesh, face);
  for (Vec3& point : rule.point) point = local_coordinates(cell, now, cell_position(cell_shape(cell, point), before));
  return rule;
}

double thickness_of(const CaseSolids& solids, const std::vector<CutFace>& faces, const CaseCut& cut) {
  if (cut.thickness) return *cut.thickness;
  double least = std::numeric_limits<double>::infinity();
  for (const CutFace& face : faces)
    least = std::min({least, solids.of(face.lower).section.thickness, solids.of(face.upper).section.thickness});
  return least;
}

double thickness_of(const CaseSolids& solids, const std::vector<FacePair>& faces, const CaseSurface& surface) {
  if (surface.thickness) return *surface.thickness;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const FacePair& face : faces) {
    const double thickness = std::min(solids.beside(face.lower)->section.thickness, solids.beside(face.upper)->section.thickness);
    least = std::min(least, thickness);
    most = std::max(most, thickness);
  }
  if (most > least) fail(surface, "", "thickness, where that of the solids changes along the surface", "none");
  return most;
}

std::vector<int> pieces_of(const Model& model, const std::function<bool(const Element&)>& joins) {
  std::vector<int> parent(model.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int node) {
    while (parent[at(node)] != node) node = parent[at(node)] = parent[at(parent[at(node)])];
    return node;
  };
  const auto join = [&](int a, int b) { parent[at(root(a))] = root(b); };
  for (const auto& element : model.elements)
    if (joins(*element))
      for (const int node : element->nodes()) join(node, element->nodes()[0]);
  const Sparse rows = model.assembly.constraints.transpose();  // a column for each constraint
  for (int row = 0; row < static_cast<int>(rows.cols()); ++row) {
    int first = -1;
    for (Sparse::InnerIterator entry(rows, row); entry; ++entry) {
      const int node = model.space.node_of(entry.row());
      if (first < 0) first = node;
      join(node, first);
    }
  }
  std::vector<int> pieces(model.nodes.size());
  for (int node = 0; node < static_cast<int>(pieces.size()); ++node) pieces[at(node)] = root(node);
  return pieces;
}

std::vector<char> part_of(const Model& model, const std::vector<int>& nodes) {
  const std::vector<int> pieces = pieces_of(model, [](const Element&) { return true; });
  std::vector<char> started(model.nodes.size(), 0), part(model.nodes.size(), 0);
  for (const int node : nodes) started[at(pieces[at(node)])] = 1;
  for (std::size_t node = 0; node < part.size(); ++node) part[node] = started[at(pieces[node])];
  return part;
}

}  // namespace uplift
