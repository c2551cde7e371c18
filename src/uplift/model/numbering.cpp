#include "uplift/model/numbering.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace uplift {

namespace {

/// Nodes that stay together, each cluster with the number of its free unknowns. A node has those that it keeps.
class Clusters {
 public:
  explicit Clusters(const Model& model)
      : nodes_(static_cast<std::size_t>(model.full_unknowns() / model.space.unknowns())), unknowns_(nodes_.size(), 0) {
    std::iota(nodes_.begin(), nodes_.end(), 0);
    for (const int full : model.kept) ++unknowns_[static_cast<std::size_t>(model.space.node_of(full))];
  }
  int of(int node) {
    auto at = static_cast<std::size_t>(node);
    while (nodes_[at] != static_cast<int>(at)) at = static_cast<std::size_t>(nodes_[at] = nodes_[static_cast<std::size_t>(nodes_[at])]);
    return static_cast<int>(at);
  }
  int unknowns(int cluster) const { return unknowns_[static_cast<std::size_t>(cluster)]; }
  /// The cluster with the lower number stays.
  void join(int one, int other) {
    const auto [first, second] = std::minmax({of(one), of(other)});
    if (first == second) return;
    nodes_[static_cast<std::size_t>(second)] = first;
    unknowns_[static_cast<std::size_t>(first)] += std::exchange(unknowns_[static_cast<std::size_t>(second)], 0);
  }
  int nodes() const { return static_cast<int>(nodes_.size()); }

 private:
  std::vector<int> nodes_;     // of each node one of its cluster with a lower number, or itself
  std::vector<int> unknowns_;  // of the first nodes of clusters
};

/// Those that a free unknown moves together are one.
void join_tied(const Model& model, Clusters& clusters) {
  const Space space = model.space;
  for (int full = 0; full < model.full_unknowns(); ++full)
    for (Sparse::InnerIterator entry(model.expansion, full); entry; ++entry)
      clusters.join(space.node_of(full), space.node_of(model.kept[static_cast<std::size_t>(entry.row())]));
}

/// The nodes with unknowns that each row of an interface connects.
std::vector<std::vector<int>> nodes_of_rows(const Model& model, Clusters& clusters) {
  std::vector<std::vector<int>> nodes(static_cast<std::size_t>(model.assembly.b.rows()));
  for (int full = 0; full < model.assembly.b.cols(); ++full) {
    const int cluster = clusters.of(model.space.node_of(full));
    if (clusters.unknowns(cluster) == 0) continue;
    for (Sparse::InnerIterator entry(model.assembly.b, full); entry; ++entry) {
      std::vector<int>& row = nodes[static_cast<std::size_t>(entry.row())];
      if (row.empty() || row.back() != cluster) row.push_back(cluster);
    }
  }
  return nodes;
}

/// Whether the clusters of some nodes have so few unknowns together that they may be one.
bool fit(std::vector<int> nodes, Clusters& clusters, int most) {
  for (int& node : nodes) node = clusters.of(node);
  std::ranges::sort(nodes);
  nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
  return std::accumulate(nodes.begin(), nodes.end(), 0, [&](int sum, int node) { return sum + clusters.unknowns(node); }) <= most;
}

void join_interfaces(const Model& model, int most, Clusters& clusters) {
  const std::vector<std::vector<int>> rows = nodes_of_rows(model, clusters);
  const auto join = [&](const std::vector<int>& nodes) {
    if (!fit(nodes, clusters, most)) return;
    for (const int node : nodes) clusters.join(nodes.front(), node);
  };
  auto row = rows.begin();
  for (const Interface& interface : model.interfaces) {
    const auto end = row + interface.rows();
    std::vector<int> all;
    for (auto each = row; each != end; ++each) all.insert(all.end(), each->begin(), each->end());
    if (fit(all, clusters, most))
      join(all);
    else
      std::for_each(row, end, join);
    row = end;
  }
}

/// The clusters that have unknowns, numbered in the order of their first nodes; -1: has none.
std::vector<int> number_clusters(Clusters& clusters, std::vector<int>& unknowns) {
  std::vector<int> vertex(static_cast<std::size_t>(clusters.nodes()), -1);
  for (int node = 0; node < clusters.nodes(); ++node) {
    if (clusters.of(node) != node || clusters.unknowns(node) == 0) continue;
    vertex[static_cast<std::size_t>(node)] = static_cast<int>(unknowns.size());
    unknowns.push_back(clusters.unknowns(node));
  }
  for (int node = 0; node < clusters.nodes(); ++node)
    vertex[static_cast<std::size_t>(node)] = vertex[static_cast<std::size_t>(clusters.of(node))];
  return vertex;
}

}  // namespace

