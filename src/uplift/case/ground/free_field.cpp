#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/base/text.h"
#include "uplift/case/ground/column.h"
#include "uplift/case/ground/ground.h"
#include "uplift/elements/absorbing.h"
#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"

// What the free field puts on a lateral face whose outward normal is n (docs/theory, eq 24):
//   t = c v_ff + sigma_ff n,     c of the viscous boundary, sigma_ff of the column's strains (and of their rates with stiffness damping).
namespace uplift {
namespace {

/// The faces of one side, in horizontal rows.
struct SideFaces {
  const CaseAbsorbing& absorbing;
  const CaseSolids& solids;
  const std::vector<CellId>& faces;
  int up;
  double tolerance = 0;  // m

  SideFaces(const CaseAbsorbing& table, const CaseNames& names)
      : absorbing(table), solids(names.mesh_for(table.group)), faces(solids.edges(table.group)), up(names.space.up()) {
    double low = INFINITY, high = -INFINITY;
    for (const int node : solids.nodes(table.group)) {
      low = std::min(low, place(node)[up]);
      high = std::max(high, place(node)[up]);
    }
    tolerance = 1e-6 * (high - low);
    if (!(tolerance > 0)) fail(table, "free_field", "free_field = false, or an upright face", "a level one");
  }
  const Vec3& place(int node) const { return solids.mesh().nodes[static_cast<std::size_t>(node)]; }
  bool same(double a, double b) const { return std::abs(a - b) <= tolerance; }

  /// The row of a face, from its lowest to its highest corner.
  ColumnLayer row_of(CellId face) const {
    const Mesh& mesh = solids.mesh();
    const CellInfo& type = info(mesh.type(face));
    const std::span<const int> nodes = mesh.cell(face);
    if (mesh.part(face))
      fail(absorbing, "group", "faces that no interface cuts, for their free field: a row of nodes at the level of its plane",
           "a part of " + describe_cell(mesh, face));
    const CaseSolids::Solid& solid = *solids.beside(face);
    ColumnLayer row{INFINITY, -INFINITY, type.nodes > type.corners, solid.section, solid.filling->damping_beta()};
    for (int i = 0; i < type.corners; ++i) {
      row.low = std::min(row.low, place(nodes[static_cast<std::size_t>(i)])[up]);
      row.high = std::max(row.high, place(nodes[static_cast<std::size_t>(i)])[up]);
    }
    for (const int node : nodes) {
      const double height = place(node)[up];
      if (!same(height, row.low) && !same(height, row.high) && !(row.quadratic && same(height, (row.low + row.high) / 2)))
        fail(absorbing, "group", "faces in horizontal rows, for their free field", describe_cell(mesh, face) + " across several heights");
    }
    return row;
  }

