#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "uplift/case/mesh/mesh.h"
#include "uplift/case/mesh/outline.h"
#include "uplift/io/report/parts.h"

// The drawing of the model and the pictures of the animation.
namespace uplift {
namespace {

constexpr int most_outline_nodes = 140, most_drawn_cells = 2000;
constexpr std::size_t most_beam_nodes = 200;

/// What is drawn of the model: its parts, the outline of the mesh, and which nodes of the model.
struct Drawn {
  DrawnParts parts;
  MeshOutline outline;          // nodes of the mesh
  std::vector<BeamLine> beams;  // those of groups thinned
  std::vector<int> nodes;       // of the model, ascending
  std::set<int> hidden;         // nodes that the user has not named
};

/// Of a straight stretch of a beam every n-th node: the browser draws cubics between them.
void thin(const Model& model, std::size_t every, std::vector<int>& line) {
  const auto position = [&](std::size_t i) -> const Place& { return model.nodes[static_cast<std::size_t>(line[i])].position; };
  constexpr double straight = 0.97;  // cosine of 14 degrees
  std::vector<int> kept{line.front()};
  std::size_t since = 0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const bool end = i + 1 == line.size();
    const bool corner = !end && (position(i) - position(i - 1)).normalized().dot((position(i + 1) - position(i)).normalized()) < straight;
    if (!end && !corner && ++since < every) continue;
    kept.push_back(line[i]);
    since = 0;
  }
  line = std::move(kept);
}

std::vector<BeamLine> drawn_beams(const BuiltCase& built) {
  std::vector<BeamLine> beams = built.beams;
  std::size_t nodes = 0;
  for (const BeamLine& beam : beams)
    if (beam.of_group) nodes += beam.nodes.size();
  for (BeamLine& beam : beams)
    if (beam.of_group) thin(built.model, nodes / most_beam_nodes + 1, beam.nodes);
  return beams;
}

/// Nodes of the case, of its beams and of the outline of its mesh, and those that are a group; the nodes of an elastic bed are not drawn.
Drawn drawn_of(const Case& read, const BuiltCase& built) {
  Drawn drawn;
  drawn.parts = drawn_parts(read, built);
  const int first_of_mesh = drawn.parts.first_of_mesh;
  int end_of_mesh = first_of_mesh;
  if (read.mesh) {
    drawn.outline = outline_of(read.mesh->drawn(), drawn.parts.solids, most_outline_nodes, most_drawn_cells);
    end_of_mesh += static_cast<int>(read.mesh->mesh.nodes.size());
  }
  drawn.beams = drawn_beams(built);
  std::set<int> kept = drawn.parts.nodes(), inner;
  for (const BeamLine& beam : drawn.beams) kept.insert(beam.nodes.begin(), beam.nodes.end());
  for (const BeamLine& beam : built.beams)
    if (beam.of_group)
      for (const int node : beam.nodes)
        if (node >= end_of_mesh) inner.insert(node);
  for (const int node : {built.top, built.base}) kept.insert(node);
  std::vector<std::string> beds;
  for (const Interface& interface : built.model.interfaces) beds.push_back(interface.name + ".");
  const auto& on_outline = drawn.outline.nodes;
  for (int i = 0; i < static_cast<int>(built.model.nodes.size()); ++i) {
    const std::string& name = built.model.nodes[static_cast<std::size_t>(i)].name;
    const bool bed = std::any_of(beds.begin(), beds.end(), [&](const std::string& start) { return name.starts_with(start); });
    const bool of_mesh = i >= first_of_mesh && i < end_of_mesh, of_group = inner.contains(i), named = !name.starts_with("mesh.");
    const bool shown =
        of_mesh ? named || std::ranges::binary_search(on_outline, i - first_of_mesh) : i < first_of_mesh || !(bed || of_group);
    if (shown || kept.contains(i)) drawn.nodes.push_back(i);
    if (of_group || !named) drawn.hidden.insert(i);
  }
  return drawn;
}

/// The name by which a node is drawn; a case may call it by its number.
const std::string& shown_name(const BuiltCase& built, int node) {
  return built.model.nodes[static_cast<std::size_t>(node)].name;
}

const std::string& name_of_mesh_node(const Drawn& drawn, const BuiltCase& built, int of_mesh) {
  return shown_name(built, drawn.parts.first_of_mesh + of_mesh);
}

/// At most about `most` nodes of a group of the mesh that are drawn.
std::vector<int> drawn_of_group(const Drawn& drawn, const Case& read, const std::string& group, std::size_t most) {
  std::vector<int> found;
  for (const int node : nodes_of(read.mesh->mesh, read.mesh->mesh.groups.at(group)))
    if (std::ranges::binary_search(drawn.nodes, drawn.parts.first_of_mesh + node)) found.push_back(node);
  const std::size_t every = found.size() / most + 1;
  std::vector<int> thinned;
  for (std::size_t i = 0; i < found.size(); i += every) thinned.push_back(found[i]);
  return thinned;
}

void write_outline(JsonWriter& json, const Drawn& drawn, const Case& read, const BuiltCase& built) {
  json.key("outlines").begin_array();
  for (const MeshOutline::Part& part : drawn.outline.parts) {
    json.begin_object().member("name", part.name).key("lines").begin_array();
    for (const std::vector<int>& line : part.lines) {
      std::vector<std::string> names;
      for (const int node : line) names.push_back(name_of_mesh_node(drawn, built, node));
      json.texts(names);
    }
    json.end_array().end_object();
  }
  json.end_array().key("grid").begin_array();
  for (const auto& [a, b] : drawn.outline.edges) {
    const Vec3 &from = read.mesh->drawn().nodes[static_cast<std::size_t>(a)], &to = read.mesh->drawn().nodes[static_cast<std::size_t>(b)];
    json.numbers(std::array<double, 4>{from.x(), from.y(), to.x(), to.y()});
  }
  json.end_array();
}

void write_beams(JsonWriter& json, const Drawn& drawn, const BuiltCase& built) {
  json.begin_array();
  for (const BeamLine& beam : drawn.beams) {
    std::vector<std::string> nodes;
    for (const int node : beam.nodes) nodes.push_back(shown_name(built, node));
    json.begin_object().member("name", beam.name).key("nodes").texts(nodes).end_object();
  }
  json.end_array();
}

/// A footing is drawn as a flat block on its underside.
void write_bodies(JsonWriter& json, const Drawn& drawn, const BuiltCase& built) {
  json.begin_array();
  for (const DrawnParts::Body& body : drawn.parts.bodies) {
    const std::vector<Place>& edges = built.facts[body.interface].corners;
    const Vec3 n = built.model.interfaces[body.interface].normal.front(), from = edges.front(), to = edges.back();
    const double height = (built.model.nodes[static_cast<std::size_t>(body.node)].position - from).dot(n);
    const Vec3 up = std::max(0.08 * (to - from).norm(), height) * n;
    const std::string& name = shown_name(built, body.node);
    json.begin_object().member("name", name).member("node", name).key("outline").begin_array();
    for (const Vec3& corner : {from, to, Vec3(to + up), Vec3(from + up)}) json.numbers(std::array<double, 2>{corner.x(), corner.y()});
    json.end_array().end_object();
  }
  json.end_array();
}

void write_supports(JsonWriter& json, const Drawn& drawn, const Case& read, const BuiltCase& built) {
  const auto write = [&](const std::string& node, const DrawnParts::Support& support) {
    json.begin_object().member("node", node).key("dofs").texts(support.fixed);
    if (support.statics_only) json.member("staticsOnly", true);
    json.end_object();
  };
  json.key("supports").begin_array();
  for (const DrawnParts::Support& support : drawn.parts.supports) {
    if (support.node >= 0) write(shown_name(built, support.node), support);
    if (!support.group.empty())
      for (const int node : drawn_of_group(drawn, read, support.group, 8)) write(name_of_mesh_node(drawn, built, node), support);
  }
  json.end_array();
}

/// Absorbing faces as segments between the ends of their edges.
void write_absorbing(JsonWriter& json, const Drawn& drawn, const Case& read) {
  json.key("absorbing").begin_array();
  for (const DrawnParts::AbsorbingFace& face : drawn.parts.absorbing) {
    const Mesh& mesh = read.mesh->mesh;
    json.begin_object().member("group", face.group).member("freeField", face.free_field);
    json.member("incident", face.incident).key("edges").begin_array();
    for (const CellId cell : mesh.groups.at(face.group).cells) {
      const auto ends = mesh.cell(cell);
      const Vec3 &from = mesh.nodes[static_cast<std::size_t>(ends[0])], &to = mesh.nodes[static_cast<std::size_t>(ends[1])];
      json.numbers(std::array<double, 4>{from.x(), from.y(), to.x(), to.y()});
    }
    json.end_array().end_object();
  }
  json.end_array();
}

void write_loads(JsonWriter& json, const Drawn& drawn, const Case& read, const BuiltCase& built) {
  json.key("loads").begin_array();
  for (const DrawnParts::Load& load : drawn.parts.loads) {
    if (load.force.empty()) continue;
    std::string node = load.node >= 0 ? shown_name(built, load.node) : "";
    if (const std::optional<int> free = node_on_free_surface(read, built, load.group, drawn.nodes))
      node = shown_name(built, *free);
    else if (!load.group.empty())
      if (const std::vector<int> nodes = drawn_of_group(drawn, read, load.group, 1000); !nodes.empty())
        node = name_of_mesh_node(drawn, built, nodes[nodes.size() / 2]);
    json.begin_object().member("node", node).member("fx", load.force[0]).member("fy", load.force[1]);
    json.member("label", load.name).end_object();
  }
  json.end_array();
}

void write_small_parts(JsonWriter& json, const DrawnParts& parts, const BuiltCase& built) {
  json.key("masses").begin_array();
  for (const DrawnParts::Mass& mass : parts.masses)
    json.begin_object().member("node", shown_name(built, mass.node)).member("mass", mass.mass).end_object();
  json.end_array();
  json.key("springs").begin_array();
  for (const DrawnParts::Link& link : parts.links) {
    json.begin_object().key("nodes").begin_array().value(shown_name(built, link.node));
    if (link.other >= 0)
      json.value(shown_name(built, link.other));
    else
      json.null();
    json.end_array().member("kind", link.symbol).end_object();
  }
  json.end_array();
}

/// The drawn node of the upper side that is nearest to a point of an opened surface: the point is drawn moving with it.
std::string carrier(const Drawn& drawn, const BuiltCase& built, std::size_t interface, const Vec3& point) {
  const auto distance = [&](int node) { return (built.model.nodes[static_cast<std::size_t>(node)].position - point).norm(); };
  int nearest = -1;
  for (const int node : built.facts[interface].upper)
    if (std::ranges::binary_search(drawn.nodes, node) && (nearest < 0 || distance(node) < distance(nearest))) nearest = node;
  return nearest < 0 ? "" : built.model.nodes[static_cast<std::size_t>(nearest)].name;
}

void write_interfaces(JsonWriter& json, const Drawn& drawn, const BuiltCase& built) {
  json.begin_array();
  for (std::size_t k = 0; k < built.model.interfaces.size(); ++k) {
    const Interface& interface = built.model.interfaces[k];
    const bool surface = !built.facts[k].faces.empty();
    json.begin_object().member("name", interface.name);
    if (surface) json.member("opened", true);
    if (!built.facts[k].body.empty()) json.member("body", built.facts[k].body);
    json.key("points").begin_array();
    for (int i = 0; i < interface.batch.points; ++i) {
      const Vec3 &at = interface.position[static_cast<std::size_t>(i)], &n = interface.normal[static_cast<std::size_t>(i)];
      json.begin_object().member("x", at.x()).member("y", at.y()).member("nx", n.x()).member("ny", n.y()).member("area", interface.area[i]);
      if (surface) json.member("node", carrier(drawn, built, k, at));
      json.end_object();
    }
    json.end_array().end_object();
  }
  json.end_array();
}

/// Rows of the normal component of all interfaces stand one after another in a frame.
void write_points(JsonWriter& json, const BuiltCase& built, const RunResult& result, Vector Frame::*field) {
  json.begin_object();
  Index first = 0;
  for (const Interface& interface : built.model.interfaces) {
    json.key(interface.name).begin_array();
    for (const Frame& frame : result.frames)
      json.numbers(std::span<const double>((frame.*field).data() + first, static_cast<std::size_t>(interface.batch.points)));
    json.end_array();
    first += interface.batch.points;
  }
  json.end_object();
}

}  // namespace

