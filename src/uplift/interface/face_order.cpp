#include "uplift/interface/face_order.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "uplift/interface/interface.h"

namespace uplift {

namespace {

/// Faces that are connected at their end nodes, in the order in which a walk from one end meets them.
class Lines {
 public:
  struct Step {
    std::size_t face;
    bool reversed;  // from its second end node to its first
  };

  Lines(const Mesh& mesh, const std::vector<FacePair>& faces) : mesh_(mesh), faces_(faces), met_(faces.size(), false) {
    for (std::size_t f = 0; f < faces.size(); ++f)
      for (const int node : ends(f)) at_[node].push_back(f);
    std::vector<int> starts;
    for (const auto& [node, here] : at_) starts.push_back(node);
    std::ranges::sort(starts, {}, [&](int node) { return key(node); });
    for (const bool closed : {false, true})  // rings have no end and come last
      for (const int start : starts)
        if (closed || at_[start].size() == 1) walk(start);
  }
  const std::vector<Step>& steps() const { return steps_; }

 private:
  std::array<int, 2> ends(std::size_t face) const {
    const std::span<const int> nodes = mesh_.cell(faces_[face].lower);
    return {nodes[0], nodes[1]};
  }
  std::tuple<double, double, int> key(int node) const {
    const Vec3& x = mesh_.nodes[static_cast<std::size_t>(node)];
    return {x.x(), x.y(), node};
  }
  void walk(int node) {
    for (;;) {
      const std::vector<std::size_t>& here = at_[node];
      const auto next = std::ranges::find_if(here, [&](std::size_t f) { return !met_[f]; });
      if (next == here.end()) return;
      met_[*next] = true;
      const auto [first, second] = ends(*next);
      steps_.push_back({*next, first != node});
      node = first == node ? second : first;
    }
  }
  const Mesh& mesh_;
  const std::vector<FacePair>& faces_;
  std::map<int, std::vector<std::size_t>> at_;
  std::vector<bool> met_;
  std::vector<Step> steps_;
};

/// The directions of normals, the one that points up most first: each within 26 degrees of the first point that has it.
std::vector<Vec3> directions(const std::vector<JointPoint>& points) {
  std::vector<Vec3> found;
  for (const JointPoint& point : points)
    if (std::ranges::none_of(found, [&](const Vec3& n) { return n.dot(point.normal) > 0.9; })) found.emplace_back(point.normal);
  std::ranges::sort(found,
                    [](const Vec3& a, const Vec3& b) { return std::tuple(-a.z(), a.x(), a.y()) < std::tuple(-b.z(), b.x(), b.y()); });
  return found;
}

}  // namespace

std::vector<int> order_along_lines(const Mesh& mesh, const std::vector<FacePair>& faces, FaceQuadrature quadrature,
                                   const FaceJoints& joints) {
  std::vector<int> order;
  std::vector<bool> listed(joints.points.size(), false);
  const Lines lines(mesh, faces);
  for (const auto& [face, reversed] : lines.steps()) {
    std::vector<int> numbers = joints.of_face[face];
    if (quadrature == FaceQuadrature::nodal && numbers.size() == 3) std::swap(numbers[1], numbers[2]);  // the middle is the last node
    if (reversed) std::ranges::reverse(numbers);
    for (const int k : numbers)
      if (k >= 0 && !listed[static_cast<std::size_t>(k)]) order.push_back(k), listed[static_cast<std::size_t>(k)] = true;
  }
  return order;
}

std::vector<int> order_in_rows(const std::vector<JointPoint>& points) {
  struct Key {
    std::size_t direction;
    double across, along;
  };
  const std::vector<Vec3> normals = directions(points);
  std::vector<Key> keys;
  double size = 0;
  for (const JointPoint& point : points) {
    const auto fits = std::ranges::max_element(normals, {}, [&](const Vec3& n) { return n.dot(point.normal); });
    keys.push_back({static_cast<std::size_t>(fits - normals.begin()), point.position.dot(local_axis(Space{3}, *fits, 1)),
                    point.position.dot(local_axis(Space{3}, *fits, 0))});
    size = std::max(size, point.position.norm());
  }
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) -> Key& { return keys[static_cast<std::size_t>(i)]; };
  std::ranges::sort(order, {}, [&](int i) { return std::tuple(key(i).direction, key(i).across, i); });
  for (std::size_t i = 1; i < order.size(); ++i) {  // one row: what lies apart by round-off alone
    const Key& before = key(order[i - 1]);
    Key& here = key(order[i]);
    if (here.direction == before.direction && here.across - before.across < 1e-9 * size) here.across = before.across;
  }
  std::ranges::sort(order, {}, [&](int i) { return std::tuple(key(i).direction, key(i).across, key(i).along, i); });
  return order;
}

void renumber(const std::vector<int>& order, FaceJoints& joints) {
  std::vector<JointPoint> points;
  std::vector<int> number(order.size());
  for (const int old : order) {
    number[static_cast<std::size_t>(old)] = static_cast<int>(points.size());
    points.push_back(std::move(joints.points[static_cast<std::size_t>(old)]));
  }
  joints.points = std::move(points);
  for (std::vector<int>& face : joints.of_face)
    for (int& k : face)
      if (k >= 0) k = number[static_cast<std::size_t>(k)];
}

}  // namespace uplift
