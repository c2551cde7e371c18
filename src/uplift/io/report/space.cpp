#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "uplift/case/mesh/mesh.h"
#include "uplift/io/report/parts.h"
#include "uplift/mesh/sides.h"

// The drawing of a model in space.
namespace uplift {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// The outer surface of a group of solids.
struct Surface {
  std::string name;
  std::vector<int> triangles, edges;  // nodes of the mesh: three each, counter-clockwise from outside; two each
};

Surface surface_of(const Mesh& mesh, const std::string& group) {
  Surface surface{group, {}, {}};
  const Sides sides(mesh, mesh.groups.at(group).cells);
  std::set<std::pair<int, int>> edges;
  std::vector<int> nodes;
  for (int cell = 0; cell < static_cast<int>(sides.cells().size()); ++cell)
    for (int side = 0; side < sides.count(cell); ++side) {
      const int number = Sides::stride * cell + side;
      if (sides.twin(number) >= 0) continue;
      sides.nodes_of(mesh, number, nodes);
      const Cell type = info(mesh.type(sides.cells()[at(cell)])).sides[at(side)];
      const auto corners = at(info(type).corners);
      for (std::size_t k = 2; k < corners; ++k) surface.triangles.insert(surface.triangles.end(), {nodes[0], nodes[k - 1], nodes[k]});
      for (std::size_t k = 0; k < corners; ++k) edges.insert(std::minmax(nodes[k], nodes[(k + 1) % corners]));
    }
  for (const auto& [a, b] : edges) surface.edges.insert(surface.edges.end(), {a, b});
  return surface;
}

/// What is drawn: surfaces of solids, nodes of the case, of beams and of rigid bodies.
struct DrawnInSpace {
  DrawnParts parts;
  std::vector<Surface> surfaces;
  std::vector<int> nodes;  // of the model, ascending
  int number(int node) const { return static_cast<int>(std::ranges::lower_bound(nodes, node) - nodes.begin()); }
};

DrawnInSpace drawn_in_space(const Case& read, const BuiltCase& built) {
  DrawnInSpace drawn;
  drawn.parts = drawn_parts(read, built);
  drawn.nodes = nodes_drawn_in_space(read, built, drawn.parts);
  for (const std::string& group : drawn.parts.solids) drawn.surfaces.push_back(surface_of(read.mesh->drawn(), group));
  return drawn;
}

void write_whole(JsonWriter& json, std::string_view key, const std::vector<int>& numbers) {
  const std::vector<double> doubles(numbers.begin(), numbers.end());
  json.key(key).numbers(doubles);
}

void write_places(JsonWriter& json, std::string_view key, const std::vector<Vec3>& places) {
  std::vector<double> numbers;
  for (const Vec3& place : places) numbers.insert(numbers.end(), {place.x(), place.y(), place.z()});
  json.key(key).numbers(numbers);
}

void write_surfaces(JsonWriter& json, const DrawnInSpace& drawn) {
  json.key("parts").begin_array();
  for (const Surface& surface : drawn.surfaces) {
    json.begin_object().member("name", surface.name);
    for (const auto& [key, of_mesh] : {std::pair("triangles", &surface.triangles), std::pair("edges", &surface.edges)}) {
      std::vector<int> numbers;
      for (const int node : *of_mesh) numbers.push_back(drawn.number(drawn.parts.first_of_mesh + node));
      write_whole(json, key, numbers);
    }
    json.end_object();
  }
  json.end_array();
}

/// Footings first, as their interfaces count them, then rectangular foundations.
void write_bodies(JsonWriter& json, const BuiltCase& built, const DrawnInSpace& drawn) {
  json.key("bodies").begin_array();
  for (const bool foundations : {false, true})
    for (const DrawnParts::Body& body : drawn.parts.bodies) {
      std::vector<Vec3> corners(built.facts[body.interface].corners.begin(), built.facts[body.interface].corners.end());
      if (body.foundation != foundations || corners.size() != 4) continue;
      json.begin_object().member("name", built.facts[body.interface].body).member("node", drawn.number(body.node));
      if (!body.foundation) corners = {corners[0], corners[2], corners[3], corners[1]};  // two rows: round the rectangle
      write_places(json, "corners", corners);
      json.end_object();
    }
  json.end_array();
}

void write_small_parts(JsonWriter& json, const Case& read, const BuiltCase& built, const DrawnInSpace& drawn) {
  const DrawnParts& parts = drawn.parts;
  json.key("masses").begin_array();
  for (const DrawnParts::Mass& mass : parts.masses)
    json.begin_object().member("node", drawn.number(mass.node)).member("mass", mass.mass).end_object();
  json.end_array().key("supports").begin_array();
  const auto write_support = [&](int node, const DrawnParts::Support& support) {
    if (!std::ranges::binary_search(drawn.nodes, node)) return;
    json.begin_object().member("node", drawn.number(node)).key("dofs").texts(support.fixed).end_object();
  };
  for (const DrawnParts::Support& support : parts.supports) {
    if (support.node >= 0) write_support(support.node, support);
    if (support.group.empty()) continue;
    const Group& group = read.mesh->mesh.groups.at(support.group);
    if (group.dimension >= 2) continue;  // faces, see write_borders
    for (const int node : nodes_of(read.mesh->mesh, group)) write_support(parts.first_of_mesh + node, support);
  }
  json.end_array().key("loads").begin_array();
  for (const DrawnParts::Load& load : parts.loads) {
    if (load.force.empty()) continue;
    int node = load.node;
    if (const std::optional<int> free = node_on_free_surface(read, built, load.group, drawn.nodes)) {
      node = *free;
    } else if (!load.group.empty() && read.mesh) {
      const std::vector<int> nodes = nodes_of(read.mesh->mesh, read.mesh->mesh.groups.at(load.group));
      node = parts.first_of_mesh + nodes[nodes.size() / 2];
    }
    if (!std::ranges::binary_search(drawn.nodes, node)) continue;
    json.begin_object().member("node", drawn.number(node)).key("force").numbers(load.force);
    json.member("label", load.name).end_object();
  }
  json.end_array();
}

/// Triangles over the faces of a group on the outer surface, counter-clockwise from outside.
std::vector<int> faces_of(const Mesh& mesh, const Sides& sides, const std::string& group, const DrawnInSpace& drawn) {
  std::vector<int> triangles, nodes;
  for (const CellId cell : mesh.groups.at(group).cells) {
    const int side = info(mesh.type(cell)).dimension == 2 ? sides.find(mesh.type(cell), mesh.cell(cell)) : -1;
    if (side < 0 || sides.twin(side) >= 0) continue;
    sides.nodes_of(mesh, side, nodes);
    const auto number = [&](int k) { return drawn.number(drawn.parts.first_of_mesh + nodes[at(k)]); };
    for (int k = 2; k < info(mesh.type(cell)).corners; ++k) triangles.insert(triangles.end(), {number(0), number(k - 1), number(k)});
  }
  return triangles;
}

/// Faces that supports hold, and absorbing ones; a face that is held in the static stages alone and absorbs then counts as absorbing.
void write_borders(JsonWriter& json, const Case& read, const DrawnInSpace& drawn) {
  json.key("borders").begin_array();
  if (!read.mesh) {
    json.end_array();
    return;
  }
  const Mesh& mesh = read.mesh->mesh;
  const Sides sides(mesh, full_cells(mesh));
  std::set<std::string> written;
  const auto write = [&](const std::string& group, const char* kind) {
    if (group.empty() || !written.insert(group).second) return;
    const std::vector<int> triangles = faces_of(mesh, sides, group, drawn);
    if (triangles.empty()) return;
    json.begin_object().member("name", group).member("kind", kind);
    write_whole(json, "triangles", triangles);
    json.end_object();
  };
  for (const DrawnParts::AbsorbingFace& face : drawn.parts.absorbing) write(face.group, "absorbing");
  for (const DrawnParts::Support& support : drawn.parts.supports) write(support.group, "held");
  json.end_array();
}

/// The point of an interface at a place; places are compared to a millionth of a metre.
class PointAt {
 public:
  explicit PointAt(const Interface& joint) {
    for (int i = 0; i < joint.batch.points; ++i) number_[key(joint.position[at(i)])] = i;
  }
  int operator()(const Vec3& place) const {
    const auto found = number_.find(key(place));
    return found == number_.end() ? -1 : found->second;
  }

