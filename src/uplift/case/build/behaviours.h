#pragma once
#include <string_view>
#include <vector>

#include "uplift/base/declare.h"
#include "uplift/interface/interface.h"

// Laws that follow from those of the case.
namespace uplift {

/// Values as they would be read from a file again, with one number replaced.
Values with_number(const Values& part, std::string_view key, double number);
/// An elastic joint that never opens, with the damping of the one that may: what differs between the runs is the uplift alone. `stiffness`
/// [Pa/m] per component, the normal last.
Values bonded_behaviour(const Values& like, const std::vector<double>& stiffness);
/// The same for a foundation: elastic, as stiff as the ground that neither lets go nor yields.
Values bonded_foundation(const Values& like, const Interface& foundation);

}  // namespace uplift
