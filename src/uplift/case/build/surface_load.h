#pragma once
#include <utility>
#include <vector>

#include "uplift/case/mesh/mesh.h"
#include "uplift/case/schema/profile.h"

// Forces on the nodes of edges (in space: faces) of the mesh, consistent with their shape functions.
namespace uplift {

/// What a surface load integrates over the surface for one node: f N_a dA [m2], with the factor f of the profile (null: 1).
struct SurfaceShare {
  int node = 0;  // of the mesh
  double area = 0;
  Vec3 outward = Vec3::Zero();  // f N_a n dA, n out of the solid; only of surfaces that bound one solid
};

/// For each face its nodes. The integrals are exact for a linear profile on faces with straight (parallel, for quadrilaterals) sides,
/// `outward` on curved ones too. Where the slope of the profile changes inside a face, the rule is refined: the error is then below 1e-4 of
/// the force on that face.
std::vector<SurfaceShare> surface_shares(const CaseSolids& solids, const std::vector<CellId>& faces, const Profile* profile);

/// The same for the surface beside a cut (eq X5), whose faces follow the cells below it by their shape functions.
std::vector<SurfaceShare> surface_shares(const CaseSolids& solids, const std::vector<FreeFace>& faces, const Profile* profile);

}  // namespace uplift