 private:
  static std::array<long, 3> key(const Vec3& place) {
    return {std::lround(place.x() * 1e6), std::lround(place.y() * 1e6), std::lround(place.z() * 1e6)};
  }
  std::map<std::array<long, 3>, int> number_;
};

/// Triangles between the points of an interface: over the faces of an opened surface, over the grid of a footing (`body`, or null). Empty
/// where the points do not stand at corners.
std::vector<int> triangles_of(const Case& read, const Interface& joint, const InterfaceFacts& facts, const DrawnParts::Body* body) {
  std::vector<int> triangles;
  const auto add_polygon = [&](const std::vector<int>& corners) {
    for (std::size_t k = 2; k < corners.size(); ++k) triangles.insert(triangles.end(), {corners[0], corners[k - 1], corners[k]});
  };
  if (!facts.faces.empty()) {
    const PointAt point_at(joint);
    for (const FacePair& face : facts.faces) {
      std::vector<int> corners;
      for (int k = 0; k < info(read.mesh->mesh.type(face.lower)).corners; ++k)
        corners.push_back(point_at(read.mesh->mesh.nodes[at(read.mesh->mesh.cell(face.lower)[at(k)])]));
      if (std::ranges::find(corners, -1) != corners.end()) continue;
      add_polygon(corners);
    }
  }
  if (body != nullptr)
    for (int j = 0; j + 1 < body->across; ++j)
      for (int i = 0; i + 1 < body->along; ++i) {
        const int a = j * body->along + i;
        add_polygon({a, a + 1, a + body->along + 1, a + body->along});
      }
  return triangles;
}

/// "x" when the direction is an axis of the model.
std::string axis_name(const Vec3& direction, const char* otherwise) {
  constexpr const char* names[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k)
    if (std::abs(direction[k]) > 1 - 1e-9) return names[k];
  return otherwise;
}

/// The drawn node of the upper side that is nearest to each point: the point is drawn moving with it.
std::vector<int> carriers(const Interface& joint, const InterfaceFacts& facts, const BuiltCase& built, const DrawnInSpace& drawn) {
  std::vector<int> nodes;
  for (int i = 0; i < joint.batch.points; ++i) {
    int nearest = -1;
    double least = 0;
    for (const int node : facts.upper) {
      const double distance = (built.model.nodes[at(node)].position - joint.position[at(i)]).squaredNorm();
      if (std::ranges::binary_search(drawn.nodes, node) && (nearest < 0 || distance < least)) nearest = node, least = distance;
    }
    if (nearest < 0) return {};
    nodes.push_back(drawn.number(nearest));
  }
  return nodes;
}

/// Upright walls around a pit face no direction together: their map is the plane of the first one.
Vec3 normal_of_map(const Interface& joint) {
  const Vec3 normal = mean_normal(joint);
  const bool faced = std::ranges::any_of(joint.normal, [&](const Vec3& n) { return std::abs(n.dot(normal)) > 1e-9; });
  return faced ? normal : Vec3(joint.normal.front());
}

void write_interfaces(JsonWriter& json, const Case& read, const BuiltCase& built, const DrawnInSpace& drawn) {
  json.key("interfaces").begin_array();
  int bodies = 0;
  for (std::size_t k = 0; k < built.model.interfaces.size(); ++k) {
    const Interface& joint = built.model.interfaces[k];
    const Vec3 normal = normal_of_map(joint), s = local_axis(joint.space, normal, 0), t = local_axis(joint.space, normal, 1);
    std::vector<double> plan;
    for (const Place& place : joint.position) plan.insert(plan.end(), {(place - joint.reference).dot(s), (place - joint.reference).dot(t)});
    json.begin_object().member("name", joint.name);
    write_places(json, "points", {joint.position.begin(), joint.position.end()});
    json.key("plan").numbers(plan).key("axes").texts({axis_name(s, "s"), axis_name(t, "t")});
    json.key("normal").numbers(std::array<double, 3>{normal.x(), normal.y(), normal.z()});
    if (joint.footprint)
      json.key("area").numbers(std::array<double, 1>{built.facts[k].area}).member("foundation", true);
    else
      json.key("area").numbers(std::span<const double>(joint.area.data(), at(joint.batch.points)));
    const DrawnParts::Body* body = drawn.parts.body_above(k);
    write_whole(json, "triangles", triangles_of(read, joint, built.facts[k], body));
    if (body != nullptr && !body->foundation) {
      json.member("body", bodies++);
    } else if (const std::vector<int> nodes = carriers(joint, built.facts[k], built, drawn); !nodes.empty()) {
      write_whole(json, "node", nodes);
    }
    json.end_object();
  }
  json.end_array();
}

void write_model(JsonWriter& json, const Case& read, const BuiltCase& built, const DrawnInSpace& drawn) {
  std::vector<Vec3> places;
  for (const int node : drawn.nodes) places.push_back(built.model.nodes[at(node)].position);
  json.begin_object();
  write_places(json, "nodes", places);
  write_surfaces(json, drawn);
  json.key("lines").begin_array();
  for (const BeamLine& beam : built.beams) {
    std::vector<int> line;
    for (const int node : beam.nodes) line.push_back(drawn.number(node));
    json.begin_object().member("name", beam.name);
    write_whole(json, "nodes", line);
    json.end_object();
  }
  json.end_array();
  write_bodies(json, built, drawn);
  write_small_parts(json, read, built, drawn);
  write_borders(json, read, drawn);
  write_interfaces(json, read, built, drawn);
  json.end_object();
}

}  // namespace

void write_space(JsonWriter& json, const ReportInput& input) {
  const DrawnInSpace drawn = drawn_in_space(*input.read, *input.runs.front().built);
  json.key("space");
  write_model(json, *input.read, *input.runs.front().built, drawn);
  json.key("spaceAnimations").begin_array();
  for (const ReportRun& run : input.runs)
    if (run.result->frames.size() >= 2) write_space_animation(json, drawn.parts, run, drawn.nodes);
  json.end_array();
}

}  // namespace uplift
