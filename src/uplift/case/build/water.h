#pragma once
#include "uplift/case/build/roles.h"

// Water in the joints of a case.
namespace uplift {

/// The pressure of the water at the points of an interface.
void set_water(const std::optional<CaseWater>& water, std::vector<JointPoint>& points, const CaseNames& names);
/// By how much the water lightens an interface, in words; empty without water.
std::string note_of_water(const InterfacePart& part);
/// InputError for P-delta with water under a footing whose body does not lie in the joint: the geometric stiffness of the arm between them
/// contains the forces of the contact, but not the thrust of the water.
void check_second_order_water(const Case& read);

}  // namespace uplift
