#include <fmt/format.h>

#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <limits>
#include <utility>

#include "uplift/io/fields/fields.h"
#include "uplift/io/fields/parts.h"
#include "uplift/io/text/base64.h"
#include "uplift/io/text/numbers.h"

// VTK's XML formats (VTK User's Guide, "XML File Formats"). Arrays stand inline, not compressed: base64 of a header (8 bytes: the number of
// bytes that follow) and the numbers, in one piece. Nothing is appended: ParaView of Debian 12 reads nothing from such files.
namespace uplift {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

constexpr std::string_view file_head =
    "<?xml version=\"1.0\"?>\n"
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
    "<UnstructuredGrid>\n<FieldData>\n";
constexpr std::string_view file_tail = "</PointData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
constexpr std::string_view collection_head =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
constexpr std::string_view collection_tail = "</Collection>\n</VTKFile>\n";

/// A text, or its length alone.
class Text {
 public:
  explicit Text(bool only_length) : only_length_(only_length) {}
  void add(std::string_view part) {
    length_ += part.size();
    if (!only_length_) text_ += part;
  }
  /// <DataArray> of tuples of `width` numbers, which `get` returns.
  template <class Number, class Get>
  void array(std::string_view name, std::size_t width, std::size_t tuples, const Get& get) {
    const std::size_t count = width * tuples, bytes = count * sizeof(Number);
    add(fmt::format(R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" NumberOfTuples="{}" format="binary">)", type_of(Number{}),
                    xml_text(name), width, tuples));
    length_ += base64_length(sizeof(std::uint64_t) + bytes);
    if (!only_length_) {
      const auto& numbers = get();
      assert(numbers.size() == count);
      const std::uint64_t header = bytes;
      std::string all(sizeof(header) + bytes, '\0');
      std::memcpy(all.data(), &header, sizeof(header));
      if (bytes > 0) std::memcpy(all.data() + sizeof(header), numbers.data(), bytes);
      append_base64(text_, all);
    }
    add("</DataArray>\n");
  }
  std::size_t length() const { return length_; }
  std::string take() { return std::move(text_); }

 private:
  static std::string_view type_of(float) { return "Float32"; }
  static std::string_view type_of(double) { return "Float64"; }
  static std::string_view type_of(int) { return "Int32"; }
  static std::string_view type_of(unsigned char) { return "UInt8"; }

