#pragma once
#include <optional>
#include <string>
#include <vector>

#include "uplift/case/build/model.h"

// Roles of interfaces: bases carry the weight, walls stand beside the structure.
namespace uplift {

/// Unit vector against gravity; without gravity the vertical axis.
Vec3 upward(const CaseInput& input);

/// An interface of the model: an [[interface]] of the case, or its base or its walls; or a [[foundation]].
struct InterfacePart {
  const CaseTable* table = nullptr;
  const Values* behaviour = nullptr;  // law or cone; of a foundation its model
  std::string name;
  Joint joint;
  const CaseFoundation* foundation = nullptr;  // null: it is none
  std::optional<Footprint> footprint = {};     // of a foundation
  bool water = false;                          // the case states water under it
};
/// The interfaces of a case, bases first. A surface or a line with faces of both kinds is divided in two: the base keeps the name, the
/// other part is called "<name> walls". A face is of a base when its normal lies within 45 degrees of the upward direction; where no face
/// of an interface is, within 45 degrees of the downward direction (the structure hangs below the interface). `role` in the case file
/// overrides this and prevents the division.
std::vector<InterfacePart> interface_parts(const Case& read, bool rigid_ground, ModelBuilder& builder, CaseNames& names);

}  // namespace uplift