std::optional<int> node_on_free_surface(const Case& read, const BuiltCase& built, const std::string& name, const std::vector<int>& drawn) {
  if (!read.mesh || !read.mesh->free.contains(name) || drawn.empty()) return std::nullopt;
  const std::vector<FreeFace>& faces = read.mesh->free.at(name);
  const Vec3& place = faces[faces.size() / 2].corners.front();
  return *std::ranges::min_element(
      drawn, {}, [&](int node) { return (built.model.nodes[static_cast<std::size_t>(node)].position - place).squaredNorm(); });
}

void write_uplifted(JsonWriter& json, const Model& model, const std::vector<const Frame*>& frames) {
  json.key("uplifted").begin_object();
  for (std::size_t k = 0; k < model.interfaces.size(); ++k) {
    json.key(model.interfaces[k].name).begin_array();
    for (const Frame* frame : frames) json.value(frame->uplifted[k]);
    json.end_array();
  }
  json.end_object();
}

double uplifted_share(const Model& model, const Frame& frame) {
  double open = 0, all = 0;
  for (std::size_t k = 0; k < model.interfaces.size(); ++k) {
    const double area = model.interfaces[k].area.sum();
    open += frame.uplifted[k] * area;
    all += area;
  }
  return all > 0 ? open / all : 0;
}

