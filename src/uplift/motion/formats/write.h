#pragma once
#include <span>
#include <string>

#include "uplift/motion/motion.h"

namespace uplift {

/// Motions of one step as CSV in SI: a column of times [s], then one for each, with its unit in the head; shorter ones end in empty cells.
/// read_motions gives the same steps and values back, bit for bit. Where they come from stands in comments.
std::string motion_csv(std::span<const Motion> motions);

}  // namespace uplift
