#include "uplift/case/advice/interface_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "uplift/base/format.h"
#include "uplift/case/build/output.h"
#include "uplift/case/ground/ground.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/interface/cut_joint.h"
#include "uplift/laws/macro_element.h"
#include "uplift/model/rigid_parts.h"

namespace uplift {
namespace {

/// Largest distance between nodes and points of interfaces, in one direction [m].
double extent(const Model& model) {
  Vec3 least = model.nodes.front().position, most = least;
  const auto take = [&](const Vec3& place) { least = least.cwiseMin(place), most = most.cwiseMax(place); };
  for (const Node& node : model.nodes) take(node.position);
  for (const Interface& interface : model.interfaces)
    for (const Vec3& place : interface.position) take(place);
  return (most - least).maxCoeff();
}

/// Gaps are small beside a structure.
void warn_gaps(const BuiltCase& built, std::vector<std::string>& said) {
  constexpr double most = 0.1;
  if (built.model.nodes.empty()) return;
  const double size = extent(built.model);
  for (const Interface& interface : built.model.interfaces) {
    if (const double overlap = -interface.gap.minCoeff(); overlap > 0)
      said.push_back(
          fmt::format("interface \"{}\": a negative gap: its sides overlap by up to {} before any load and press each other apart; a gap "
                      "between them is positive",
                      interface.name, format_quantity(overlap, "m")));
    if (const double gap = interface.gap.maxCoeff(); size > 0 && gap > most * size)
      said.push_back(
          fmt::format("interface \"{}\": an initial gap of {} in a model of {} will hardly close (joints have gaps of "
                      "millimetres to centimetres); is the unit right?",
                      interface.name, format_quantity(gap, "m"), format_quantity(size, "m")));
  }
}

void warn_sides_exchanged(const Case& read, const BuiltCase& built, std::vector<std::string>& said) {
  const std::vector<CaseInterface>& interfaces = read.input->interfaces;
  const CaseSurface* surface = interfaces.size() == 1 ? interfaces.front().surface() : nullptr;
  if (!surface || !(built.weight() < 0)) return;
  if (interfaces.front().water || !surface->group) return;  // see warn_floating
  said.push_back(fmt::format("{}:{}: the dead load of {} pulls the upper side off the lower one: does `lower` name the side that bears?",
                             surface->where("lower").file, surface->where("lower").line, format_quantity(-built.weight(), "N")));
}

void warn_floating(const Case& read, const BuiltCase& built, std::vector<std::string>& said) {
  const auto wet = [](const CaseInterface& interface) { return interface.water.has_value(); };
  if (built.weight() > 0 || std::ranges::none_of(read.input->interfaces, wet)) return;
  said.push_back(fmt::format("the water pressure exceeds the dead load on \"{}\" by {}: the structure floats", built.facts.front().name,
                             format_quantity(-built.weight(), "N")));
}

bool states_all_stiffnesses(const Values& model, Space space) {
  return std::ranges::all_of(foundation_stiffness_keys(space.dimension == 2 ? 3 : 6), [&](const char* key) { return model.has(key); });
}

void warn_foundations(const Case& read, const BuiltCase& built, std::vector<std::string>& said) {
  const auto comes_in = [](const CaseAbsorbing& face) { return face.incident.has_value(); };
  const bool waves = std::ranges::any_of(read.input->absorbing, comes_in);
  for (const CaseFoundation& foundation : read.input->foundations) {
    const std::string place = fmt::format("{}:{}: ", foundation.where().file, foundation.where().line);
    if (foundation.soil && !foundation.radiates && states_all_stiffnesses(*foundation.model, built.model.space))
      said.push_back(place + fmt::format("the soil of \"{}\" has no effect: the model states all stiffnesses", foundation.name.name));
    if (waves)
      said.push_back(place +
                     fmt::format("the ground under \"{}\" does not move with the incident wave: it stands still", foundation.name.name));
    if (built.model.interfaces.size() != 1) continue;
    const MacroElement* ground = as_macro_element(built.model.interfaces.front().law.get());
    if (ground == nullptr || !ground->surfaces().has_bearing()) continue;
    constexpr double least_reserve = 1.05;
    const double capacity = ground->surfaces().strength().ultimate, service = ground->surfaces().strength().service;
    const std::string_view outcome = built.weight() >= capacity ? "unless other parts bear the rest, there is no equilibrium"
                                                                : "hardly any moment or horizontal force is left to it without settlement";
    if (least_reserve * built.weight() >= std::min(capacity, service))
      said.push_back(place + fmt::format("the dead load is {}, the capacity of \"{}\" {}: {}", format_quantity(built.weight(), "N"),
                                         foundation.name.name, format_quantity(built.weight() >= capacity ? capacity : service, "N"),
                                         outcome));
  }
}

/// A joint that the dead load compresses by more than any ground settles.
void warn_settlement(const BuiltCase& built, std::vector<std::string>& said) {
  constexpr double most = 0.5;  // m
  double stiffness = 0;         // N/m
  for (std::size_t k = 0; k < built.bases(); ++k) {
    const Interface& base = built.model.interfaces[k];
    if (base.law == nullptr || base.batch.rotations > 0) return;
    std::array<double, most_components> of_area{};
    base.law->closed_stiffness(base.batch.components, of_area.data());
    stiffness += of_area[static_cast<std::size_t>(base.batch.translations()) - 1] * built.facts[k].area;
  }
  if (stiffness > 0 && built.weight() / stiffness > most)
    said.push_back(fmt::format("the dead load of {} compresses the joint by {}: is the unit of its normal stiffness right?",
                               format_quantity(built.weight(), "N"), format_quantity(built.weight() / stiffness, "m")));
}

/// A base that nothing but the shaking holds.
void warn_unloaded(const Case& read, const BuiltCase& built, std::vector<std::string>& said) {
  const bool shaken = !read.input->grounds.empty() || !read.input->motions.empty();
  if (!shaken || built.weight() != 0 || built.bases() == 0 || !read.input->loads.empty()) return;
  const auto presses = [](const PrescribedMotion& motion) { return !motion.opening.isZero(0); };  // or lifts it, as is asked for
  if (std::ranges::any_of(built.model.motions, presses)) return;
  const auto opens = [](const Interface& each) {  // see warn_closure for laws with a closure stress
    const LawScales scales = each.law != nullptr ? each.law->scales() : LawScales();
    return scales.opens && scales.strength <= 0 && scales.closure <= 0;
  };
  if (std::ranges::any_of(built.model.interfaces, opens))
    said.push_back("nothing presses the base down, and it opens under any motion: [gravity] is missing");
}

/// A body on an interface that a support holds can neither turn nor lift off. In space one rocking axis alone is held by the symmetry of
/// half a model or of a plane motion.
void warn_held_bodies(const BuiltCase& built, std::vector<std::string>& said) {
  constexpr double along = 0.5;  // the normal
  const Space space = built.model.space;
  for (std::size_t k = 0; k < built.bases(); ++k) {
    const InterfaceFacts& facts = built.facts[k];
    const int node = facts.body.empty() ? -1 : built.model.find_node(facts.body);
    if (node < 0) continue;
    const Vec3 normal = mean_normal(built.model.interfaces[k]);
    Index vertical = 0;  // the axis nearest to the normal, about which nothing rocks
    normal.cwiseAbs().maxCoeff(&vertical);
    std::vector<std::string_view> held, rocks;
    for (int i = 0; i < space.unknowns(); ++i) {
      if (moves(built.model, built.model.at(node, space.dof(i)))) continue;
      if (!space.is_rotation(i) && std::abs(space.axis(i).dot(normal)) > along) held.push_back(to_string(space.dof(i)));
      if (space.is_rotation(i) && std::abs(space.axis(i)[vertical]) < 1) rocks.push_back(to_string(space.dof(i)));
    }
    if (static_cast<int>(rocks.size()) == space.dimension - 1) held.insert(held.end(), rocks.begin(), rocks.end());
    if (!held.empty())
      said.push_back(
          fmt::format("the body {} of the base \"{}\" is held ({}) by a support, and the base cannot open as it would without it: "
                      "a body that stands on an interface needs no [[support]]",
                      facts.body, facts.name, fmt::join(held, ", ")));
  }
}

/// Two bases under one body at one place: their stiffnesses and capacities add up.
void warn_repeated_bases(const BuiltCase& built, std::vector<std::string>& said) {
  constexpr double same = 1e-6;
  for (std::size_t k = 0; k < built.bases(); ++k)
    for (std::size_t j = 0; j < k; ++j) {
      const Interface &one = built.model.interfaces[j], &other = built.model.interfaces[k];
      const double area = built.facts[j].area;
      if (built.facts[k].body.empty() || built.facts[k].body != built.facts[j].body) continue;
      if ((one.reference - other.reference).norm() > same * std::sqrt(area)) continue;
      if (std::abs(built.facts[k].area - area) > same * area || one.batch.points != other.batch.points) continue;  // a pad inside a ring
      said.push_back(fmt::format("\"{}\" and \"{}\" stand at the same place under the body {}: the ground is counted twice", one.name,
                                 other.name, built.facts[k].body));
    }
}

/// How few points stand for the pressure of a base along one axis.
struct Division {
  int points = 0;
  double width = 0, farthest = 0, inertia = 0;  // m, m, m2: of the area over the area, about its middle
};
Division division_along(const Model& model, const Interface& interface, const InterfaceFacts& facts, int axis) {
  const Vec3 along = local_axis(interface.space, mean_normal(interface), axis);
  std::vector<double> at, ends;
  double area = 0, middle = 0;
  for (std::size_t i = 0; i < interface.position.size(); ++i) {
    at.push_back(along.dot(interface.position[i] - interface.reference));
    area += interface.area[static_cast<Index>(i)], middle += interface.area[static_cast<Index>(i)] * at.back();
  }
  middle /= area;
  for (const Place& corner : facts.corners) ends.push_back(along.dot(corner - interface.reference));
  if (ends.empty())
    for (const int node : facts.upper)
      ends.push_back(along.dot(model.nodes[static_cast<std::size_t>(node)].position - interface.reference));
  const auto [least, most] = std::ranges::minmax(ends);
  Division made{0, most - least, 0, 0};
  for (std::size_t i = 0; i < at.size(); ++i) {
    made.inertia += interface.area[static_cast<Index>(i)] * (at[i] - middle) * (at[i] - middle) / area;
    made.farthest = std::max(made.farthest, std::abs(at[i] - middle));
  }
  std::ranges::sort(at);
  for (std::size_t i = 0; i < at.size(); ++i)
    if (i == 0 || at[i] - at[i - 1] > 1e-6 * made.width) ++made.points;
  return made;
}

/// Two or three points hardly open: on springs a base opens under the moment W I/(A x) with the farthest point at x, a rectangle under W
/// B/6.
void warn_few_points(const BuiltCase& built, std::vector<std::string>& said) {
  constexpr int enough = 4;
  const std::vector<bool> tied = tied_nodes(built.model);
  for (std::size_t k = 0; k < built.bases(); ++k) {
    const Interface& interface = built.model.interfaces[k];
    const InterfaceFacts& facts = built.facts[k];
    if (interface.footprint || (facts.corners.empty() && !facts.facets) || facts.upper.empty()) continue;  // whole, or pairs on their own
    if (!interface.cone && !interface.law->scales().opens) continue;
    for (int axis = 0; axis + 1 < interface.space.dimension; ++axis) {
      const Division found = division_along(built.model, interface, facts, axis);
      if (found.points >= enough || !(found.width > 0) || !(found.farthest > 0)) continue;
      const bool rigid = interface.cone && is_one_body(facts.upper, tied);
      const double overturns = 2 * found.farthest / found.width;
      if (rigid && overturns > 1 - 1e-6) continue;  // a block on its corners
      const double first = 6 * found.inertia / (found.farthest * found.width) - 1,
                   turns = 12 * found.inertia / (found.width * found.width) - 1;
      const auto off = [](double share) { return fmt::format("{} too {}", percent(std::abs(share)), share < 0 ? "small" : "large"); };
      const std::string turns_off = std::abs(turns) > 1e-3 ? ", its rocking stiffness " + off(turns) : "";
      const std::string error = rigid ? "the moment that overturns it is " + off(overturns - 1)
                                      : "on springs the moment at which a rectangle opens comes out " + off(first) + turns_off +
                                            ", and pressures and uplifted shares accordingly";
      said.push_back(fmt::format("\"{}\" has {} along {}: {}; take ten or more", interface.name,
                                 found.points == 1 ? "one point" : fmt::format("{} points", found.points),
                                 interface.space.dimension == 2 ? "its width"
                                 : axis == 0                    ? "t1"
                                                                : "t2",
                                 error));
    }
  }
}

double size_of(const Mesh& mesh, CellId cell) {
  return std::pow(signed_size(mesh, cell), 1.0 / mesh.dimension);  // m
}

/// Where a plane cuts its cells at an angle, or triangles and tetrahedra, tractions of joints much stiffer than the cells vary from point
/// to point (docs/theory).
void warn_inclined_cut(const CaseSolids& solids, const std::vector<CutFace>& faces, const Interface& interface,
                       std::vector<std::string>& said) {
  constexpr double most = 100;
  if (interface.law == nullptr) return;
  const Mesh& mesh = solids.mesh();
  double softest = 0;  // m/Pa: size over Young's modulus
  std::string_view cut;
  for (const CutFace& face : faces)
    for (const CellId cell : {face.lower, face.upper}) {
      const bool simplex = info(mesh.type(cell)).corners == mesh.dimension + 1;
      const double softness = size_of(mesh, cell) / solids.of(cell).section.material.young;
      if (softness <= softest || (simplex ? !is_crossed(mesh, cell, face) : face.level)) continue;
      softest = softness;
      cut = !simplex ? "its cells at an angle" : mesh.dimension == 2 ? "triangles" : "tetrahedra";
    }
  std::array<double, 3> stiffness{};
  interface.law->closed_stiffness(interface.batch.components, stiffness.data());
  const double ratio = stiffness[static_cast<std::size_t>(interface.batch.components) - 1] * softest;
  if (ratio > most)
    said.push_back(
        fmt::format("\"{}\" cuts {}, and its stiffness is {:.3g} times E/h of the softer cells: the pressures of its points vary "
                    "from one to the next; forces and moments are right; keep K_n below {:g} E/h, or let planes cut "
                    "{} level",
                    interface.name, cut, ratio, most, mesh.dimension == 2 ? "quadrilaterals" : "hexahedra"));
}

/// An outline that goes beyond the cells: only a part of the base is there.
void warn_outside(const CaseCut& cut, const std::vector<CutFace>& faces, const Interface& interface, std::vector<std::string>& said) {
  const std::array<std::string, 2> axes{"x", "y"};
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const std::optional<CaseCut::Range>& range = axis == 0 ? cut.x : cut.y;
    if (!range) continue;
    const CaseCut::Range& limits = *range;
    double low = HUGE_VAL, high = -low;
    for (const CutFace& face : faces)
      for (const Vec3& corner : face.corners) {
        const double x = corner[static_cast<Index>(axis)];
        low = std::min(low, x), high = std::max(high, x);
      }
    const double tolerance = 1e-6 * (limits[1] - limits[0]);
    if (low > limits[0] + tolerance || high < limits[1] - tolerance)
      said.push_back(
          fmt::format("{}:{}: the outline of \"{}\" goes from {:g} to {:g} m in {}, the cells that it cuts from {:g} to {:g} m: "
                      "the base ends there",
                      cut.where(axes[axis]).file, cut.where(axes[axis]).line, interface.name, limits[0], limits[1], axes[axis], low, high));
  }
}

/// The surface of a cell that lies under the edge of a base and beside it has no kink there: the base rests on its edge and stands open
/// behind it, until the cells are small.
void warn_clipped_cut(const Mesh& mesh, const std::vector<CutFace>& faces, const Interface& interface, std::vector<std::string>& said) {
  constexpr double least = 25;  // cells along the shorter side
  double size = 0;              // m
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const CutFace& face : faces) {
    if (face.clipped) size = std::max(size, size_of(mesh, face.lower));
    for (const Vec3& corner : face.corners) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
  }
  const double width = mesh.dimension == 2 ? (high - low).norm() : std::min(high.x() - low.x(), high.y() - low.y());
  if (size > 0 && least * size > width)
    said.push_back(
        fmt::format("the outline of \"{}\" ends inside cells of {}, which carry its edge and the free ground beside it: within "
                    "one or two cells of the edge, gaps and pressures are inaccurate, even at rest; let sides of cells meet the "
                    "edge, or take cells below {}",
                    interface.name, format_quantity(size, "m"), format_quantity(width / least, "m")));
}

