#include "uplift/io/mesh/file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/io/mesh/gmsh.h"
#include "uplift/io/mesh/med_file.h"

namespace uplift {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";
constexpr const char* a_mesh_file = "a mesh file (Gmsh .msh or MED)";

/// The first `most` bytes of a file.
std::string beginning(const fs::path& path, std::uintmax_t most, const Where& where) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(most), '\0');
  if (!in || (most > 0 && !in.read(bytes.data(), static_cast<std::streamsize>(most))))
    throw InputError(where, "", "a file that can be read", escaped(path.string()));
  return bytes;
}

}  // namespace

Mesh read_mesh(const std::string& path, const Where& where, const std::string& mesh, bool isolated) {
  require_file(path, where, "", a_mesh_file);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw InputError(where, "", "a file that can be read", escaped(path) + ": " + error.message());
  if (beginning(path, std::min<std::uintmax_t>(size, hdf5_signature.size()), where) == hdf5_signature)
    return isolated ? read_med_file(path, mesh) : read_med_here(path, mesh);
  const std::string bytes = beginning(path, size, where);
  if (!is_gmsh(bytes)) throw InputError(where, "", a_mesh_file, escaped(path) + ", which begins with " + in_quotes(bytes.substr(0, 20)));
  return read_gmsh(bytes, path);
}

}  // namespace uplift
