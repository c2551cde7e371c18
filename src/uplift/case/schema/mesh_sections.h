#pragma once
#include <array>

#include "uplift/case/schema/case_table.h"
#include "uplift/elements/absorbing.h"
#include "uplift/elements/element_entry.h"
#include "uplift/mesh/soil_box.h"

// The mesh and its interfaces: declarations, used by other sections alone, and what their tables are read into.
namespace uplift {

/// A vector that is read before the dimension of the mesh is known.
struct VectorUsed {
  const Values* table;
  std::string_view key;
  Vec3 in(Space space) const { return vector_of(*table, key, space); }
};
std::optional<VectorUsed> vector_used(const Values& table, std::string_view key);

const Section& mesh_section();
/// Either a file or a soil box.
struct CaseMeshSource : CaseTable {
  std::optional<NameUsed> file;
  std::string name;  // of the mesh in the file; empty: it has one alone
  std::optional<SoilBox> soil_box;
  const Values* box_table;
};
CaseMeshSource case_mesh_source(const Values&);

/// A wave that comes in through a face.
struct CaseIncident : CaseTable {
  std::string name;
  Wave wave;
  std::string wave_word;
  double azimuth;   // rad
  double velocity;  // m/s of the incoming wave alone, that the function multiplies
  double stated;    // m/s, of this or of the outcrop
  NameUsed function;
};
/// [[absorbing]], which elements/absorbing_entry.cpp declares.
struct CaseAbsorbing : CaseTable {
  NameUsed group;
  bool free_field, lumped;
  std::optional<CaseIncident> incident;
};
CaseAbsorbing case_absorbing(const Values&);

const Section& tie_section();
struct CaseTie : CaseTable {
  NameUsed group, to;
  std::vector<NameUsed> unknowns;
};
CaseTie case_tie(const Values&);

const Section& surface_section();
/// Either a group at which the mesh is opened, or two that are drawn apart.
struct CaseSurface : CaseTable {
  std::optional<NameUsed> group;
  std::vector<std::string> lower;  // groups of cells
  std::optional<NameUsed> lower_group, upper_group;
  bool nodal;
  std::optional<double> thickness;  // m
};
CaseSurface case_surface(const Values&);

const Section& cut_section();
/// A plane by its level, or by a point and its normal.
struct CaseCut : CaseTable {
  enum class Jump { linear, constant, rigid };
  using Range = std::array<double, 2>;  // m: least and largest coordinate
  std::vector<std::string> through;
  std::optional<double> level;  // m
  std::optional<VectorUsed> point, normal;
  std::string upper;  // group above the plane; empty: cells stay in their groups
  std::optional<Range> x, y, ground_x, ground_y;
  std::optional<double> height;  // m
  std::optional<NameUsed> free;
  Jump jump;
  std::string jump_word;
  double mesh_shift;                // of a cell
  std::optional<double> thickness;  // m
};
CaseCut case_cut(const Values&);

}  // namespace uplift
