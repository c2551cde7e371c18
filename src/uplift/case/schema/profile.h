#pragma once
#include <vector>

#include "uplift/base/declare.h"
#include "uplift/elements/space.h"

namespace uplift {

/// A quantity that varies linearly between given positions along a coordinate or with the distance from a point; beyond the first and the
/// last position it keeps the values there.
class Profile {
 public:
  double at(const Vec3& position) const;
  /// Throws InputError when all positions lie on one side of these places: the profile would do nothing.
  void require_overlap(const std::vector<Vec3>& places) const;
  /// Whether the slope changes between the least and the largest coordinate of these places.
  bool bends_within(const std::vector<Vec3>& places) const;

 private:
  friend Profile load_profile(const Values&, Space);
  friend Profile gap_profile(const Values&, Space);
  /// `values`: the key of the values in the table. Throws InputError.
  Profile(const Values& table, std::string_view values, Space space);
  double coordinate(const Vec3& position) const { return axis_ < 0 ? (position - centre_).norm() : position[axis_]; }
  const Values* table_;
  int axis_ = -1;  // -1: distance from the centre
  Vec3 centre_ = Vec3::Zero();
  std::vector<double> positions_, values_;  // m, ascending
};

/// Factors of a load.
const Section& load_profile_section();
Profile load_profile(const Values&, Space);
/// Initial gaps of an interface [m].
const Section& gap_profile_section();
Profile gap_profile(const Values&, Space);

}  // namespace uplift
