#include "uplift/io/mesh/draft.h"

#include <algorithm>
#include <map>
#include <utility>

#include "uplift/base/text.h"

namespace uplift {
namespace {

// Corners first, then the middles of the edges and faces where the mirrored corners put them; node 0 stays.
constexpr int tri3[] = {0, 2, 1};
constexpr int tri6[] = {0, 2, 1, 5, 4, 3};
constexpr int quad4[] = {0, 3, 2, 1};
constexpr int quad9[] = {0, 3, 2, 1, 7, 6, 5, 4, 8};  // its first eight: quad8
constexpr int mirrored_tet10[] = {0, 2, 1, 3, 6, 5, 4, 7, 9, 8};
constexpr int mirrored_wedge15[] = {0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13};
constexpr int mirrored_hex27[] = {0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17, 22, 23, 20, 21, 24, 25, 26};

void drop_unused_nodes(Mesh& mesh, std::vector<DraftGroup>& groups) {
  std::vector<int> number(mesh.nodes.size(), 0);
  const auto use = [&](const std::vector<int>& nodes) {
    for (const int node : nodes) number[static_cast<std::size_t>(node)] = 1;
  };
  for (const CellBlock& block : mesh.blocks) use(block.nodes);
  for (const DraftGroup& group : groups) use(group.nodes);
  int kept = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == 0) continue;
    number[i] = kept;
    mesh.nodes[static_cast<std::size_t>(kept++)] = mesh.nodes[i];
  }
  if (static_cast<std::size_t>(kept) == mesh.nodes.size()) return;
  mesh.nodes.resize(static_cast<std::size_t>(kept));
  mesh.nodes.shrink_to_fit();
  const auto renumber = [&](std::vector<int>& nodes) {
    for (int& node : nodes) node = number[static_cast<std::size_t>(node)];
  };
  for (CellBlock& block : mesh.blocks) renumber(block.nodes);
  for (DraftGroup& group : groups) renumber(group.nodes);
}

int dimension_of(const Mesh& mesh) {
  for (const CellBlock& block : mesh.blocks)
    if (info(block.cell).dimension == 3) return 3;
  const double z = mesh.nodes[0].z();
  return std::all_of(mesh.nodes.begin(), mesh.nodes.end(), [&](const Vec3& x) { return x.z() == z; }) ? 2 : 3;
}

void turn_cells(Mesh& mesh) {
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    CellBlock& block = mesh.blocks[static_cast<std::size_t>(b)];
    const CellInfo& type = info(block.cell);
    if (type.dimension != mesh.dimension) continue;
    const auto order = mirrored_nodes(block.cell);
    for (int i = 0; i < block.count(); ++i) {
      if (!(signed_size(mesh, {b, i}) < 0)) continue;
      const std::vector<int> old(block[i].begin(), block[i].end());
      const auto begin = static_cast<std::size_t>(i) * old.size();
      for (std::size_t k = 0; k < old.size(); ++k) block.nodes[begin + k] = old[static_cast<std::size_t>(order[k])];
    }
  }
}

template <class Item>
void sort_each_once(std::vector<Item>& items) {
  if (!std::is_sorted(items.begin(), items.end())) std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

using Kinds = std::map<int, DraftGroup>;  // by dimension

std::map<std::string, Kinds> merge(std::vector<DraftGroup> groups) {
  std::map<std::string, Kinds> merged;
  for (DraftGroup& group : groups) {
    const auto [at, fresh] = merged[group.name].try_emplace(group.dimension, std::move(group));
    if (fresh) continue;
    at->second.cells.insert(at->second.cells.end(), group.cells.begin(), group.cells.end());
    at->second.nodes.insert(at->second.nodes.end(), group.nodes.begin(), group.nodes.end());
  }
  return merged;
}

void name_groups(Mesh& mesh, std::vector<DraftGroup> groups, const Where& where) {
  for (auto& [name, kinds] : merge(std::move(groups))) {
    const std::size_t of_cells = kinds.size() - kinds.count(DraftGroup::of_nodes);
    for (auto& [dimension, draft] : kinds) {
      std::string own = name;
      if (dimension == DraftGroup::of_nodes && of_cells > 0) own += "_nodes";
      if (dimension != DraftGroup::of_nodes && of_cells > 1) own += "_" + std::to_string(dimension) + "d";
      sort_each_once(draft.cells);
      sort_each_once(draft.nodes);
      const bool fresh = mesh.groups.try_emplace(own, Group{std::max(dimension, 0), std::move(draft.cells), std::move(draft.nodes)}).second;
      if (!fresh) throw InputError(where, "group " + in_quotes(name), "a name that is used once", "another group " + in_quotes(own));
    }
  }
}

}  // namespace

std::span<const int> mirrored_nodes(Cell cell) {
  switch (cell) {
    case Cell::point:
    case Cell::line2:
    case Cell::line3:
      return {};
    case Cell::tri3:
      return tri3;
    case Cell::tri6:
      return tri6;
    case Cell::quad4:
      return quad4;
    case Cell::quad8:
      return std::span(quad9).first(8);
    case Cell::quad9:
      return quad9;
    case Cell::tet4:
      return std::span(mirrored_tet10).first(4);
    case Cell::tet10:
      return mirrored_tet10;
    case Cell::wedge6:
      return std::span(mirrored_wedge15).first(6);
    case Cell::wedge15:
      return mirrored_wedge15;
    case Cell::hex8:
      return std::span(mirrored_hex27).first(8);
    case Cell::hex20:
      return std::span(mirrored_hex27).first(20);
    case Cell::hex27:
      return mirrored_hex27;
  }
  return {};
}

std::string name_as_utf8(std::string_view text) {
  text = trim(text);
  if (!invalid_utf8(text)) return std::string(text);
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      out += c;
    } else {
      out += static_cast<char>(0xC0 | (byte >> 6));
      out += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return out;
}

Mesh finish_mesh(Mesh parts, std::vector<DraftGroup> groups, const Where& where) {
  std::size_t cells = 0;
  for (const CellBlock& block : parts.blocks) cells += block.nodes.size();
  if (cells == 0) throw InputError(where, "", "a mesh with cells", "none");
  drop_unused_nodes(parts, groups);
  parts.dimension = dimension_of(parts);
  turn_cells(parts);
  parts.groups.clear();
  name_groups(parts, std::move(groups), where);
  return parts;
}

}  // namespace uplift
