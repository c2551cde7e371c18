#pragma once
// A block on soil, in plane strain and in space, for benchmarks. Soil 60 (x 60) x 20 m, E = 200 MPa, nu = 0.3, rho = 2000 kg/m3; block 10
// (x 10) x 20 m, E = 20 GPa, nu = 0.2, rho = 2500 kg/m3; 4-node quads or 8-node bricks with incompatible modes; tensionless frictionless
// base, 2e10 Pa/m; bottom fixed, sides on rollers; gravity, then a half-sine of 3 MN/m (30 MN) and 0.1 s on the block's top.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "uplift/elements/discrete.h"
#include "uplift/elements/solid.h"
#include "uplift/interface/face_joint.h"
#include "uplift/laws/law.h"
#include "uplift/mesh/soil_box.h"
#include "uplift/model/builder.h"

namespace uplift {

class HalfSine final : public TimeFunction {
 public:
  double value(double t) const override { return t < duration ? std::sin(omega * t) : 0; }
  double rate(double t) const override { return t < duration ? omega * std::cos(omega * t) : 0; }
  double acceleration(double t) const override { return -omega * omega * value(t); }

 private:
  static constexpr double duration = 0.1, omega = std::numbers::pi / duration;
};

inline Values part(std::span<const PartInfo* const> catalog, std::string type, const std::vector<std::pair<std::string, double>>& numbers,
                   const char* tangential = nullptr) {
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{std::move(type), {}, ""});
  if (tangential != nullptr) table->entries.emplace_back("tangential", Raw{std::string(tangential), {}, ""});
  for (const auto& [name, number] : numbers) table->entries.emplace_back(name, Raw{number, {}, ""});
  return check_part(Raw{table, {}, ""}, catalog);
}

struct Setup {
  Space space;
  bool friction = false;
};

inline Model block_on_soil(double size, Setup kind) {
  const Space space = kind.space;
  SoilBox box;
  box.dimension = space.dimension;
  box.cell = space.dimension == 2 ? Cell::quad4 : Cell::hex8;
  box.block.size = size;
  box.soil.size = kind.friction ? 8 * size : size;  // many node pairs on a bulk of the wanted size
  box.soil.layers = {{20, kind.friction ? 3 * size : size}};
  box.block.height = 20;
  Mesh mesh = soil_box(box, {});
  const std::vector<OpenedSurface> opened = split(mesh, {"interface"}, {"soil_1"}, {});
  const auto coordinates = std::make_shared<const std::vector<Vec3>>(mesh.nodes);

  ModelBuilder builder(space);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) builder.add_node(fmt::format("mesh.{}", i + 1), mesh.nodes[i], {});
  const auto add_solids = [&](const char* group, const ElasticMaterial& material) {
    SolidSection section;
    section.material = material;
    for (const CellId id : mesh.groups.at(group).cells)
      builder.add_element(std::make_unique<Solid>(mesh.type(id), mesh.cell(id), coordinates, section), {});
  };
  add_solids("soil_1", {200e6, 0.3, 2000});
  add_solids("block", {20e9, 0.2, 2500});
  std::set<std::pair<int, Dof>> held;
  const auto fix = [&](const char* group, std::initializer_list<Dof> dofs) {
    for (const int node : nodes_of(mesh, mesh.groups.at(group)))
      for (const Dof dof : dofs)
        if (space.has(dof) && held.emplace(node, dof).second) builder.fix(node, dof, {});
  };
  fix("soil_bottom", {ux, uy, uz});
  fix("soil_left", {ux});
  fix("soil_right", {ux});
  if (space.dimension == 3) fix("soil_front", {uy}), fix("soil_back", {uy});
  const std::vector<int> top = nodes_of(mesh, mesh.groups.at("block_top"));
  std::vector<std::pair<int, double>> pattern;
  double shares = 0;  // of the top that belong to a node: a half along each edge
  for (const int node : top) {
    double share = 1;
    for (int k = 0; k < space.up(); ++k)
      if (std::abs(std::abs(mesh.nodes[static_cast<std::size_t>(node)][k]) - 5) < 1e-6) share /= 2;
    pattern.emplace_back(space.at(node, ux), share);
    shares += share;
  }
  for (auto& [unknown, value] : pattern) value *= (space.dimension == 2 ? 3e6 : 30e6) / shares;
  builder.add_load("pulse", pattern, std::make_shared<HalfSine>(), false, {});
  builder.set_gravity(-9.81 * space.axis(space.up()), {});
  // nothing else holds the block sideways under gravity on a frictionless base; 0.02 Hz is far below everything that happens in a second
  if (!kind.friction) {
    builder.add_element(std::make_unique<Spring>(Connection{{top.front()}, Place(1, 0), space}, 1e4), {});
    if (space.dimension == 3)
      for (const int node : {top.front(), top.back()})
        builder.add_element(std::make_unique<Spring>(Connection{{node}, Place(0, 1), space}, 1e4), {});
  }
  InterfaceSpec base;
  base.name = "base";
  base.components = kind.friction ? 3 : 1;
  base.points = face_points(mesh, opened[0].faces, FaceQuadrature::nodal, 1, 0);
  using Numbers = std::vector<std::pair<std::string, double>>;
  const Numbers smooth{{"K_n", 2e10}}, rough{{"K_n", 2e10}, {"K_t", 1e10}, {"friction", 0.7}};
  base.law =
      make_part(law_catalog(), part(interface_behaviours(), "springs", kind.friction ? rough : smooth, kind.friction ? "coulomb" : "none"));
  base.behaviour = "springs";
  builder.add_interface(std::move(base), {});
  return builder.finish();
}

}  // namespace uplift
