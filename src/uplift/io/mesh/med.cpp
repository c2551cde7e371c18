#include "uplift/io/mesh/med.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "uplift/base/text.h"
#include "uplift/io/mesh/draft.h"

// MED: "Modélisation et Échange de Données", file format 3 and 4 (documentation of the library med-fichier, "Format de fichier"):
//   /ENS_MAA/MESH/STEP/NOE/COO      coordinates: all x, all y, all z        .../NOE/FAM      family of each node
//   /ENS_MAA/MESH/STEP/MAI/TYPE/NOD first nodes of all cells, second nodes, ..., counted from 1        .../TYPE/FAM
//   /FAS/MESH/ELEME|NOEUD/FAMILY    attribute NUM; GRO/NOM: names of its groups
// Corners of volumes run the other way round than in VTK; edges are counted by corners as in VTK: a MED volume is the mirror image of
// VTK's. The faces of H27 have an order of their own: bottom, the four sides around, top.
namespace uplift {
namespace {

struct MedType {
  std::string_view name;
  Cell cell;
};
constexpr std::array<MedType, num_cell_types> med_types{{{"PO1", Cell::point},
                                                         {"SE2", Cell::line2},
                                                         {"SE3", Cell::line3},
                                                         {"TR3", Cell::tri3},
                                                         {"TR6", Cell::tri6},
                                                         {"QU4", Cell::quad4},
                                                         {"QU8", Cell::quad8},
                                                         {"QU9", Cell::quad9},
                                                         {"TE4", Cell::tet4},
                                                         {"T10", Cell::tet10},
                                                         {"PE6", Cell::wedge6},
                                                         {"P15", Cell::wedge15},
                                                         {"HE8", Cell::hex8},
                                                         {"H20", Cell::hex20},
                                                         {"H27", Cell::hex27}}};

constexpr int med_hex27[] = {0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17, 21, 23, 24, 22, 20, 25, 26};

/// Node k of a cell here is MED's node nodes_in_med(cell)[k]; empty: the same order.
std::span<const int> nodes_in_med(Cell cell) {
  if (info(cell).dimension < 3) return {};
  return cell == Cell::hex27 ? std::span<const int>(med_hex27) : mirrored_nodes(cell);
}

struct OtherMedType {
  std::string_view name, meaning;
};
constexpr OtherMedType other_med_types[] = {{"SE4", "4-node line"},     {"TR7", "7-node triangle"},   {"PY5", "5-node pyramid"},
                                            {"P13", "13-node pyramid"}, {"P18", "18-node wedge"},     {"O12", "12-node prism"},
                                            {"POG", "polygon"},         {"PO2", "quadratic polygon"}, {"POE", "polyhedron"}};

class MedMesh {
 public:
  MedMesh(const Hdf5Reader& file, const std::string& name)
      : file_(file), mesh_("/ENS_MAA/" + name), families_("/FAS/" + name), step_(find_step()) {}

  Mesh read() {
    if (file_.integer_attribute(mesh_, "TYP").value_or(0) != 0) file_.fail(mesh_, "an unstructured mesh (attribute \"TYP\" 0)", "a grid");
    read_nodes();
    const std::string cells = step_ + "/MAI";
    if (file_.has(cells)) {
      const Families families = read_families("ELEME");
      for (const std::string& type : file_.children(cells)) read_cells(fmt::format("{}/{}", cells, type), type, families);
    }
    std::vector<DraftGroup> groups;
    for (auto& [key, group] : groups_) groups.push_back(std::move(group));
    return finish_mesh(std::move(parts_), std::move(groups), {file_.file(), 0});
  }

 private:
  using Families = std::map<int, std::vector<std::string>>;  // names of groups

  std::string find_step() const {
    const std::string without_time = "-0000000000000000001-0000000000000000001";
    const auto steps = file_.children(mesh_);
    for (const std::string& step : steps)
      if (steps.size() == 1 || step == without_time) return fmt::format("{}/{}", mesh_, step);
    file_.fail(mesh_, "a mesh that does not change in time", std::to_string(steps.size()) + " steps");
  }

