#include <fmt/format.h>

#include <array>
#include <utility>

#include "uplift/io/fields/fields.h"
#include "uplift/io/fields/parts.h"
#include "uplift/io/text/numbers.h"

// XDMF (xdmf.org, "XDMF Model and Format"), version 2, which all readers know. Chosen so that the three readers of ParaView 5.11 agree:
// - a grid for each type of cell: in topologies of mixed types one reader takes 24 nodes for a brick of 27;
// - tensors are called "Matrix" of 6 columns and arrive as in VTU files: "Tensor6" is xx xy xz yy yz zz for one reader, while the others
//   keep the columns as they are, which VTK takes for xx yy zz xy yz xz;
// - the data file is named with "./", else one of them looks for it in the working folder of the process.
// In the data file: /mesh/<block>/points, /mesh/<block>/<type>/nodes and marks, whose meanings are attributes ("group 0") of
// /mesh/<block>; /frames/000000/<block>/points/<field> and /frames/000000/<block>/<type>/<field>, with the time [s] as an attribute of the
// frame and the unit as one of the field.
namespace uplift {
namespace {

constexpr std::string_view domain_head =
    "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
    "<Grid Name=\"frames\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
constexpr std::string_view domain_tail = "</Grid>\n</Domain>\n</Xdmf>\n";

/// The long names: the only ones that both readers know ("Hex_27" stops one, "Tri_6" the other).
std::string_view topology_name(Cell cell) {
  constexpr std::array<std::string_view, num_cell_types> names{
      "Polyvertex",  "Polyline",       "Edge_3", "Triangle", "Triangle_6", "Quadrilateral", "Quadrilateral_8", "Quadrilateral_9",
      "Tetrahedron", "Tetrahedron_10", "Wedge",  "Wedge_15", "Hexahedron", "Hexahedron_20", "Hexahedron_27"};
  return names[static_cast<std::size_t>(cell)];
}

std::string mesh_path(const std::string& block) {
  return "/mesh/" + block;
}
std::string frame_path(int frame, const std::string& block) {
  return fmt::format("/frames/{:06}/{}", frame, block);
}

std::vector<std::string> names_of(const std::vector<FieldValues>& fields) {
  std::vector<std::string> names;
  for (const FieldValues& field : fields) names.push_back(field.name);
  return plain_names(names);
}

std::vector<std::string> names_of(const std::vector<CellMark>& marks) {
  std::vector<std::string> names{"nodes"};  // taken
  for (const CellMark& mark : marks) names.push_back(mark.name);
  names = plain_names(names);
  names.erase(names.begin());
  return names;
}

/// <DataItem>: a data set of rows.
std::string data_item(const std::string& file, const std::string& path, std::size_t rows, std::size_t columns, std::string_view type,
                      int bytes) {
  return fmt::format(R"(<DataItem Dimensions="{}{}" NumberType="{}" Precision="{}" Format="HDF">{}:{}</DataItem>)", rows,
                     columns > 1 ? fmt::format(" {}", columns) : "", type, bytes, xml_text(file), path) +
         '\n';
}

std::string attribute(std::string_view name, FieldKind kind, bool points, const std::string& item) {
  const std::string_view type = kind == FieldKind::scalar ? "Scalar" : kind == FieldKind::vector ? "Vector" : "Matrix";
  return fmt::format(R"(<Attribute Name="{}" AttributeType="{}" Center="{}">)", xml_text(name), type, points ? "Node" : "Cell") + item +
         "</Attribute>\n";
}

std::string attributes(const std::string& file, const std::string& folder, const std::vector<FieldValues>& fields, std::size_t rows,
                       bool points, FieldPrecision precision) {
  const int bytes = precision == FieldPrecision::float32 ? 4 : 8;
  const std::vector<std::string> names = names_of(fields);
  std::string text;
  for (std::size_t f = 0; f < fields.size(); ++f)
    text += attribute(title(fields[f]), fields[f].kind, points,
                      data_item(file, folder + "/" + names[f], rows, components(fields[f].kind), "Float", bytes));
  return text;
}

/// Grids of one block at one frame: one for each type of cell, all with the block's points.
std::string block_text(const std::string& file, const std::string& name, const FieldMesh& block, const BlockFields& fields, int frame,
                       FieldPrecision precision) {
  const std::string mesh = mesh_path(name), values = frame_path(frame, name);
  const std::vector<std::string> marks = names_of(block.marks);
  std::string text;
  for (const CellBlock& type : block.blocks) {
    const std::string_view cell = info(type.cell).name;
    const auto count = static_cast<std::size_t>(type.count()), width = static_cast<std::size_t>(info(type.cell).nodes);
    text += fmt::format("<Grid Name=\"{} {}\" GridType=\"Uniform\">\n", xml_text(block.name), cell);
    text +=
        fmt::format(R"(<Topology TopologyType="{}" NodesPerElement="{}" NumberOfElements="{}">)", topology_name(type.cell), width, count);
    text +=
        data_item(file, fmt::format("{}/{}/nodes", mesh, cell), count, width, "Int", 4) + "</Topology>\n<Geometry GeometryType=\"XYZ\">";
    text += data_item(file, mesh + "/points", block.points.size(), 3, "Float", 8) + "</Geometry>\n";
    for (std::size_t m = 0; m < marks.size(); ++m)
      text += attribute(block.marks[m].name, FieldKind::scalar, false,
                        data_item(file, fmt::format("{}/{}/{}", mesh, cell, marks[m]), count, 1, "Int", 4));
    text += attributes(file, values + "/points", fields.points, block.points.size(), true, precision);
    text += attributes(file, fmt::format("{}/{}", values, cell), fields.cells, count, false, precision) + "</Grid>\n";
  }
  return text;
}

std::string frame_text(const std::string& file, const std::vector<std::string>& names, const std::vector<FieldMesh>& blocks,
                       const FieldFrame& frame, int number, FieldPrecision precision) {
  std::string when;
  append_exact(when, frame.time);
  std::string text =
      fmt::format("<Grid Name=\"frame {}\" GridType=\"Collection\" CollectionType=\"Spatial\">\n<Time Value=\"{}\"/>\n", number, when);
  for (std::size_t b = 0; b < blocks.size(); ++b) text += block_text(file, names[b], blocks[b], frame.blocks[b], number, precision);
  return text + "</Grid>\n";
}

std::vector<std::int64_t> shape_of(std::size_t rows, std::size_t columns) {
  std::vector<std::int64_t> shape{static_cast<std::int64_t>(rows)};
  if (columns > 1) shape.push_back(static_cast<std::int64_t>(columns));
  return shape;
}

void write_mesh(Hdf5Writer& data, const std::string& name, const FieldMesh& block) {
  const std::string folder = mesh_path(name);
  data.numbers(folder + "/points", coordinates(block), shape_of(block.points.size(), 3));
  data.attribute(folder + "/points", "unit", "m");
  const std::vector<std::string> marks = names_of(block.marks);
  std::size_t first = 0;
  for (const CellBlock& type : block.blocks) {
    const std::string path = fmt::format("{}/{}/", folder, info(type.cell).name);
    const auto count = static_cast<std::size_t>(type.count());
    const std::vector<std::int64_t> shape{type.count(), info(type.cell).nodes};
    data.integers(path + "nodes", vtk_nodes(type), shape);
    for (std::size_t m = 0; m < marks.size(); ++m)
      data.integers(path + marks[m], std::span(block.marks[m].values).subspan(first, count), shape_of(count, 1));
    first += count;
  }
  for (const CellMark& mark : block.marks)
    for (std::size_t i = 0; i < mark.meanings.size(); ++i)
      data.attribute(folder, fmt::format("{} {}", mark.name, i), std::string_view(mark.meanings[i]));
}

/// Rows [first, first + rows) of each field, into one folder.
void write_fields(Hdf5Writer& data, const std::string& folder, const std::vector<FieldValues>& fields, std::size_t first, std::size_t rows,
                  FieldPrecision precision) {
  const std::vector<std::string> names = names_of(fields);
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const std::size_t width = components(fields[f].kind);
    const auto values = std::span(fields[f].values).subspan(first * width, rows * width);
    const std::string path = folder + "/" + names[f];
    if (precision == FieldPrecision::float32)
      data.numbers(path, as_float32(values), shape_of(rows, width));
    else
      data.numbers(path, as_float64(values), shape_of(rows, width));
    data.attribute(path, "unit", std::string_view(fields[f].unit));
  }
}

void write_block(Hdf5Writer& data, const std::string& folder, const FieldMesh& block, const BlockFields& fields, FieldPrecision precision) {
  data.group(folder);
  write_fields(data, folder + "/points", fields.points, 0, block.points.size(), precision);
  std::size_t first = 0;
  for (const CellBlock& type : block.blocks) {
    const auto count = static_cast<std::size_t>(type.count());
    write_fields(data, fmt::format("{}/{}", folder, info(type.cell).name), fields.cells, first, count, precision);
    first += count;
  }
}

/// "./fields.h5"
std::string data_name(const std::string& stem) {
  return "./" + stem.substr(stem.rfind('/') + 1) + ".h5";
}

/// Bytes of the numbers alone.
std::int64_t mesh_bytes(const FieldMesh& block) {
  std::size_t bytes = 3 * sizeof(double) * block.points.size();
  for (const CellBlock& type : block.blocks)
    bytes += sizeof(int) * (type.nodes.size() + block.marks.size() * static_cast<std::size_t>(type.count()));
  return static_cast<std::int64_t>(bytes);
}
std::int64_t frame_bytes(const FieldMesh& block, const BlockFields& fields, FieldPrecision precision) {
  std::size_t numbers = 0;
  for (const FieldValues& field : fields.points) numbers += components(field.kind) * block.points.size();
  for (const FieldValues& field : fields.cells) numbers += components(field.kind) * cells_in(block);
  return static_cast<std::int64_t>(numbers * (precision == FieldPrecision::float32 ? sizeof(float) : sizeof(double)));
}

/// The same block with one point and one cell of each type.
FieldMesh smallest(const FieldMesh& block) {
  FieldMesh small{block.name, {Vec3::Zero()}, {0}, {}, std::vector<CellId>(block.blocks.size()), block.marks};
  for (const CellBlock& type : block.blocks)
    small.blocks.push_back({type.cell, std::vector<int>(static_cast<std::size_t>(info(type.cell).nodes), 0)});
  for (CellMark& mark : small.marks) mark.values.assign(small.cell.size(), 0);
  return small;
}
BlockFields smallest(const FieldMesh& small, const BlockFields& fields) {
  BlockFields result = fields;
  for (FieldValues& field : result.points) field.values.assign(components(field.kind), 0);
  for (FieldValues& field : result.cells) field.values.assign(components(field.kind) * cells_in(small), 0);
  return result;
}

/// What HDF5 adds to the numbers, as measured with files of hardly any.
FieldSize records_of_hdf5(const std::vector<FieldMesh>& blocks, const FieldFrame& frame, FieldPrecision precision) {
  constexpr int few = 8, more = 40;
  Hdf5Writer data = Hdf5Writer::in_memory();
  const std::vector<std::string> names = plain_names(blocks);
  std::vector<FieldMesh> small;
  std::vector<BlockFields> fields;
  FieldSize numbers;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    small.push_back(smallest(blocks[b]));
    fields.push_back(smallest(small[b], frame.blocks[b]));
    write_mesh(data, names[b], small[b]);
    numbers.once += mesh_bytes(small[b]);
    numbers.per_frame += frame_bytes(small[b], fields[b], precision);
  }
  std::int64_t size_of_few = 0;
  for (int number = 0; number < more; ++number) {
    if (number == few) size_of_few = static_cast<std::int64_t>(data.image().size());
    for (std::size_t b = 0; b < blocks.size(); ++b) write_block(data, frame_path(number, names[b]), small[b], fields[b], precision);
    data.attribute(fmt::format("/frames/{:06}", number), "time [s]", frame.time);
  }
  const std::int64_t per_frame = (static_cast<std::int64_t>(data.image().size()) - size_of_few) / (more - few);
  return {size_of_few - few * per_frame - numbers.once, per_frame - numbers.per_frame};
}

}  // namespace

