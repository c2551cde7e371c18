#include "uplift/io/fields/fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "uplift/base/error.h"
#include "uplift/base/text.h"
#include "uplift/io/fields/parts.h"

namespace uplift {
namespace {

/// Cells of the mesh in the order of types, as blocks of one field mesh. Nodes are still those of the mesh.
void take_cells(FieldMesh& block, const Mesh& mesh, const std::vector<CellId>& cells) {
  for (const CellId id : cells) {
    const Cell type = mesh.type(id);
    if (block.blocks.empty() || block.blocks.back().cell != type) block.blocks.push_back({type, {}});
    const auto nodes = mesh.cell(id);
    block.blocks.back().nodes.insert(block.blocks.back().nodes.end(), nodes.begin(), nodes.end());
  }
  block.cell = cells;
}

std::string position(const Vec3& at) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", at.x(), at.y(), at.z());
}

/// "node 12 (1, 2, 0)" of the mesh.
std::string place_of_point(const FieldMesh& block, std::size_t point) {
  return fmt::format("node {} {}", block.node[point] + 1, position(block.points[point]));
}

/// "hex8 17 (1, 2, 0)": its number in the mesh's block of this type and the middle of its corners.
std::string place_of_cell(const FieldMesh& block, std::size_t cell) {
  std::size_t index = cell;
  for (const CellBlock& type : block.blocks) {
    if (index < static_cast<std::size_t>(type.count())) {
      Vec3 middle = Vec3::Zero();
      const auto corners = type[static_cast<int>(index)].first(static_cast<std::size_t>(info(type.cell).corners));
      for (const int corner : corners) middle += block.points[static_cast<std::size_t>(corner)] / static_cast<double>(corners.size());
      return fmt::format("{} {} {}", info(type.cell).name, block.cell[cell].index + 1, position(middle));
    }
    index -= static_cast<std::size_t>(type.count());
  }
  return "no cell";
}

bool fits(double value, FieldPrecision precision) {
  return std::isfinite(value) &&
         (precision == FieldPrecision::float64 || std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()));
}

std::optional<FieldTrouble> trouble_in(const FieldMesh& block, const std::vector<FieldValues>& fields, bool points,
                                       FieldPrecision precision) {
  for (const FieldValues& field : fields) {
    const std::size_t width = components(field.kind);
    assert(field.values.size() == width * (points ? block.points.size() : cells_in(block)) && "values for every point or cell");
    assert(std::count_if(fields.begin(), fields.end(), [&](const FieldValues& other) { return title(other) == title(field); }) == 1);
    const auto bad = std::find_if(field.values.begin(), field.values.end(), [&](double value) { return !fits(value, precision); });
    if (bad == field.values.end()) continue;
    const std::size_t at = static_cast<std::size_t>(bad - field.values.begin()) / width;
    const std::string place = points ? place_of_point(block, at) : place_of_cell(block, at);
    return FieldTrouble{fmt::format("field {} of block {} is {:g} at {}{}", in_quotes(title(field)), in_quotes(block.name), *bad, place,
                                    std::isfinite(*bad) ? ", too large for 32 bits" : "")};
  }
  return std::nullopt;
}

/// For each entry of `from` its tuple in `values`.
std::vector<double> spread(const std::vector<int>& from, FieldKind kind, std::span<const double> values) {
  const std::size_t width = components(kind);
  std::vector<double> result(from.size() * width, 0);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto tuple = values.subspan(static_cast<std::size_t>(from[i]) * width, width);
    std::copy(tuple.begin(), tuple.end(), result.begin() + static_cast<std::ptrdiff_t>(i * width));
  }
  return result;
}

/// One side of one face, before the faces are put in the order of types.
struct InterfaceFace {
  int surface, face, place, side;  // place: that of the face's first node; side: 0 lower, 1 upper
  CellId cell;
};

std::vector<InterfaceFace> faces_of(const Mesh& mesh, const std::vector<OpenedSurface>& surfaces) {
  std::vector<InterfaceFace> faces;
  int face = 0, place = 0;
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    for (const FacePair& pair : surfaces[s].faces) {
      faces.push_back({static_cast<int>(s), face, place, 0, pair.lower});
      faces.push_back({static_cast<int>(s), face++, place, 1, pair.upper});
      place += static_cast<int>(mesh.cell(pair.lower).size());
    }
  std::stable_sort(faces.begin(), faces.end(),
                   [&](const InterfaceFace& a, const InterfaceFace& b) { return mesh.type(a.cell) < mesh.type(b.cell); });
  return faces;
}

}  // namespace

