#include "uplift/model/base_size.h"

namespace uplift {
namespace {

/// m: the largest distance from the place that is farthest from the mean; the same when all places are turned.
double extent(const std::vector<Place>& places) {
  Vec3 from = Vec3::Zero();
  for (const Vec3& place : places) from += place / static_cast<double>(places.size());
  double most = 0;
  for (int sweep = 0; sweep < 2; ++sweep) {
    const Vec3* farthest = nullptr;
    most = 0;
    for (const Vec3& place : places)
      if (const double distance = (place - from).norm(); distance > most) most = distance, farthest = &place;
    if (farthest != nullptr) from = *farthest;
  }
  return most;
}

}  // namespace

double base_size(const Model& model) {
  std::vector<Place> places;
  for (const Interface& interface : model.interfaces) places.insert(places.end(), interface.position.begin(), interface.position.end());
  if (const double size = extent(places); size > 0) return size;
  places.clear();
  for (const Node& node : model.nodes) places.push_back(node.position);
  return extent(places);
}

}  // namespace uplift
