#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "uplift/interface/interface.h"

namespace uplift {

/// What one interface looks like at one instant.
struct InterfaceView {
  Resultant resultant;
  double open_area = 0, tension_area = 0;     // shares of the area: with a gap; that pulls
  double max_opening = 0, least_opening = 0;  // m
  double max_pressure = 0;                    // Pa
  double slip_1 = 0, slip_2 = 0;              // m: mean tangential opening along t1 and t2
  // Of the upper side: m downwards; rad in the plane (tilt_1, counter-clockwise), in space about x and y. 0 when its nodes are not known.
  double settlement = 0, tilt_1 = 0, tilt_2 = 0;
};

/// All interfaces at the beginning of the first dynamic stage and after every step of the dynamic stages, whatever is written to the table.
struct StepRecord {
  std::size_t interfaces = 0;
  std::vector<InterfaceView> rest;   // where the static stages ended, before the initial state; empty without static stages
  std::vector<double> time;          // s
  std::vector<InterfaceView> views;  // interfaces of the first instant, of the second, ...

  std::size_t size() const { return time.size(); }
  const InterfaceView& at(std::size_t step, std::size_t interface) const { return views[step * interfaces + interface]; }
};

}  // namespace uplift