/// docs/theory/element_jumps.md
void warn_element_jumps(const CaseCut& cut, const std::vector<CutFace>& faces, const Interface& interface, std::vector<std::string>& said) {
  if (cut.jump == CaseCut::Jump::linear) return;
  const bool level = std::ranges::all_of(faces, &CutFace::level);
  said.push_back(
      fmt::format("the jump of \"{}\" is {} in each cell, a form of the literature for comparisons: {}{}; the linear jump has none of "
                  "this",
                  interface.name, cut.jump_word,
                  cut.jump == CaseCut::Jump::constant ? "a base that turns is held by stresses in the cells and locks"
                                                      : "both sides of a cell have one strain, also where their materials differ",
                  level ? "" : ", and on cells that are cut at an angle even uniform stresses are wrong"));
}

void warn_cuts(const Case& read, const BuiltCase& built, std::vector<std::string>& said) {
  if (!read.mesh || read.mesh->cut.empty()) return;
  const CaseSolids solids(*read.input, *read.mesh);
  const std::vector<CaseInterface>& tables = read.input->interfaces;
  for (std::size_t t = 0; t < tables.size(); ++t)
    for (const Interface& interface : built.model.interfaces) {
      if (interface.name != tables[t].name.name || read.mesh->cut[t].empty()) continue;
      warn_element_jumps(*tables[t].cut(), read.mesh->cut[t], interface, said);
      warn_inclined_cut(solids, read.mesh->cut[t], interface, said);
      warn_outside(*tables[t].cut(), read.mesh->cut[t], interface, said);
      warn_clipped_cut(solids.mesh(), read.mesh->cut[t], interface, said);
    }
}