std::vector<int> numbers_by_parts(const Model& model, const std::vector<std::unique_ptr<const Element>>& elements, const MatrixHome& home,
                                  std::vector<int>& firsts) {
  CoupledVertices graph;
  std::vector<int> vertex;  // of each node
  {
    Clusters clusters(model);
    join_tied(model, clusters);
    join_interfaces(model, model.free() / (2 * home.processes()), clusters);
    number_clusters(clusters, graph.unknowns).swap(vertex);
  }
  graph.each_set = [&](const CoupledVertices::TakeSet& take) {
    std::vector<int> set;
    for (const auto& element : elements) {
      set.clear();
      for (const int node : element->nodes())
        if (const int one = vertex[static_cast<std::size_t>(node)]; one >= 0) set.push_back(one);
      std::ranges::sort(set);
      set.erase(std::ranges::unique(set).begin(), set.end());
      if (set.size() > 1) take(set);
    }
  };
  const std::vector<int> part = home.divide(graph);
  const auto part_of = [&](int full) {
    return static_cast<std::size_t>(part[static_cast<std::size_t>(vertex[static_cast<std::size_t>(model.space.node_of(full))])]);
  };
  firsts.assign(static_cast<std::size_t>(home.processes()) + 1, 0);
  for (const int full : model.kept) ++firsts[part_of(full) + 1];
  std::partial_sum(firsts.begin(), firsts.end(), firsts.begin());
  std::vector<int> next(firsts.begin(), firsts.end() - 1), number;
  number.reserve(model.kept.size());
  for (const int full : model.kept) number.push_back(next[part_of(full)]++);
  return number;
}

std::vector<int> numbers_by_nodes(const Model& model) {
  std::vector<int> number;
  if (std::ranges::is_sorted(model.kept)) return number;
  std::vector<int> order(model.kept.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int free) { return model.kept[static_cast<std::size_t>(free)]; });
  return inverse(order);
}

std::vector<int> inverse(const std::vector<int>& number) {
  std::vector<int> before(number.size());
  for (std::size_t i = 0; i < number.size(); ++i) before[static_cast<std::size_t>(number[i])] = static_cast<int>(i);
  return before;
}

namespace {

/// The rows of a matrix, each to its new place.
void renumber_rows(const std::vector<int>& number, Sparse& matrix) {
  std::vector<std::pair<int, double>> column;
  for (Index j = 0; j < matrix.cols(); ++j) {
    column.clear();
    for (Sparse::InnerIterator entry(matrix, j); entry; ++entry)
      column.emplace_back(number[static_cast<std::size_t>(entry.row())], entry.value());
    std::ranges::sort(column);
    auto next = static_cast<std::size_t>(matrix.outerIndexPtr()[j]);
    for (const auto& [row, value] : column) matrix.innerIndexPtr()[next] = row, matrix.valuePtr()[next++] = value;
  }
}

}  // namespace

void renumber(const std::vector<int>& number, Vector& vector) {
  if (vector.size() != std::ssize(number)) return;
  const Vector before = vector;
  for (std::size_t i = 0; i < number.size(); ++i) vector[number[i]] = before[static_cast<Index>(i)];
}

void renumber(const std::vector<int>& number, Model& model) {
  std::vector<int> kept(number.size());
  for (std::size_t i = 0; i < number.size(); ++i) kept[static_cast<std::size_t>(number[i])] = model.kept[i];
  kept.swap(model.kept);
  renumber_rows(number, model.expansion);
  for (Interface& interface : model.interfaces) {
    Sparse columns = interface.b.transpose();
    renumber_rows(number, columns);
    interface.b = columns.transpose();
  }
  for (TimeLoad& load : model.time_loads) renumber(number, load.shape);
  for (TimeLoadTable& table : model.time_load_tables) renumber_rows(number, table.pattern);
}

}  // namespace uplift
