#pragma once
#include <optional>
#include <span>
#include <vector>

#include "uplift/laws/law.h"
#include "uplift/laws/soil_stiffness.h"

// Models of a whole foundation: what lies under a rigid footing in one point with rotations, from the stiffness of the ground and the
// strength of a geotechnical report. Rows of the point: in the plane (u_t, u_n, theta), in space (u_t1, u_t2, u_n, theta_1, theta_2,
// theta_n); relative displacements [m] and rotations [rad] of the footing against the ground, opening > 0. Forces [N, N m], area 1.
namespace uplift {

/// The underside of a rigid footing.
struct Footprint {
  enum class Shape { strip, rectangle, disc } shape = Shape::rectangle;
  double width = 0;                   // m: along t1; of a disc its diameter
  double length = 0;                  // m: along t2; of a strip out of the plane
  int dimension = 2;                  // of the model
  std::optional<FootingOnSoil> soil;  // [foundation.soil]: gives the stiffnesses that the model leaves out
  double azimuth = 0;                 // rad: in space, from the x axis to t1, about the normal
  double area() const;                // m2
  int components() const { return dimension == 2 ? 3 : 6; }
  int rotations() const { return dimension == 2 ? 1 : 3; }
};

std::string_view to_string(Footprint::Shape);
std::optional<Footprint::Shape> footprint_shape(std::string_view name);

using FoundationEntry = Entry<InterfaceLaw, Footprint>;
std::span<const FoundationEntry* const> foundation_catalog();
std::span<const PartInfo* const> foundation_models();

/// The law that checked values name: of a foundation with this underside, else of a joint. Null where they name a cone.
std::unique_ptr<const InterfaceLaw> make_law(const Values& behaviour, const std::optional<Footprint>& footprint);

/// Keys of the stiffnesses of a foundation in the order of the rows; `components`: of its point.
std::span<const char* const> foundation_stiffness_keys(int components);
/// Stiffnesses of a foundation, which every model has [N/m, N m/rad]: in the order of the rows.
std::vector<Field> foundation_stiffness_fields();
/// Their values in the order of the rows: as given, else of the soil. Throws InputError where one is missing.
std::vector<double> foundation_stiffness(const Footprint& footprint, const Values& values);
/// The dashpots that [foundation.soil] with `radiation` puts beside the law, in the order of the rows [N s/m, N m s/rad]; empty without it.
std::vector<double> radiation_damping(const Footprint& footprint);

}  // namespace uplift
