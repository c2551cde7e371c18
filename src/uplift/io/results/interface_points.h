#pragma once
#include <string>

#include "uplift/interface/interface.h"
#include "uplift/io/results/result_writer.h"

namespace uplift {

/// Where the points of an interface lie: "1 (-1.5, 0), 2 (-1, 0), ..., 7 (1.5, 0) m"; of many points the first and the last ones.
std::string points_text(const Interface& interface);
/// The member "positions": coordinates and areas of all points.
void write_points(ResultWriter& out, const Interface& interface);

}  // namespace uplift