  /// All rows, each once, from the foot to the top.
  std::vector<ColumnLayer> rows() const {
    std::vector<ColumnLayer> rows;
    std::vector<const CaseSolids::Solid*> beside;
    std::vector<std::pair<double, CellId>> sorted;
    for (const CellId face : faces) sorted.emplace_back(row_of(face).low, face);
    std::ranges::sort(sorted, {}, [](const auto& each) { return each.first; });
    for (const auto& [low, face] : sorted) {
      const ColumnLayer row = row_of(face);
      const bool first = rows.empty(), above = !first && same(row.low, rows.back().high);
      if (first || above) {
        rows.push_back(row);
        beside.push_back(solids.beside(face));
      } else if (!same(row.low, rows.back().low) || !same(row.high, rows.back().high)) {
        fail(absorbing, "group", "faces in horizontal rows without gaps, for their free field",
             fmt::format("faces from {:g} m to {:g} m and from {:g} m to {:g} m", rows.back().low, rows.back().high, row.low, row.high));
      } else if (beside.back() != solids.beside(face)) {
        fail(absorbing, "group", "one solid at each height, for the free field",
             fmt::format("{} and {} at {:g} m", in_quotes(beside.back()->group()), in_quotes(solids.beside(face)->group()),
                         (row.low + row.high) / 2));
      }
    }
    return rows;
  }
};

/// The incident waves that come in below the foot of a side, all through the same faces.
std::vector<const CaseIncident*> waves_below(const CaseInput& input, const SideFaces& side, double foot) {
  std::vector<int> feet;
  for (const int node : side.solids.nodes(side.absorbing.group))
    if (side.same(side.place(node)[side.up], foot)) feet.push_back(node);
  const std::vector<std::size_t> first = first_on_faces(input, side.solids);
  std::vector<const CaseIncident*> found;
  std::size_t below = 0;  // the table whose faces they are
  for (std::size_t k = 0; k < input.absorbing.size(); ++k) {
    const CaseAbsorbing& absorbing = input.absorbing[k];
    if (!absorbing.incident) continue;
    const std::vector<int> nodes = side.solids.nodes(absorbing.group);
    if (std::ranges::none_of(nodes, [&](int node) { return std::ranges::find(feet, node) != feet.end(); })) continue;
    if (!found.empty() && first[k] != below)
      fail(side.absorbing, "free_field", "incident waves that come in through one group of faces below the face",
           fmt::format("those of {} and of {}", in_quotes(input.absorbing[below].group.name), in_quotes(absorbing.group.name)));
    found.push_back(&*absorbing.incident);
    below = first[k];
  }
  if (found.empty()) fail(side.absorbing, "free_field", "an absorbing face with an incident wave at its foot", "none");
  return found;
}

/// The directions of the column's unknowns in the model.
struct Axes {
  Vec3 along, up;
};

/// Writes the forces of one face into the pattern of a table of time loads.
class FacePattern {
 public:
  FacePattern(const CaseNames& names, const FreeField& field, const Axes& axes, double beta, std::vector<Triplet>& pattern)
      : names_(names), field_(field), axes_(axes), beta_(beta), pattern_(pattern) {}

  void add(const SideFaces& side, CellId face, const AbsorbingSection& section) {
    const Mesh& mesh = side.solids.mesh();
    const std::span<const int> nodes = mesh.cell(face);
    positions_.clear();
    for (const int node : nodes) positions_.push_back(side.place(node));
    add_dashpots(mesh.type(face), nodes, section);
    add_stress(side, face, section);
  }

 private:
  const Vec3& axis(int k) const { return k == 0 ? axes_.along : axes_.up; }
  int level_of(double height) const {
    const std::vector<double>& heights = field_.heights();
    return static_cast<int>(std::ranges::min_element(heights, {}, [&](double each) { return std::abs(each - height); }) - heights.begin());
  }
  void put(int node, const Vec3& force, int function) {
    for (int i = 0; i < names_.space.dimension; ++i)
      if (force[i] != 0) pattern_.emplace_back(names_.space.unknowns() * (names_.first_of_mesh + node) + i, function, force[i]);
  }

  /// C v_ff with the velocities of the column at the heights of the nodes.
  void add_dashpots(Cell cell, std::span<const int> nodes, const AbsorbingSection& section) {
    std::vector<int> own;
    for (std::size_t a = 0; a < nodes.size(); ++a) own.push_back(static_cast<int>(a));
    Matrix damping;
    AbsorbingFace(cell, own, std::make_shared<const std::vector<Vec3>>(positions_), section).form({nullptr, nullptr, &damping});
    const int d = names_.space.dimension;
    for (std::size_t b = 0; b < nodes.size(); ++b)
      for (int k = 0; k < 2; ++k) {
        const Vector force = damping.middleCols(d * static_cast<Index>(b), d) * axis(k).head(d);
        const int function = 2 * level_of(positions_[b][names_.space.up()]) + k;
        for (std::size_t a = 0; a < nodes.size(); ++a) {
          Vec3 part = Vec3::Zero();
          part.head(d) = force.segment(d * static_cast<Index>(a), d);
          put(nodes[a], part, function);
        }
      }
  }