  /// The count that the file states must be the one that its data have.
  void check_count(const std::string& data, std::size_t count) const {
    const auto stated = file_.integer_attribute(data, "NBR");
    if (stated && (*stated < 0 || static_cast<std::uint64_t>(*stated) != count))
      file_.fail(data, std::to_string(*stated) + " items (attribute \"NBR\")", std::to_string(count));
  }

  void read_nodes() {
    const std::string path = step_ + "/NOE/COO";
    const auto space = file_.integer_attribute(mesh_, "ESP").value_or(0);
    if (space < 1 || space > 3) file_.fail(mesh_, "1, 2 or 3 coordinates (attribute \"ESP\")", std::to_string(space));
    const std::vector<double> x = file_.numbers(path);
    const auto directions = static_cast<std::size_t>(space), count = x.size() / directions;
    if (x.size() % directions || count >= INT32_MAX)
      file_.fail(path, std::to_string(space) + " coordinates for each node", std::to_string(x.size()) + " numbers");
    check_count(path, count);
    parts_.nodes.assign(count, Vec3::Zero());
    for (std::size_t k = 0; k < directions; ++k)
      for (std::size_t i = 0; i < count; ++i) {
        const double value = x[k * count + i];
        if (!std::isfinite(value)) file_.fail(path, "finite coordinates", shortest(value) + " at node " + std::to_string(i + 1));
        parts_.nodes[i][static_cast<Index>(k)] = value;
      }
    const std::string family_path = step_ + "/NOE/FAM";
    if (!file_.has(family_path)) return;
    const Families families = read_families("NOEUD");
    const std::vector<int> family = read_family_numbers(family_path, count, families);
    for (std::size_t i = 0; i < family.size(); ++i)
      for (DraftGroup* group : groups_of(family[i], families, DraftGroup::of_nodes)) group->nodes.push_back(static_cast<int>(i));
  }

  Families read_families(const std::string& kind) const {
    Families families;
    const std::string folder = families_ + "/" + kind;
    if (!file_.has(folder)) return families;
    for (const std::string& name : file_.children(folder)) {
      const std::string family = fmt::format("{}/{}", folder, name), names = family + "/GRO/NOM";
      const auto number = file_.integer_attribute(family, "NUM");
      if (!number || *number < INT32_MIN || *number > INT32_MAX) file_.fail(family, "a number of the family (attribute \"NUM\")", "none");
      std::vector<std::string>& groups = families[static_cast<int>(*number)];
      if (!file_.has(names)) continue;
      for (const std::string& text : file_.texts(names)) {
        const std::string group = name_as_utf8(text);
        if (!group.empty()) groups.push_back(group);
      }
      if (groups.size() > most_groups)
        file_.fail(names, fmt::format("at most {} groups for a family", most_groups), std::to_string(groups.size()));
    }
    return families;
  }

  std::vector<int> read_family_numbers(const std::string& path, std::size_t count, const Families& families) const {
    std::vector<int> numbers = file_.integers(path);
    if (numbers.size() != count) file_.fail(path, std::to_string(count) + " families, one for each item", std::to_string(numbers.size()));
    int known = 0;  // neighbours mostly share their family; family 0 has no groups and need not be described
    for (const int number : numbers) {
      if (number == known) continue;
      if (number != 0 && !families.contains(number)) file_.fail(path, "a family of " + families_, "family " + std::to_string(number));
      known = number;
    }
    return numbers;
  }

  /// Groups of a family, kept for the next item of the same family.
  const std::vector<DraftGroup*>& groups_of(int family, const Families& families, int dimension) {
    const auto [at, fresh] = found_.try_emplace({dimension, family});
    if (!fresh) return at->second;
    const auto names = families.find(family);
    if (names == families.end()) return at->second;
    for (const std::string& name : names->second) {
      DraftGroup& group = groups_[{name, dimension}];
      group.name = name;
      group.dimension = dimension;
      at->second.push_back(&group);
    }
    return at->second;
  }

  Cell cell_type(const std::string& path, const std::string& name) const {
    for (const MedType& type : med_types)
      if (type.name == name) return type.cell;
    std::string found = in_quotes(name);
    for (const OtherMedType& other : other_med_types)
      if (other.name == name) found = fmt::format("a {} ({})", other.meaning, in_quotes(name));
    std::vector<std::string> names;
    for (const MedType& type : med_types) names.emplace_back(type.name);
    file_.fail(path, "cells " + listed(names), found);
  }

