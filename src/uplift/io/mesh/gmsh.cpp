#include "uplift/io/mesh/gmsh.h"

#include <algorithm>
#include <charconv>

#include "uplift/base/text.h"
#include "uplift/io/mesh/gmsh_parts.h"

namespace uplift {
namespace {

struct Format {
  bool four = false, binary = false;
};

class GmshFile {
 public:
  explicit GmshFile(const GmshSource& source) : source_(source), sections_(gmsh_sections(source)) {}

  Mesh read() {
    format_ = read_format();
    read_names();
    const bool parametric = !format_.four && find("ParametricNodes");
    const GmshCursor at = need(parametric ? "ParametricNodes" : "Nodes");
    GmshNodeList list = format_.four ? read_gmsh_nodes_4(at) : read_gmsh_nodes_2(at, parametric);
    const GmshNodes nodes(list.tags, at);
    Mesh mesh;
    mesh.nodes = std::move(list.nodes);
    list.tags = {};
    if (format_.four)
      read_gmsh_elements_4(need("Elements"), nodes, read_entities(), groups_, mesh);
    else
      read_gmsh_elements_2(need("Elements"), nodes, groups_, mesh);
    return finish_mesh(std::move(mesh), std::move(groups_.groups()), {source_.file(), 0});
  }

 private:
  const GmshSection* find(std::string_view name) const {
    const GmshSection* found = nullptr;
    for (const GmshSection& section : sections_) {
      if (section.name != name) continue;
      if (found) GmshCursor(source_, section, false).fail("one section $" + std::string(name), "a second one");
      found = &section;
    }
    return found;
  }
  const GmshSection& need_section(std::string_view name) const {
    if (const GmshSection* found = find(name)) return *found;
    std::vector<std::string> names;
    constexpr std::size_t enough = 10;
    for (const GmshSection& section : sections_)
      if (names.size() < enough) names.emplace_back("$" + section.name);
    throw InputError({source_.file(), 0}, "", "a section $" + std::string(name), names.empty() ? "none" : "only " + listed(names));
  }
  GmshCursor need(std::string_view name) const { return {source_, need_section(name), format_.binary}; }

  Format read_format() const {
    if (find("NOD"))
      throw InputError({source_.file(), 1}, "", "format 4.1 or 2.2 (Gmsh: Save As, or -format msh41)",
                       "format 1, which has no named groups");
    GmshCursor at(source_, need_section("MeshFormat"), false);
    const Where place = at.where();
    const std::string version = at.word("the version of the format");
    Format format;
    format.four = version == "4.1";
    if (!format.four && version != "2" && version != "2.0" && version != "2.1" && version != "2.2")
      throw InputError(place, "$MeshFormat", "format 4.1 or 2.2 (Gmsh: Save As, or -format msh41)", "version " + in_quotes(version));
    const int kind = at.integer("0 for text, 1 for binary"), bytes = at.integer("the size of numbers");
    if (kind != 0 && kind != 1) at.fail("0 for text or 1 for binary", std::to_string(kind));
    if (bytes != 8) at.fail("numbers of 8 bytes", std::to_string(bytes));
    format.binary = kind == 1;
    if (format.binary && !format.four)
      at.fail("format 4.1, or format 2.2 as text (Gmsh: Save As, or -format msh41)", "format 2.2 in binary");
    at.end_line();
    if (format.binary) read_byte_order(at);
    at.finish("$EndMeshFormat");
    return format;
  }

  /// A binary file has the number 1 here, in 4 bytes.
  static void read_byte_order(GmshCursor& at) {
    const std::uint32_t one = at.raw_bytes("the number 1, which tells the order of bytes");
    if (one == 0x01000000)
      at.fail("the order of bytes of this machine (Gmsh: Save As text, or -format msh41 without -bin)", "the other one");
    if (one != 1) at.fail("the number 1 in 4 bytes, which tells the order of bytes", std::to_string(one));
  }

  void read_names() {
    const GmshSection* section = find("PhysicalNames");
    if (!section) return;
    GmshCursor at(source_, *section, false);  // text in binary files too
    for (auto left = at.count("a number of names", 8, 8); left > 0; --left) {
      const int dimension = at.integer("a dimension"), tag = at.integer("a tag");
      if (dimension < 0 || dimension > 3) at.fail("a dimension from 0 to 3", std::to_string(dimension));
      groups_.name(dimension, tag, name_as_utf8(at.quoted("a name")));
    }
    at.finish("$EndPhysicalNames after the last name");
  }

  /// A partitioned file repeats the entities with tags of their own, and its cells refer to those.
  GmshEntities read_entities() {
    if (find("PartitionedEntities")) return read_gmsh_entities(need("PartitionedEntities"), true, groups_);
    return find("Entities") ? read_gmsh_entities(need("Entities"), false, groups_) : GmshEntities{};
  }

  const GmshSource& source_;
  std::vector<GmshSection> sections_;
  Format format_;
  GmshGroups groups_;
};

}  // namespace

bool is_gmsh(const GmshSource& source) {
  constexpr std::size_t looked_at = 4096;  // comments may come first
  std::string head;
  source.append(head, 0, looked_at, source.size());
  const std::string_view first = trim(head);
  return first.starts_with("$MeshFormat") || first.starts_with("$NOD") || first.starts_with("$Comments") ||
         head.find("\n$MeshFormat") != head.npos;
}

Mesh read_gmsh(const GmshSource& source) {
  return GmshFile(source).read();
}

Mesh read_gmsh(std::string_view bytes, const std::string& file) {
  return read_gmsh(GmshSource::of_bytes(bytes, file));
}

}  // namespace uplift