/// docs/theory, eq (3): a closure stress above 1 % of the bearing pressure resists the closing of gaps noticeably.
void warn_closure(const BuiltCase& built, std::vector<std::string>& said) {
  double area = 0;
  for (const InterfaceFacts& facts : built.facts) area += facts.area;
  const double mean = area > 0 ? built.weight() / area : 0;
  for (std::size_t k = 0; k < built.behaviours.size(); ++k) {
    const Values& law = *built.behaviours[k];
    const Interface& interface = built.model.interfaces[k];
    const double closure = interface.law != nullptr ? interface.law->scales().closure : 0;
    if (!(closure > 0)) continue;
    if (mean > 0 && closure > 0.01 * mean)
      said.push_back(fmt::format(
          "{}:{}: the closure stress of {} is {} of the mean bearing pressure {}: the joint pushes before its gap is closed; keep it below "
          "1 %",
          law.where().file, law.where().line, format_quantity(closure, "Pa"), percent(closure / mean), format_quantity(mean, "Pa")));
    if (!(mean > 0))
      said.push_back(fmt::format("{}: nothing presses the structure down: the interface opens under any load", built.facts[k].name));
  }
}

}  // namespace

void warn_interfaces(const Case& read, const BuiltCase& built, std::vector<std::string>& said) {
  warn_gaps(built, said);
  warn_closure(built, said);
  warn_sides_exchanged(read, built, said);
  warn_foundations(read, built, said);
  warn_cuts(read, built, said);
  warn_floating(read, built, said);
  warn_settlement(built, said);
  warn_unloaded(read, built, said);
  warn_held_bodies(built, said);
  warn_repeated_bases(built, said);
  warn_few_points(built, said);
}

}  // namespace uplift