  bool only_length_;
  std::size_t length_ = 0;
  std::string text_;
};

void write_fields(Text& text, const std::vector<FieldValues>& fields, std::size_t tuples, FieldPrecision precision) {
  for (const FieldValues& field : fields) {
    if (precision == FieldPrecision::float32)
      text.array<float>(title(field), components(field.kind), tuples, [&] { return as_float32(field.values); });
    else
      text.array<double>(title(field), components(field.kind), tuples, [&] { return as_float64(field.values); });
  }
}

void write_cells(Text& text, const FieldMesh& block) {
  std::vector<int> nodes, ends;
  std::vector<unsigned char> types;
  for (const CellBlock& type : block.blocks) {
    const std::vector<int> ordered = vtk_nodes(type);
    for (int cell = 1; cell <= type.count(); ++cell) ends.push_back(static_cast<int>(nodes.size()) + cell * info(type.cell).nodes);
    nodes.insert(nodes.end(), ordered.begin(), ordered.end());
    types.insert(types.end(), static_cast<std::size_t>(type.count()), static_cast<unsigned char>(info(type.cell).vtk));
  }
  assert(nodes.size() <= static_cast<std::size_t>(std::numeric_limits<int>::max()));
  text.add("<Cells>\n");
  text.array<int>(
      "connectivity", 1, nodes.size(), [&]() -> const auto& { return nodes; });
  text.array<int>(
      "offsets", 1, ends.size(), [&]() -> const auto& { return ends; });
  text.array<unsigned char>(
      "types", 1, types.size(), [&]() -> const auto& { return types; });
  text.add("</Cells>\n");
}

/// What marks mean, as a table; texts in quotes, quotes in them doubled (RFC 4180).
std::string meanings_text(const FieldMesh& block) {
  std::string text = "cell field,value,name\n";
  for (const CellMark& mark : block.marks)
    for (std::size_t value = 0; value < mark.meanings.size(); ++value) {
      text += fmt::format("{},{},\"", mark.name, value);
      for (const char c : mark.meanings[value]) text += c == '"' ? std::string("\"\"") : std::string(1, c);
      text += "\"\n";
    }
  return text;
}

/// From the end of <FieldData> to the beginning of <CellData>: the same in all frames.
void write_mesh(Text& text, const FieldMesh& block) {
  text.add(
      fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n", block.points.size(), cells_in(block)));
  text.array<double>("points [m]", 3, block.points.size(), [&] { return coordinates(block); });
  text.add("</Points>\n");
  write_cells(text, block);
  text.add("<CellData>\n");
  for (const CellMark& mark : block.marks)
    text.array<int>(
        mark.name, 1, cells_in(block), [&]() -> const auto& { return mark.values; });
}

/// The whole file; `mesh` adds what write_mesh() does.
template <class WriteMesh>
void write_file(Text& text, const FieldMesh& block, const BlockFields& fields, double time, FieldPrecision precision,
                const WriteMesh& mesh) {
  text.add(file_head);
  text.array<double>("TimeValue", 1, 1, [&] { return std::array{time}; });  // ParaView's name for the time [s] of a file
  mesh(text);
  write_fields(text, fields.cells, cells_in(block), precision);
  text.add("</CellData>\n<PointData>\n");
  write_fields(text, fields.points, block.points.size(), precision);
  text.add(file_tail);
}

/// "fields/soil_000012.vtu", relative to the folder of the list.
std::string file_name(std::string_view folder, std::string_view block, int frame) {
  return fmt::format("{}/{}_{:06}.vtu", folder, block, frame);
}

std::string list_entry(const FieldMesh& block, std::size_t part, double time, std::string_view file) {
  std::string when;
  append_exact(when, time);
  return fmt::format(R"(<DataSet timestep="{}" group="" part="{}" name="{}" file="{}"/>)", when, part, xml_text(block.name),
                     xml_text(file)) +
         '\n';
}

/// What comes after the last "/".
std::string last_part(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

}  // namespace

VtuWriter::VtuWriter(std::string stem, std::vector<FieldMesh> blocks, FieldPrecision precision, WriteFile write)
    : stem_(std::move(stem)), blocks_(std::move(blocks)), files_(plain_names(blocks_)), precision_(precision), write_(std::move(write)) {
  for (const FieldMesh& block : blocks_) {
    Text text(false);
    write_mesh(text, block);
    mesh_texts_.push_back(text.take());
  }
}

std::optional<FieldTrouble> VtuWriter::write(const FieldFrame& frame) {
  if (auto trouble = find_trouble(blocks_, frame, precision_)) return trouble;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Text text(false);
    write_file(text, blocks_[b], frame.blocks[b], frame.time, precision_, [&](Text& to) { to.add(mesh_texts_[b]); });
    write_(file_name(stem_, files_[b], frames_), text.take());
    list_.push_back({frame.time, list_entry(blocks_[b], b, frame.time, file_name(last_part(stem_), files_[b], frames_))});
  }
  ++frames_;
  return std::nullopt;
}

void VtuWriter::finish() {
  for (std::size_t b = 0; b < blocks_.size(); ++b) write_(fmt::format("{}/{}_names.csv", stem_, files_[b]), meanings_text(blocks_[b]));
  write_(stem_ + ".pvd", std::string(collection_head) + in_order_of_time(list_) + std::string(collection_tail));
}

FieldSize vtu_size(const std::vector<FieldMesh>& blocks, const FieldFrame& frame, FieldPrecision precision) {
  FieldSize size{static_cast<std::int64_t>(collection_head.size() + collection_tail.size()), 0};
  const std::vector<std::string> files = plain_names(blocks);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    Text text(true);
    write_file(text, blocks[b], frame.blocks[b], frame.time, precision, [&](Text& to) { write_mesh(to, blocks[b]); });
    const std::string entry = list_entry(blocks[b], b, frame.time, file_name("fields", files[b], 0));
    size.once += static_cast<std::int64_t>(meanings_text(blocks[b]).size());
    size.per_frame += static_cast<std::int64_t>(text.length() + entry.size());
  }
  return size;
}

}  // namespace uplift
