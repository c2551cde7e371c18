#pragma once
#include <array>
#include <set>
#include <span>
#include <vector>

#include "uplift/mesh/cut.h"
#include "uplift/mesh/parts.h"
#include "uplift/mesh/sides.h"

// The first part of a cut (cut.cpp): which parts of each cell a plane leaves filled. It changes nothing.
namespace uplift {

/// A mesh between two cuts. Empty cells are only marked: `compact` removes them after the last plane.
struct CutWork {
  Mesh mesh;
  std::vector<std::vector<bool>> removed = {};  // of each cell
  std::set<CellId> lines = {};                  // beams and points, no faces of cells
};

/// Removes marked cells and nodes that nothing uses.
void compact(CutWork& work, std::vector<std::vector<CutFace>>& faces, std::vector<std::vector<FreeFace>>& free);

/// Which parts of a cell are filled after a cut.
struct Halves {
  bool lower = false, upper = false;
  bool lower_whole = true, upper_whole = true;
  int outline = 0;  // that holds the upper part
};

/// A cell of the mesh as it was before the cut: the numbers of nodes and cells change under way.
struct CellBefore {
  Cell cell;
  double tolerance;  // m
  std::size_t count = 0;
  std::array<Vec3, max_corners> places = {};
  std::span<const Vec3> corners() const { return {places.data(), count}; }
};

class CutFilling {
 public:
  /// Throws InputError as `cut` does. All arguments must outlive it.
  CutFilling(const CutWork& work, const CutPlane& plane, const Where& where);

  /// The cells of the groups that are cut, and what is filled of each.
  const Sides& sides() const { return sides_; }
  const std::vector<Halves>& halves() const { return halves_; }
  /// Of a cell of the mesh: its number in sides().cells(), less than 0 for none.
  int number(CellId id) const { return number_[static_cast<std::size_t>(id.block)][static_cast<std::size_t>(id.index)]; }
  /// Cells of the groups beyond the extent of the plane.
  const std::vector<CellId>& beyond() const { return beyond_; }
  bool is_beyond(CellId id) const { return number(id) == beyond_extent; }
  /// Of a node: below the plane -1, on it 0, above it 1.
  int sign(int node) const { return sign_[static_cast<std::size_t>(node)]; }
  /// Whether a node lies within an outline, on its border included.
  bool is_within(int node) const;
  /// Whether a place does.
  bool is_within(const Vec3& place, double tolerance) const;

  /// Faces on the plane between a cell below and one above it.
  struct LevelFace {
    int lower, upper;  // numbers of the cells
    std::vector<Vec3> corners;
  };
  const std::vector<LevelFace>& level_faces() const { return level_; }
  /// Faces on the plane of cells below it on which nothing stands.
  struct BareFace {
    int lower;  // number of the cell
    std::vector<Vec3> corners;
  };
  std::vector<BareFace> bare_faces() const;

  CellBefore before(CellId id) const;
  /// Limits of what lies above the plane within an outline.
  std::span<const HalfSpace> above(int outline) const { return above_[static_cast<std::size_t>(outline)]; }
  /// Finds the outline that holds the upper part of a cell.
  void keep_within(const CellBefore& cell, Halves& halves) const;

 private:
  static constexpr int no_number = -1, beyond_extent = -2;
  std::vector<CellId> cells_of_groups();
  bool is_in_extent(CellId id) const;
  void find_signs();
  Halves halves_of(CellId id) const;
  Halves halves_of_part(CellId id) const;
  bool is_empty(const CellBefore& cell, std::span<const HalfSpace> within) const;
  void find_level_faces();
  std::vector<Vec3> corners_on_plane(int cell, int side, std::vector<int>& nodes) const;
  void refuse_nothing() const;

  const CutWork& work_;
  const Mesh& mesh_;
  const CutPlane& plane_;
  const Where& where_;
  const std::vector<std::vector<HalfSpace>> above_;  // of each outline
  std::vector<std::vector<int>> number_;
  std::vector<CellId> beyond_;
  Sides sides_;
  std::vector<Halves> halves_;
  std::vector<signed char> sign_;
  std::vector<double> edge_;  // m: the shortest edge of cells of the groups at each node
  std::vector<LevelFace> level_;
};

}  // namespace uplift
