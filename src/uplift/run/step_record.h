#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "uplift/interface/interface.h"

namespace uplift {

/// What one interface looks like at one instant.
struct InterfaceView {
  Resultant resultant;                        // of all that the ground exerts: law and radiation dashpots
  Resultant in_law;                           // of a whole foundation: without the dashpots
  double open_area = 0, tension_area = 0;     // shares of the area: with a gap; that pulls
  double max_opening = 0, least_opening = 0;  // m
  double max_pressure = 0;                    // Pa
  // Of a whole foundation whose ground has a strength, see FootingContact; at the end of the step
  double bearing_utilisation = 0, sliding_utilisation = 0, bearing_capacity = 0;  // 1, 1, N
  // Slope of the plane that fits the normal opening best (area-weighted): relative rotation of the upper side [rad]. In the plane the first
  // number, counter-clockwise > 0; in space about the two tangents of the mean normal.
  std::array<double, 2> rotation{};
};

/// How an interface and the base on it stand.
struct BasePose {
  double slip_1 = 0, slip_2 = 0;  // m: mean tangential opening along t1 and t2
  // Of the upper side: m downwards; rad in the plane (tilt_1, counter-clockwise), in space about x and y. 0 when its nodes are not known.
  double settlement = 0, tilt_1 = 0, tilt_2 = 0;
  double max_opening = 0, open_area = 0;  // m, share
};

/// A time in which something lasts [s].
struct Interval {
  double from = 0, to = 0;
};

/// What is kept of the interfaces at the beginning of the first dynamic stage and after every step of the dynamic stages, whatever is
/// written to the table: little per step, since a step may take less than a microsecond.
class StepRecord {
 public:
  struct Instant {
    double axial = 0, shear_1 = 0, shear_2 = 0, moment_1 = 0, moment_2 = 0;  // N, N m; in the plane shear_1 and moment_1
    double open_area = 0;
    double torsion = 0;   // N m, space only
    double pressure = 0;  // Pa, largest
  };
  struct Reached {
    double value = 0, time = 0;
  };
  /// Of one interface: largest values, and when there was no contact at all.
  struct Extremes {
    Reached max_opening, max_pressure, tension_area, penetration;
    Reached max_slip;                                  // of walls: length of the tangential opening
    Reached bearing_utilisation, sliding_utilisation;  // of a whole foundation
    double bearing_capacity = 0;                       // N: likewise, at the last instant
    std::vector<Interval> full_loss;
    double least_opening = 0;  // at the last instant
    Reached impulse;           // N s: momentum that an impact of constraints transferred in one step
    // Largest means over one step of what average() replaces by means over the window; 0 before it.
    double step_shear = 0, step_moment = 0, step_compression = 0, step_pressure = 0;  // N, N m, N, Pa
  };

  /// Makes room for instants to come, so many of them in the tail.
  void reserve(std::size_t interfaces, std::size_t count, std::size_t in_tail);
  /// A gap larger than the tolerance [m] is open.
  void add(double time, const std::vector<InterfaceView>& views, double gap_tolerance);
  /// The slip [m] of the walls at the last instant: `is_wall` says which interfaces are walls.
  void add_slip(const std::vector<Interface>& interfaces, const Vector& opening, const std::vector<char>& is_wall);
  /// The strength that the ground under whole foundations uses at the last instant.
  void add_strength(const std::vector<InterfaceView>& views);
  /// Times [s] in which none of the interfaces that are no walls has any contact.
  std::vector<Interval> full_loss(const std::vector<char>& is_wall) const;
  /// Their sum [s].
  double full_loss_time(const std::vector<char>& is_wall) const;
  /// Replaces forces, moments and pressures by their mean over the time `window` [s] that ends at each instant: where an impact is shorter
  /// than the step, a mean over the step depends on the step, the momentum in the window does not. Before the first instant they are those
  /// of the first.
  void average(double window);
  std::size_t size() const { return time.size(); }
  const Instant& at(std::size_t step, std::size_t interface) const { return instants[step * extremes.size() + interface]; }

  std::vector<Resultant> rest;              // where the static stages ended, before the initial state; empty without static stages
  std::vector<BasePose> rest_poses;         // there
  std::vector<std::vector<BasePose>> tail;  // of every interface, in the last tenth of the planned time
  std::vector<double> time;                 // s
  std::vector<Instant> instants;            // interfaces of the first instant, of the second, ...
  std::vector<Extremes> extremes;           // one per interface
};

}  // namespace uplift