FieldSize xdmf_size(const std::vector<FieldMesh>& blocks, const FieldFrame& frame, FieldPrecision precision) {
  const std::string text = frame_text("./fields.h5", plain_names(blocks), blocks, frame, 0, precision);
  FieldSize size = records_of_hdf5(blocks, frame, precision);
  size.once += static_cast<std::int64_t>(domain_head.size() + domain_tail.size());
  size.per_frame += static_cast<std::int64_t>(text.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    size.once += mesh_bytes(blocks[b]);
    size.per_frame += frame_bytes(blocks[b], frame.blocks[b], precision);
  }
  return size;
}

XdmfWriter::XdmfWriter(const std::string& stem, std::vector<FieldMesh> blocks, FieldPrecision precision, Hdf5Writer data)
    : stem_(stem), blocks_(std::move(blocks)), names_(plain_names(blocks_)), precision_(precision), data_(std::move(data)) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) write_mesh(data_, names_[b], blocks_[b]);
}

std::optional<FieldTrouble> XdmfWriter::write(const FieldFrame& frame) {
  if (auto trouble = find_trouble(blocks_, frame, precision_)) return trouble;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    write_block(data_, frame_path(frames_, names_[b]), blocks_[b], frame.blocks[b], precision_);
  data_.attribute(fmt::format("/frames/{:06}", frames_), "time [s]", frame.time);
  list_.push_back({frame.time, frame_text(data_name(stem_), names_, blocks_, frame, frames_, precision_)});
  ++frames_;
  return std::nullopt;
}

void XdmfWriter::finish(const WriteFile& write) {
  data_.flush();
  write(stem_ + ".xdmf", std::string(domain_head) + in_order_of_time(list_) + std::string(domain_tail));
}

}  // namespace uplift