FieldMesh field_mesh(const Mesh& mesh, std::string name, const std::vector<std::string>& groups, const Where& where) {
  if (groups.empty()) throw InputError(where, "groups", "at least one group of cells", "none");
  FieldMesh block;
  block.name = std::move(name);
  std::vector<std::vector<int>> group_of;  // of each cell of each block; -1: not wanted
  for (const CellBlock& type : mesh.blocks) group_of.emplace_back(type.count(), -1);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto group = mesh.groups.find(groups[g]);
    if (group == mesh.groups.end()) {
      std::vector<std::string> known;
      for (const auto& [each, cells] : mesh.groups) known.push_back(each);
      throw InputError(where, "groups", "a group of the mesh", in_quotes(groups[g]), nearest_name(groups[g], known));
    }
    if (group->second.cells.empty()) throw InputError(where, "groups", "a group of cells", "nodes alone in " + in_quotes(groups[g]));
    for (const CellId id : group->second.cells) {
      int& of = group_of[static_cast<std::size_t>(id.block)][static_cast<std::size_t>(id.index)];
      if (of < 0) of = static_cast<int>(g);
    }
  }
  std::vector<CellId> cells;
  CellMark mark{"group", {}, groups};
  for (std::size_t b = 0; b < group_of.size(); ++b)
    for (std::size_t i = 0; i < group_of[b].size(); ++i) {
      if (group_of[b][i] < 0) continue;
      cells.push_back({static_cast<int>(b), static_cast<int>(i)});
      mark.values.push_back(group_of[b][i]);
    }
  block.marks.push_back(std::move(mark));
  take_cells(block, mesh, cells);
  std::vector<int> point(mesh.nodes.size(), -1);
  for (const CellBlock& type : block.blocks)
    for (const int node : type.nodes) point[static_cast<std::size_t>(node)] = 0;
  for (std::size_t node = 0; node < point.size(); ++node) {
    if (point[node] < 0) continue;
    point[node] = static_cast<int>(block.points.size());
    block.points.push_back(mesh.nodes[node]);
    block.node.push_back(static_cast<int>(node));
  }
  for (CellBlock& type : block.blocks)
    for (int& node : type.nodes) node = point[static_cast<std::size_t>(node)];
  return block;
}

InterfaceMesh interface_mesh(const Mesh& mesh, std::string name, const std::vector<OpenedSurface>& surfaces) {
  InterfaceMesh result;
  FieldMesh& block = result.mesh;
  block.name = std::move(name);
  block.marks = {{"interface", {}, {}}, {"side", {}, {"lower", "upper"}}};
  for (const OpenedSurface& surface : surfaces) block.marks[0].meanings.push_back(surface.name);
  std::vector<CellId> cells;
  for (const InterfaceFace& each : faces_of(mesh, surfaces)) {
    cells.push_back(each.cell);
    result.face.push_back(each.face);
    block.marks[0].values.push_back(each.surface);
    block.marks[1].values.push_back(each.side);
    int place = each.place;
    for (const int node : mesh.cell(each.cell)) {
      result.place.push_back(place++);
      block.node.push_back(node);
      block.points.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
    }
  }
  take_cells(block, mesh, cells);
  int point = 0;
  for (CellBlock& type : block.blocks)
    for (int& node : type.nodes) node = point++;
  return result;
}

std::vector<double> at_points(const FieldMesh& block, FieldKind kind, std::span<const double> nodal, int stride, int given) {
  const std::size_t width = components(kind), kept = std::min(width, static_cast<std::size_t>(std::min(stride, given)));
  std::vector<double> result(block.node.size() * width, 0);
  for (std::size_t i = 0; i < block.node.size(); ++i) {
    const auto tuple = nodal.subspan(static_cast<std::size_t>(block.node[i]) * static_cast<std::size_t>(stride), kept);
    std::copy(tuple.begin(), tuple.end(), result.begin() + static_cast<std::ptrdiff_t>(i * width));
  }
  return result;
}

std::vector<double> at_points(const InterfaceMesh& block, FieldKind kind, std::span<const double> by_place) {
  return spread(block.place, kind, by_place);
}

std::vector<double> at_cells(const InterfaceMesh& block, FieldKind kind, std::span<const double> by_face) {
  return spread(block.face, kind, by_face);
}

std::optional<FieldTrouble> find_trouble(const std::vector<FieldMesh>& blocks, const FieldFrame& frame, FieldPrecision precision) {
  assert(frame.blocks.size() == blocks.size() && "fields of every block");
  if (!std::isfinite(frame.time)) return FieldTrouble{fmt::format("the time of a frame is {:g}", frame.time)};
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    auto trouble = trouble_in(blocks[b], frame.blocks[b].points, true, precision);
    if (!trouble) trouble = trouble_in(blocks[b], frame.blocks[b].cells, false, precision);
    if (trouble) return trouble;
  }
  return std::nullopt;
}

WriteFile into(ResultFolder& folder) {
  return [&folder](const std::string& name, std::string_view bytes) { folder.write(name, bytes); };
}

FieldSize size_per_frame(FieldFormat format, const std::vector<FieldMesh>& blocks, const FieldFrame& frame, FieldPrecision precision) {
  return format == FieldFormat::vtu ? vtu_size(blocks, frame, precision) : xdmf_size(blocks, frame, precision);
}

}  // namespace uplift