  /// sigma_ff n with the strains of the column's layer at the height of each integration point.
  void add_stress(const SideFaces& side, CellId face, const AbsorbingSection& section) {
    const Mesh& mesh = side.solids.mesh();
    const Cell cell = mesh.type(face);
    const std::span<const int> nodes = mesh.cell(face);
    const ColumnLayer row = side.row_of(face);
    const double half = (row.high - row.low) / 2, middle = (row.high + row.low) / 2, beta = beta_ + row.beta;
    const Cell line = row.quadratic ? Cell::line3 : Cell::line2;
    const int levels[] = {level_of(row.low), level_of(row.high), level_of(middle)}, later = field_.functions() / 2;
    const double lame = section.material.lame(), shear = section.material.shear();
    const CellRule rule = cell_rule(cell, 5);
    for (std::size_t p = 0; p < rule.point.size(); ++p) {
      const CellShape shape = cell_shape(cell, rule.point[p]);
      const Vec3 place = cell_position(shape, positions_);
      Vec3 area = rule.weight[p] * (names_.space.dimension == 2 ? section.thickness : 1) * cell_area_vector(shape, positions_, cell);
      if (area.dot(place - side.solids.centre_beside(face)) < 0) area = -area;
      const CellShape height = cell_shape(line, Vec3((place[side.up] - middle) / half, 0, 0));
      for (int c = 0; c < height.nodes; ++c)
        for (int k = 0; k < 2; ++k) {
          const double slope = height.slope[static_cast<std::size_t>(c)][0] / half;  // strain per displacement of this node [1/m]
          const Vec3 traction = slope * (k == 0 ? Vec3(shear * (axes_.along * area.dot(axes_.up) + axes_.up * area.dot(axes_.along)))
                                                : Vec3(lame * area + 2 * shear * axes_.up * area.dot(axes_.up)));
          const int function = 2 * levels[c] + k;
          for (std::size_t a = 0; a < nodes.size(); ++a) {
            put(nodes[a], shape.value[a] * traction, later + function);
            if (beta != 0) put(nodes[a], beta * shape.value[a] * traction, function);
          }
        }
    }
  }

  const CaseNames& names_;
  const FreeField& field_;
  const Axes axes_;
  double beta_;
  std::vector<Triplet>& pattern_;
  std::vector<Vec3> positions_;
};

}  // namespace

void add_free_field(const CaseInput& input, const std::vector<Stage>& stages, const BulkDamping& damping,
                    const std::shared_ptr<const LinearSolver>& solver, ModelBuilder& builder, const CaseNames& names) {
  for (const CaseAbsorbing& absorbing : input.absorbing) {
    if (!absorbing.free_field) continue;
    if (absorbing.incident) fail(absorbing, "free_field", "free_field on the sides, the incident wave below them", "both");
    if (!damping.modal.empty()) fail(absorbing, "free_field", "Rayleigh damping with a free field", "modal damping");
    const SideFaces side(absorbing, names);
    std::vector<AbsorbingSection> sections;
    for (const CellId face : side.faces)
      sections.push_back(absorbing_ground(*absorbing.table, side.solids.beside(face)->beside(), names.space));
    const std::vector<ColumnLayer> rows = side.rows();
    for (const CaseIncident* incident : waves_below(input, side, rows.front().low)) {  // linear: a column for each wave, and their sum
      const Vec3 motion = incident_motion(*incident, names.space);
      Axes axes{Vec3::UnitX(), Vec3::Unit(names.space.up())};
      const Vec3 level = motion - motion.dot(axes.up) * axes.up;
      if (level.norm() > 0) axes.along = level.normalized();
      const auto field = std::make_shared<const FreeField>(
          rows, ColumnWave{level.norm(), motion.dot(axes.up), incident_velocity(*incident, names), incident->name}, damping, stages,
          solver);
      if (!field->why().empty()) fail(absorbing, "free_field", "a free field that can be marched", field->why());
      std::vector<Triplet> pattern;
      FacePattern faces(names, *field, axes, damping.beta, pattern);
      for (std::size_t i = 0; i < side.faces.size(); ++i) faces.add(side, side.faces[i], sections[i]);
      builder.add_feed("free field of " + absorbing.group.name, std::move(pattern), field->functions(), field);
    }
  }
}

}  // namespace uplift
