#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "uplift/mesh/mesh.h"

// Layered soil, a raft and a block building on it (or level ground): one conforming structured mesh, to be opened at "interface" by
// split().
//
//            +---------+            z (3D) or y (2D)
//            |  block  |            ^
//        +---+---------+---+        |
//   -----|       raft      |--------+---> x      soil surface at 0, middle of the raft's plan at 0
//        +-----------------+   depth of embedment
//     soil_1
//   ------------------------------------------
//     soil_2
namespace uplift {

/// Lengths in m; [0] is along x, [1] along y (3D only). Sizes are the most that an element of the part may measure; lines of the grid run
/// through all parts, so an element has the least of the sizes at its place.
struct SoilBox {
  struct Layer {
    double thickness = 0;
    double size = 1;  // vertical
  };
  struct Soil {
    std::array<double, 2> width{60, 60};
    std::vector<Layer> layers{{20, 1}};  // from top to bottom
    double size = 4;                     // horizontal, away from the foundation
  };
  struct Part {
    std::array<double, 2> width{10, 10};
    double height = 0;                   // 0: there is none
    std::array<double, 2> offset{0, 0};  // of its middle from the middle of the soil; raft: 0
    double size = 1;
  };
  int dimension = 2;
  Soil soil;
  Part raft, block;
  double embedment = 0;     // of the raft's bottom (of the block's, without raft) below the soil surface
  double growth = 1.25;     // from element to element, away from the foundation
  Cell cell = Cell::quad4;  // any type of the dimension
};

/// The mesh. Groups:
/// - parts: "soil_1" (top), "soil_2", ..., "raft", "block" (those that are there);
/// - outer sides of each part: "soil_left", "soil_right", "soil_front", "soil_back" (3D), "soil_bottom", "soil_top", and the same of
/// "raft_", "block_";
/// - "interface": faces between soil and raft or block, normals out of the soil: the bottom and, when embedded, the walls. Soil lies on a
/// ledge of
///   an embedded raft, too.
/// Throws InputError (keys "soil.width", "block.offset", ... of the structure above, after `path`): sizes, thicknesses not positive, sizes
/// below a millionth of the soil's width, growth outside ]1, 2], parts beyond the soil or the block beyond the raft, embedment not
/// less than the depth of the soil, not above the block's top, more than 50 million elements or more than `most`. The elements are counted
/// before anything of their number is made.
Mesh soil_box(const SoilBox& model, const Where& where, const std::string& path = {}, double most = HUGE_VAL);

}  // namespace uplift
