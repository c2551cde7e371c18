#pragma once
#include <string>
#include <vector>

#include "uplift/mesh/mesh.h"

// How good the cells are, what waves they can carry, and what is connected.
namespace uplift {

struct CellQuality {
  double shortest = 0, longest = 0;  // edges between corners [m]
  double aspect = 1;                 // longest / shortest
  /// Least scaled Jacobian at the corners: determinant of the directions of the edges there, divided by their lengths and by the value of
  /// the ideal cell (equilateral, square): 1 is ideal, <= 0 is unusable (Stimpson et al., The Verdict Geometric Quality Library,
  /// SAND2007-1751). Curved edges of cells of second degree count with their tangents at the corners. Surfaces in space: against their mean
  /// normal. Lines: 1.
  double jacobian = 1;
};
/// Of a line, a surface or a volume.
CellQuality quality(const Mesh& mesh, CellId id);

struct GroupQuality {
  std::string name;
  int cells = 0;
  double shortest = 0, longest = 0;  // the least and the largest edge [m]
  double spacing = 0;                // the largest distance of neighbouring nodes [m]: longest edge, half of it in cells of second degree
  double aspect = 1, jacobian = 1;   // the worst
  CellId most_slender, most_distorted;  // the cells with them
};
/// Of each group of lines, surfaces or volumes, in the order of names.
std::vector<GroupQuality> quality_by_group(const Mesh& mesh);

/// Highest frequency [Hz] that the group carries with so many nodes per wavelength: speed [m/s] / (points * spacing).
double highest_frequency(const GroupQuality& group, double speed, double points_per_wavelength);

/// Parts of the mesh that share no node with each other.
struct Pieces {
  std::vector<std::vector<int>> nodes;  // of each piece, ascending; pieces by their lowest node
  std::vector<int> unused;              // nodes that no cell has, ascending
  int count() const { return static_cast<int>(nodes.size()); }
};
Pieces connected_pieces(const Mesh& mesh);

}  // namespace uplift
