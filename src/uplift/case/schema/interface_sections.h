#pragma once
#include <variant>

#include "uplift/case/case.h"
#include "uplift/case/schema/mesh_sections.h"
#include "uplift/interface/joint.h"
#include "uplift/laws/foundation.h"

// Interfaces and foundations: declarations, used by case/schema/sections.cpp alone, and what their tables are read into.
namespace uplift {

/// Per area of the footing.
struct CaseBed : CaseTable {
  double stiffness, damping, mass;  // Pa/m, Pa s/m, kg/m2
};
struct CaseFooting : CaseTable {
  NameUsed body;
  double width, thickness;       // m
  std::optional<double> length;  // m
  int points;
  std::optional<int> points_across;
  double azimuth;  // rad
  FootingRule rule;
  std::optional<VectorUsed> offset, normal;
  std::optional<CaseBed> bed;
  const Values* soil;  // null: none
  bool soil_on_rock;
};
struct CasePairs : CaseTable {
  std::vector<NameUsed> upper, lower;
  std::optional<VectorUsed> normal;
  double area;  // m2
};
struct CaseLine : CaseTable {
  std::vector<NameUsed> upper, lower;
  int nodes_per_element;
  LineQuadrature quadrature;
  double thickness;  // m
};
struct CaseWater : CaseTable {
  std::optional<double> level;  // m; absent: the same head everywhere
  double head, unit_weight;     // m, Pa/m
};

const Section& interface_section();
struct CaseInterface : CaseTable {
  NameUsed name;
  std::variant<CaseFooting, CasePairs, CaseLine, CaseSurface, CaseCut> place;
  bool gap_of_geometry;
  double gap;                 // m; 0 with that of the geometry
  const Values* gap_profile;  // null: none
  std::optional<CaseWater> water;
  std::optional<Role> role;
  const Values* law;
  // The place where it is of this kind; else null.
  const CaseFooting* footing() const { return std::get_if<CaseFooting>(&place); }
  const CaseSurface* surface() const { return std::get_if<CaseSurface>(&place); }
  const CaseCut* cut() const { return std::get_if<CaseCut>(&place); }
};
CaseInterface case_interface(const Values&);

const Section& foundation_section();
struct CaseFoundation : CaseTable {
  NameUsed name, body;
  Footprint::Shape shape;
  double width;                  // m
  std::optional<double> length;  // m
  double azimuth;                // rad
  std::optional<VectorUsed> offset;
  const Values* soil;  // null: none
  bool radiates;
  const Values* model;
};
CaseFoundation case_foundation(const Values&);

}  // namespace uplift
