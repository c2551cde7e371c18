#include "uplift/mesh/absent_group.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/text.h"

namespace uplift {

InputError absent_group(const Mesh& mesh, const std::string& name, const Where& where, const std::string& path, const std::string& wanted) {
  if (std::ranges::find(mesh.emptied, name) != mesh.emptied.end())
    return {where, path, wanted, fmt::format("the group {}, of which the planes of interface.cut leave nothing", in_quotes(name))};
  constexpr std::size_t most = 12;
  std::vector<std::string> names;
  for (const auto& [other, group] : mesh.groups) names.push_back(other);
  const std::string nearest = nearest_name(name, names);
  std::string found = fmt::format("no group {} in the mesh", in_quotes(name));
  if (names.empty()) found += ", which has no groups: name them before it is written (physical groups of Gmsh, groups of Salome)";
  if (nearest.empty() && !names.empty()) {
    found += ", whose groups are ";
    for (std::size_t i = 0; i < names.size() && i < most; ++i) found += (i > 0 ? ", " : "") + in_quotes(names[i]);
    if (names.size() > most) found += fmt::format(" and {} more", names.size() - most);
  }
  return {where, path, wanted, found, nearest};
}

}  // namespace uplift
