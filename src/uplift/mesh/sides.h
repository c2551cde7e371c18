#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "uplift/mesh/mesh.h"

// Which cells lie side by side: by the numbers of their nodes alone, in time proportional to the number of cells.
namespace uplift {

/// Numbers sets of nodes (edges, faces), each set once, from 0. A set is known by its two to four corners and the sum of its other nodes:
/// that tells the faces of the two faces of an opened surface apart when only nodes in the middle of edges were doubled. Sets are chained
/// at their lowest corner, so neighbours in the mesh are neighbours in memory.
class NodeSets {
 public:
  explicit NodeSets(std::size_t nodes) : head_(nodes, -1) {}
  /// The set's number; `size()` grows by one when the set is new.
  int insert(std::span<const int> corners, std::span<const int> others = {});
  /// -1 when the set is not there.
  int find(std::span<const int> corners, std::span<const int> others = {}) const;
  int size() const { return static_cast<int>(sets_.size()); }

 private:
  struct Set {
    std::array<int, 3> above;  // the corners but the lowest, ascending, filled up with -1
    int next;                  // in the chain of the lowest corner
    std::int64_t others;
  };
  int in_chain(int lowest, const Set& set) const;
  std::vector<int> head_;
  std::vector<Set> sets_;
};

/// Sides of cells of full dimension, each with its twin: the same side of the cell beyond. Sides are numbered 6 * cell + side.
class Sides {
 public:
  static constexpr int stride = 6;  // the most sides that a cell has

  /// `cells` are of the mesh's dimension. Nodes must not change as long as `find` is used.
  Sides(const Mesh& mesh, std::vector<CellId> cells);
  const std::vector<CellId>& cells() const { return cells_; }
  /// The same side of the cell beyond, -1 where no cell of `cells` is.
  int twin(int side) const { return twin_[static_cast<std::size_t>(side)]; }
  /// A side that more than two cells share (cells overlap there); -1: none.
  int crowded() const { return crowded_; }
  /// A side with the nodes of this face (an edge in plane meshes), -1: none.
  int find(Cell face, std::span<const int> nodes) const;
  /// Nodes of a side, numbered with its normal out of its cell.
  void nodes_of(const Mesh& mesh, int side, std::vector<int>& nodes) const;
  int count(int cell) const { return counts_[static_cast<std::size_t>(cell)]; }

 private:
  std::vector<CellId> cells_;
  std::vector<unsigned char> counts_;
  std::vector<int> twin_, first_;  // first_: of each set, the side that came first
  int crowded_ = -1;
  NodeSets sets_;
};

/// All cells of the mesh's dimension.
std::vector<CellId> full_cells(const Mesh& mesh);

}  // namespace uplift