void write_model(JsonWriter& json, const Case& read, const BuiltCase& built) {
  const Drawn drawn = drawn_of(read, built);
  json.begin_object().key("nodes").begin_array();
  for (const int i : drawn.nodes) {
    const Node& node = built.model.nodes[static_cast<std::size_t>(i)];
    json.begin_object().member("name", node.name).member("x", node.position.x()).member("y", node.position.y());
    if (drawn.hidden.contains(i)) json.member("hidden", true);
    json.end_object();
  }
  json.end_array().key("beams");
  write_beams(json, drawn, built);
  json.key("bodies");
  write_bodies(json, drawn, built);
  write_small_parts(json, drawn.parts, built);
  write_supports(json, drawn, read, built);
  write_absorbing(json, drawn, read);
  if (read.mesh) write_outline(json, drawn, read, built);
  json.key("interfaces");
  write_interfaces(json, drawn, built);
  write_loads(json, drawn, read, built);
  json.end_object();
}

void write_animations(JsonWriter& json, const ReportInput& input) {
  json.begin_array();
  for (const ReportRun& run : input.runs) {
    const std::vector<Frame>& frames = run.result->frames;
    if (frames.size() < 2) continue;
    json.begin_object().member("run", run.result->label).key("time").begin_array();
    for (const Frame& frame : frames) json.value(frame.time);
    json.end_array().key("nodes").begin_object();
    for (const int i : drawn_of(*input.read, *run.built).nodes) {
      json.key(run.built->model.nodes[static_cast<std::size_t>(i)].name).begin_array();
      for (const Frame& frame : frames) json.numbers(std::span<const double>(frame.displacement.data() + 3 * i, 3));
      json.end_array();
    }
    json.end_object().key("openings");
    write_points(json, *run.built, *run.result, &Frame::opening);
    json.key("pressures");
    write_points(json, *run.built, *run.result, &Frame::pressure);
    std::vector<const Frame*> all;
    for (const Frame& frame : frames) all.push_back(&frame);
    write_uplifted(json, run.built->model, all);
    json.end_object();
  }
  json.end_array();
}

}  // namespace uplift
