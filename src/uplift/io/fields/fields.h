#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/io/files.h"
#include "uplift/io/hdf5/hdf5.h"
#include "uplift/mesh/mesh.h"
#include "uplift/mesh/split.h"

// Fields on meshes at moments of a run, for ParaView:
// - VTU: one file for each frame and block, a .pvd that lists them. Complete files, easy to take apart; the mesh is in each of them.
// - XDMF: one HDF5 file for all frames, with the mesh once, and an .xdmf that describes it. For many frames or large meshes.
namespace uplift {

/// The number of values per node or cell. A tensor is symmetric: xx, yy, zz, xy, yz, xz (VTK's order).
enum class FieldKind : unsigned char { scalar = 1, vector = 3, tensor = 6 };
/// How values are stored: float32 keeps 7 digits and magnitudes up to 3.4e38. Coordinates and times are always stored as float64.
enum class FieldPrecision : unsigned char { float32, float64 };

/// Values at all points or all cells of a block, those of one point or cell side by side. In files it is called "displacement [m]"; just
/// "status" when it has no unit.
struct FieldValues {
  std::string name, unit;
  FieldKind kind = FieldKind::scalar;
  std::vector<double> values;
};

/// Whole numbers of the cells that never change ("group", "side") and what they mean: the text of value i, for all i from 0 on.
struct CellMark {
  std::string name;
  std::vector<int> values;  // one per cell
  std::vector<std::string> meanings;
};

/// One block of the output: a part of a mesh with its own points.
struct FieldMesh {
  std::string name;
  std::vector<Vec3> points;       // m
  std::vector<int> node;          // of each point: the node of the mesh
  std::vector<CellBlock> blocks;  // one per type, none empty; nodes are numbers of points
  std::vector<CellId> cell;       // of each cell, block after block: the cell of the mesh
  std::vector<CellMark> marks;
};

/// The cells of these groups, each once, and the nodes they use in ascending order. Mark "group": the first of the groups that has the
/// cell. Throws InputError (key "groups") for a group that is absent or holds no cells, and when no group is named.
FieldMesh field_mesh(const Mesh& mesh, std::string name, const std::vector<std::string>& groups, const Where& where);

/// The faces of opened surfaces: of each face the lower and then the upper side. Faces share no points, so that a corner has values of its
/// bottom and of its wall, and a node where the surface ends inside the continuum is there on both faces. Marks: "interface", "side".
struct InterfaceMesh {
  FieldMesh mesh;
  std::vector<int> place;  // of each point, counted through the nodes of the faces of all surfaces one after another
  std::vector<int> face;   // of each cell, counted through the faces of all surfaces one after another
};
InterfaceMesh interface_mesh(const Mesh& mesh, std::string name, const std::vector<OpenedSurface>& surfaces);

/// Values at the points of a block from those at all nodes of the mesh, `stride` numbers for each node: the first ones of a tuple are kept,
/// at most `given`, missing ones are 0, so the vectors of a plane model (2 given) get z = 0. For a scalar the stride is 1, for a tensor 6.
std::vector<double> at_points(const FieldMesh& block, FieldKind kind, std::span<const double> nodal, int stride, int given = 6);
/// Both faces get the value of their place.
std::vector<double> at_points(const InterfaceMesh& block, FieldKind kind, std::span<const double> by_place);
/// Both faces get the value of their face.
std::vector<double> at_cells(const InterfaceMesh& block, FieldKind kind, std::span<const double> by_face);

struct BlockFields {
  std::vector<FieldValues> points, cells;  // names differ within each list
};
/// The fields of all blocks at one moment.
struct FieldFrame {
  double time = 0;                  // s
  std::vector<BlockFields> blocks;  // one for each block
};

/// Why a frame was not written.
struct FieldTrouble {
  std::string reason;  // `field "velocity [m/s]" of block "soil" is nan at node 12 (1, 2, 0)`; nodes and cells counted from 1
};
/// None when every number is finite and fits the precision. Sizes that do not fit the blocks are a bug (assertion).
std::optional<FieldTrouble> find_trouble(const std::vector<FieldMesh>& blocks, const FieldFrame& frame, FieldPrecision precision);

/// Takes a file's name and bytes.
using WriteFile = std::function<void(const std::string& name, std::string_view bytes)>;
/// Into a folder, which must live as long as the function.
WriteFile into(ResultFolder& folder);

/// What the list of frames says of one of them.
struct FieldEntry {
  double time = 0;  // s
  std::string text;
};

/// Writes "<stem>/<block>_000000.vtu" and so on, "<stem>/<block>_names.csv" (what the marks mean) and the list
/// "<stem>.pvd", in which frames stand in the order of time.
class VtuWriter {
 public:
  VtuWriter(std::string stem, std::vector<FieldMesh> blocks, FieldPrecision precision, WriteFile write);
  /// Nothing is written, and the frame does not count, when it has a trouble.
  [[nodiscard]] std::optional<FieldTrouble> write(const FieldFrame& frame);
  /// Writes the list of all frames and the names. To be called once, at the end.
  void finish();

 private:
  std::string stem_;
  std::vector<FieldEntry> list_;
  std::vector<FieldMesh> blocks_;
  std::vector<std::string> files_, mesh_texts_;  // of each block
  FieldPrecision precision_;
  WriteFile write_;
  int frames_ = 0;
};

/// Writes "<stem>.h5" and "<stem>.xdmf", which belong into one folder. Frames are described in the order of time.
class XdmfWriter {
 public:
  /// The frames go to `data`, which is to be "<stem>.h5" beside the description.
  XdmfWriter(const std::string& stem, std::vector<FieldMesh> blocks, FieldPrecision precision, Hdf5Writer data);
  /// Nothing is written, and the frame does not count, when it has a trouble.
  [[nodiscard]] std::optional<FieldTrouble> write(const FieldFrame& frame);
  /// Writes the description: "<stem>.xdmf". The frames are complete after this. To be called once, at the end.
  void finish(const WriteFile& write);

 private:
  std::string stem_;
  std::vector<FieldEntry> list_;
  std::vector<FieldMesh> blocks_;
  std::vector<std::string> names_;  // of the blocks, in the file
  FieldPrecision precision_;
  Hdf5Writer data_;
  int frames_ = 0;
};

enum class FieldFormat : unsigned char { vtu, xdmf };
struct FieldSize {
  std::int64_t once = 0, per_frame = 0;  // bytes
};
/// What the files will take. Values of the frame need not be there. Exact but for the digits of times and of the frames' numbers in the
/// list (a few bytes per block) and for HDF5's own records, which are measured with a small file (1 %).
FieldSize size_per_frame(FieldFormat format, const std::vector<FieldMesh>& blocks, const FieldFrame& frame, FieldPrecision precision);

}  // namespace uplift