  void read_cells(const std::string& path, const std::string& name, const Families& families) {
    const CellInfo& type = info(cell_type(path, name));
    const auto nodes_each = static_cast<std::size_t>(type.nodes);
    const std::vector<int> nodes = file_.integers(path + "/NOD");
    const std::size_t count = nodes.size() / nodes_each;
    if (nodes.size() % nodes_each || count >= INT32_MAX)
      file_.fail(path + "/NOD", std::to_string(type.nodes) + " nodes for each cell", std::to_string(nodes.size()) + " numbers");
    if (count == 0) return;
    check_count(path + "/NOD", count);
    place_nodes(path, type, nodes, count);
    if (!file_.has(path + "/FAM")) return;
    const int block = parts_.find_block(type.cell);
    const std::vector<int> family = read_family_numbers(path + "/FAM", count, families);
    for (std::size_t i = 0; i < count; ++i)
      for (DraftGroup* group : groups_of(family[i], families, type.dimension)) group->cells.push_back({block, static_cast<int>(i)});
  }

  void place_nodes(const std::string& path, const CellInfo& type, const std::vector<int>& from, std::size_t count) {
    const auto n = static_cast<std::size_t>(type.nodes);
    const auto order = nodes_in_med(type.cell);
    std::vector<int>& to = parts_.block(type.cell).nodes;
    to.resize(from.size());
    for (std::size_t k = 0; k < n; ++k) {
      const int* column = from.data() + (order.empty() ? k : static_cast<std::size_t>(order[k])) * count;
      for (std::size_t i = 0; i < count; ++i) {
        if (column[i] < 1 || static_cast<std::size_t>(column[i]) > parts_.nodes.size())
          file_.fail(path + "/NOD", "nodes from 1 to " + std::to_string(parts_.nodes.size()),
                     std::to_string(column[i]) + " in cell " + std::to_string(i + 1));
        to[i * n + k] = column[i] - 1;
      }
    }
    number_cells(path, type.cell, count);
  }

  /// The numbers that the file gives its cells; without any they count from 1 within their type.
  void number_cells(const std::string& path, Cell cell, std::size_t count) {
    std::vector<std::int64_t>& numbers = parts_.block(cell).file_number;
    const std::string stated = path + "/NUM";
    if (file_.has(stated)) {
      const std::vector<int> read = file_.integers(stated);
      if (read.size() != count) file_.fail(stated, fmt::format("{} numbers, one for each cell", count), std::to_string(read.size()));
      numbers.assign(read.begin(), read.end());
    } else {
      numbers.resize(count);
      std::iota(numbers.begin(), numbers.end(), 1);
    }
  }

  const Hdf5Reader& file_;
  std::string mesh_, families_, step_;
  Mesh parts_;
  std::map<std::pair<std::string, int>, DraftGroup> groups_;
  std::map<std::pair<int, int>, std::vector<DraftGroup*>> found_;  // of a dimension and family
};

}  // namespace

Mesh read_med(const Hdf5Reader& file, const std::string& mesh) {
  if (!file.has("/INFOS_GENERALES") || !file.has("/ENS_MAA"))
    file.fail("", "a MED file with a mesh (groups /INFOS_GENERALES and /ENS_MAA)", "another HDF5 file");
  const auto version = file.integer_attribute("/INFOS_GENERALES", "MAJ").value_or(0);
  if (version < 3) file.fail("/INFOS_GENERALES", "MED format 3 or later", std::to_string(version));
  const auto meshes = file.children("/ENS_MAA");
  std::vector<std::string> quoted;
  for (const std::string& name : meshes) quoted.push_back(in_quotes(name));
  if (mesh.empty() && meshes.size() != 1)
    file.fail("/ENS_MAA", "one mesh, or the name of the one to take", meshes.empty() ? "none" : listed(quoted));
  const std::string& name = mesh.empty() ? meshes[0] : mesh;
  for (const std::string& known : meshes)
    if (known == name) return MedMesh(file, name).read();
  throw InputError({file.file(), 0}, "/ENS_MAA", "one of the meshes " + listed(quoted), in_quotes(name), nearest_name(name, meshes));
}

}  // namespace uplift
