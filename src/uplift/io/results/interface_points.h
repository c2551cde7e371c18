#pragma once
#include <string>

#include "uplift/interface/interface.h"
#include "uplift/io/text/json_writer.h"

namespace uplift {

/// Where the points of an interface lie: "1 (-1.5, 0), 2 (-1, 0), ..., 7 (1.5, 0) m"; of many points the first and the last ones.
std::string points_text(const Interface& interface);
/// An object with the coordinates [m] and areas [m2] of all points, one array each, in the order of their numbers from 1 on.
void write_points(JsonWriter& json, const Interface& interface);

}  // namespace uplift
