#include "uplift/case/schema/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "uplift/elements/element_entry.h"

namespace uplift {
namespace {

std::vector<Field> profile_fields(Field values) {
  return {choice("along", {"x", "y", "z", "distance"}, "coordinate; distance: from the point centre"),
          vector("centre", "m", "for along = \"distance\"").optional(), numbers("positions", "m", "coordinates or distances, ascending"),
          std::move(values)};
}

}  // namespace

const Section& load_profile_section() {
  static const Section s{"profile",
                         "a load that varies over its surface: linear between the positions, constant beyond the first and the last one",
                         profile_fields(numbers("factors", "1", "what the load is multiplied by at each position"))};
  return s;
}

const Section& gap_profile_section() {
  static const Section s{
      "gap_profile", "initial gaps that vary over the interface: linear between the positions, constant beyond the first and the last one",
      profile_fields(numbers("gaps", "m", "initial gap at each position"))};
  return s;
}

Profile load_profile(const Values& table, Space space) {
  return {table, "factors", space};
}

Profile gap_profile(const Values& table, Space space) {
  return {table, "gaps", space};
}

Profile::Profile(const Values& table, std::string_view values, Space space) : table_(&table) {
  const std::string& along = table.text("along");
  const bool distance = along == "distance";
  if (distance != table.has("centre"))
    fail(table, distance ? "" : "centre", distance ? "centre, from which the distance is measured" : "no centre for a coordinate",
         distance ? "none" : "one");
  if (distance) centre_ = vector_of(table, "centre", space);
  if (!distance) axis_ = along.front() - 'x';
  if (axis_ >= space.dimension) fail(table, "along", "x, y or distance in a plane model", "\"z\"");
  positions_ = table.numbers("positions"), values_ = table.numbers(values);
  if (positions_.size() < 2) fail(table, "positions", "at least two positions", fmt::format("{}", positions_.size()));
  if (values_.size() != positions_.size())
    fail(table, values, fmt::format("as many {} as positions ({})", values, positions_.size()), fmt::format("{}", values_.size()));
  for (std::size_t i = 1; i < positions_.size(); ++i)
    if (!(positions_[i] > positions_[i - 1]))
      fail(table, "positions", "positions in ascending order", fmt::format("{:g} m after {:g} m", positions_[i], positions_[i - 1]));
}

double Profile::at(const Vec3& position) const {
  const double x = coordinate(position);
  if (x <= positions_.front()) return values_.front();
  if (x >= positions_.back()) return values_.back();
  const auto i = static_cast<std::size_t>(std::ranges::upper_bound(positions_, x) - positions_.begin());
  const double share = (x - positions_[i - 1]) / (positions_[i] - positions_[i - 1]);
  return (1 - share) * values_[i - 1] + share * values_[i];
}

void Profile::require_overlap(const std::vector<Vec3>& places) const {
  const auto [nearest, farthest] = std::ranges::minmax(places, {}, [&](const Vec3& place) { return coordinate(place); });
  const double from = axis_ < 0 ? 0 : coordinate(nearest), to = coordinate(farthest);  // the distance may be least inside a face
  const double margin = 1e-6 * (to - from);
  if (positions_.front() <= to + margin && positions_.back() >= from - margin) return;
  const std::string along = axis_ < 0 ? "at distances" : fmt::format("from {} =", static_cast<char>('x' + axis_));
  fail(*table_, "positions", fmt::format("positions that reach the surface, which lies {} {:.4g} to {:.4g} m", along, from, to),
       fmt::format("{:.4g} to {:.4g} m", positions_.front(), positions_.back()));
}

bool Profile::bends_within(const std::vector<Vec3>& places) const {
  if (axis_ < 0) return true;  // the distance itself is not linear
  const auto [least, most] = std::ranges::minmax(places, {}, [&](const Vec3& place) { return coordinate(place); });
  const double from = coordinate(least), to = coordinate(most), margin = 1e-9 * (to - from);
  return std::ranges::any_of(positions_, [&](double bend) { return bend > from + margin && bend < to - margin; });
}

}  // namespace uplift
