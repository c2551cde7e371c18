#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "uplift/io/fields/fields.h"

// What both writers of fields need; used by fields*.cpp alone.
namespace uplift {

/// "displacement [m]".
std::string title(const FieldValues& field);
/// Text for XML, in elements and attributes; control characters, which XML 1.0 does not know, become spaces.
std::string xml_text(std::string_view text);
/// For names of files and of objects in HDF5: what is not a letter, digit, "-" or "_" becomes "_"; equal ones get numbers.
std::vector<std::string> plain_names(const std::vector<std::string>& names);
std::vector<std::string> plain_names(const std::vector<FieldMesh>& blocks);

inline std::size_t components(FieldKind kind) {
  return static_cast<std::size_t>(kind);
}
/// Number of cells.
inline std::size_t cells_in(const FieldMesh& block) {
  return block.cell.size();
}
/// The block's points, coordinates side by side.
std::vector<double> coordinates(const FieldMesh& block);
/// Nodes of the cells of one type in VTK's numbering. VTK's wedges (13, 26) have the triangle 0-1-2 clockwise seen from 3-4-5: there the
/// first triangle's normal points out of the cell (vtkWedge.h), else volumes are negative and the sides of the cell look inwards. Ours
/// (mesh/cells.h) are written upside down, triangle 3-4-5 first.
std::vector<int> vtk_nodes(const CellBlock& block);

/// The numbers as float32; each must fit (assertion), as find_trouble() tells.
std::vector<float> as_float32(std::span<const double> values);
/// Each must be finite (assertion).
std::span<const double> as_float64(std::span<const double> values);

/// The entries one after another in the order of their times.
std::string in_order_of_time(std::vector<FieldEntry> entries);

FieldSize vtu_size(const std::vector<FieldMesh>& blocks, const FieldFrame& frame, FieldPrecision precision);
FieldSize xdmf_size(const std::vector<FieldMesh>& blocks, const FieldFrame& frame, FieldPrecision precision);

}  // namespace uplift
