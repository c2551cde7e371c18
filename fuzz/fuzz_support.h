#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "uplift/base/error.h"
#include "uplift/mesh/mesh.h"

namespace uplift {

/// Ends the fuzzer when a mesh that a reader returned refers to nodes or cells that are not there.
inline void require_consistent(const Mesh& mesh) {
  const auto require = [](bool condition) {
    if (!condition) __builtin_trap();
  };
  const auto count = static_cast<int>(mesh.nodes.size());
  for (const Vec3& x : mesh.nodes) require(std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]));
  for (const CellBlock& block : mesh.blocks) {
    require(block.nodes.size() % static_cast<std::size_t>(info(block.cell).nodes) == 0);
    for (const int node : block.nodes) require(node >= 0 && node < count);
  }
  for (const auto& [name, group] : mesh.groups) {
    require(!name.empty());
    for (std::size_t i = 0; i < group.cells.size(); ++i) {
      const CellId id = group.cells[i];
      require(id.block >= 0 && id.block < static_cast<int>(mesh.blocks.size()) && id.index >= 0);
      require(id.index < mesh.blocks[static_cast<std::size_t>(id.block)].count() && info(mesh.type(id)).dimension == group.dimension);
      require(i == 0 || group.cells[i - 1] < id);
    }
    for (const int node : nodes_of(mesh, group)) require(node >= 0 && node < count);
  }
}

}  // namespace uplift
