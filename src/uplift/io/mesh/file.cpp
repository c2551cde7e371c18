#include "uplift/io/mesh/file.h"

#include <string_view>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/io/mesh/gmsh.h"
#include "uplift/io/mesh/med_file.h"

namespace uplift {
namespace {

constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";
constexpr const char* a_mesh_file = "a mesh file (Gmsh .msh or MED)";

}  // namespace

Mesh read_mesh(const std::string& path, const Where& where, const std::string& mesh, bool isolated) {
  require_file(path, where, "", a_mesh_file);
  const GmshSource source = GmshSource::of_file(path);
  std::string head;
  constexpr std::size_t shown = 20;
  source.append(head, 0, shown, source.size());
  if (head.starts_with(hdf5_signature)) return isolated ? read_med_file(path, mesh) : read_med_here(path, mesh);
  if (!is_gmsh(source)) throw InputError(where, "", a_mesh_file, escaped(path) + ", which begins with " + in_quotes(head));
  return read_gmsh(source);
}

}  // namespace uplift
