#include "uplift/model/equal_cells.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "uplift/elements/solid.h"

namespace uplift {

namespace {

/// Finds the class of one element after another.
class Classes {
 public:
  explicit Classes(const std::vector<Node>& nodes) : nodes_(nodes) {
    double largest = 0;
    for (const Node& node : nodes) largest = std::max(largest, Vec3(node.position).cwiseAbs().maxCoeff());
    room_ = 16 * std::numeric_limits<double>::epsilon() * largest;
  }
  /// A class begins with its first element. Equal elements on both sides of a rounded size may be in two classes.
  std::size_t class_of(const Solid& solid) {
    if (last_ < first_.size() && equal(*first_[last_], solid)) return last_;
    std::vector<std::size_t>& like_it = like_[key(solid)];
    for (const std::size_t one : like_it)
      if (equal(*first_[one], solid)) return last_ = one;
    like_it.push_back(first_.size());
    first_.push_back(&solid);
    return last_ = first_.size() - 1;
  }

 private:
  const Vec3& at(int node) const { return nodes_[static_cast<std::size_t>(node)].position; }
  bool equal(const Solid& one, const Solid& other) const {
    if (one.cell() != other.cell() || one.beta != other.beta || *one.continuum() != *other.continuum()) return false;
    const std::span<const int> nodes = one.nodes(), others = other.nodes();
    for (std::size_t a = 1; a < nodes.size(); ++a)
      if (((at(nodes[a]) - at(nodes[0])) - (at(others[a]) - at(others[0]))).cwiseAbs().maxCoeff() > room_) return false;
    return true;
  }
  /// Of the edges at the first node and the stiffness, in six digits.
  static std::uint64_t digits(double value) { return static_cast<std::uint64_t>(std::llround(value * 1e6)); }
  std::uint64_t key(const Solid& solid) const {
    std::uint64_t mixed = static_cast<std::uint64_t>(std::llround(1e3 * std::log(solid.continuum()->material.young)));
    const std::span<const int> nodes = solid.nodes();
    for (std::size_t a = 1; a < nodes.size(); ++a) {
      const Vec3 edge = at(nodes[a]) - at(nodes[0]);
      for (int i = 0; i < 3; ++i) mixed = (mixed ^ digits(edge[i])) * 0x9e3779b97f4a7c15U, mixed ^= mixed >> 29;
    }
    return mixed;
  }

  const std::vector<Node>& nodes_;
  double room_ = 0;
  std::size_t last_ = 0;
  std::vector<const Solid*> first_;  // of each class
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> like_;
};

/// Ties may leave the element one unknown for two of its own.
bool all_different(std::vector<int> rows) {
  std::ranges::sort(rows);
  const auto first = std::ranges::lower_bound(rows, 0);
  return std::adjacent_find(first, rows.end()) == rows.end();
}

/// The row of a full unknown; -1: it is held. False: it is a sum of free unknowns or a multiple of one.
bool find_row(const Sparse& expansion, int full, int& row) {
  Sparse::InnerIterator entry(expansion, full);
  row = -1;
  if (!entry) return true;
  row = static_cast<int>(entry.row());
  return entry.value() == 1 && !++entry;
}

}  // namespace

EqualElements find_equal_elements(Space space, const std::vector<Node>& nodes, const std::vector<std::unique_ptr<const Element>>& elements,
                                  const Sparse& expansion) {
  Classes classes(nodes);
  EqualElements found;
  std::vector<int> rows;
  const auto find_rows = [&](const Element& element) {  // false: not of all unknowns
    rows.clear();
    bool simple = true;
    for (const int node : element.nodes())
      for (int i = 0; i < element.unknowns_per_node(); ++i)
        simple = simple && find_row(expansion, space.unknowns() * node + i, rows.emplace_back());
    return simple;
  };
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const auto* solid = dynamic_cast<const Solid*>(elements[e].get());
    if (solid == nullptr || !solid->is_whole()) continue;
    if (!find_rows(*solid) || !all_different(rows) || std::ranges::all_of(rows, [](int row) { return row < 0; })) continue;
    const std::size_t number = classes.class_of(*solid);
    if (number >= found.classes.size()) found.classes.resize(number + 1);
    found.classes[number].push_back(static_cast<int>(e));
  }
  std::erase_if(found.classes, [](const std::vector<int>& one) { return std::ssize(one) < least_equal; });
  for (const std::vector<int>& one : found.classes) {  // the rows are many: not before their number is known
    EqualCells& cells = found.cells.emplace_back();
    for (const int element : one) {
      find_rows(*elements[static_cast<std::size_t>(element)]);
      cells.unknowns = static_cast<int>(rows.size());
      cells.rows.reserve(rows.size() * one.size());
      cells.rows.insert(cells.rows.end(), rows.begin(), rows.end());
    }
  }
  found.among.assign(elements.size(), 0);
  for (const std::vector<int>& one : found.classes)
    for (const int element : one) found.among[static_cast<std::size_t>(element)] = 1;
  return found;
}

}  // namespace uplift
