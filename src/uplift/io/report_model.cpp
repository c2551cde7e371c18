#include <algorithm>
#include <array>

#include "uplift/analysis/case_model.h"
#include "uplift/io/report_parts.h"

// The drawing of the model and the pictures of the animation.
namespace uplift {
namespace {

/// Nodes of the case and of its beams; the nodes of an elastic bed are not drawn.
std::vector<int> drawn_nodes(const Case& read, const Built& built) {
  std::vector<std::string> beds;
  for (const Interface& interface : built.model.interfaces) beds.push_back(interface.name + ".");
  std::vector<int> drawn;
  for (std::size_t i = 0; i < built.model.nodes.size(); ++i) {
    const std::string& name = built.model.nodes[i].name;
    const bool given = std::any_of(read.values.tables("nodes").begin(), read.values.tables("nodes").end(),
                                   [&](const Values& node) { return node.key() == name; });
    const bool bed = std::any_of(beds.begin(), beds.end(), [&](const std::string& start) { return name.starts_with(start); });
    if (given || !bed) drawn.push_back(static_cast<int>(i));
  }
  return drawn;
}

void write_beams(JsonWriter& json, const Case& read) {
  json.begin_array();
  for (const Values& beam : read.values.tables("beam")) {
    std::vector<std::string> nodes{beam.texts("nodes").front()};
    for (int k = 1; k < beam.integer("elements"); ++k) nodes.push_back(beam.text("name") + "." + std::to_string(k));
    nodes.push_back(beam.texts("nodes").back());
    json.begin_object().member("name", beam.text("name")).key("nodes").texts(nodes).end_object();
  }
  json.end_array();
}

/// A footing is drawn as a flat block on its underside.
void write_bodies(JsonWriter& json, const Case& read, const Built& built) {
  json.begin_array();
  for (const Values& interface : read.values.tables("interface")) {
    const Values* footing = table_if(interface, "footing");
    if (!footing) continue;
    const int node = built.model.find_node(footing->text("body"));
    const Interface* joint = nullptr;
    for (const Interface& each : built.model.interfaces)
      if (each.name == interface.text("name")) joint = &each;
    const Vec2 n = joint->normal.front(), t = tangent(n), middle = joint->reference;
    const double half = footing->number("width") / 2;
    const double height = std::max(0.08 * 2 * half, (built.model.nodes[static_cast<std::size_t>(node)].position - middle).dot(n));
    const std::array<Vec2, 4> corners{middle - half * t, middle + half * t, middle + half * t + height * n, middle - half * t + height * n};
    json.begin_object().member("name", footing->text("body")).member("node", footing->text("body")).key("outline").begin_array();
    for (const Vec2& corner : corners) json.numbers(std::array<double, 2>{corner.x(), corner.y()});
    json.end_array().end_object();
  }
  json.end_array();
}

void write_small_parts(JsonWriter& json, const Case& read, const Built& built) {
  json.key("masses").begin_array();
  for (const Values& mass : read.values.tables("mass"))
    json.begin_object()
        .member("node", mass.text("node"))
        .member("mass", mass.has("mass") ? mass.number("mass") : built.tuned_mass)
        .end_object();
  json.end_array();
  json.key("supports").begin_array();
  for (const Values& support : read.values.tables("support"))
    json.begin_object().member("node", support.text("node")).key("dofs").texts(support.texts("fixed")).end_object();
  json.end_array();
  json.key("springs").begin_array();
  for (const char* kind : {"spring", "dashpot"})
    for (const Values& spring : read.values.tables(kind)) {
      const std::vector<std::string>& nodes = spring.texts("nodes");
      json.begin_object().key("nodes").begin_array().value(nodes.front());
      if (nodes.size() > 1)
        json.value(nodes.back());
      else
        json.null();
      json.end_array().member("kind", kind).end_object();
    }
  json.end_array();
}

void write_interfaces(JsonWriter& json, const Built& built) {
  json.begin_array();
  for (std::size_t k = 0; k < built.model.interfaces.size(); ++k) {
    const Interface& interface = built.model.interfaces[k];
    json.begin_object().member("name", interface.name);
    if (!built.facts[k].body.empty()) json.member("body", built.facts[k].body);
    json.key("points").begin_array();
    for (int i = 0; i < interface.batch.points; ++i) {
      const Vec2 &at = interface.position[static_cast<std::size_t>(i)], &n = interface.normal[static_cast<std::size_t>(i)];
      json.begin_object()
          .member("x", at.x())
          .member("y", at.y())
          .member("nx", n.x())
          .member("ny", n.y())
          .member("area", interface.area[i])
          .end_object();
    }
    json.end_array().end_object();
  }
  json.end_array();
}

/// Rows of the normal component of all interfaces stand one after another in a frame.
void write_points(JsonWriter& json, const Built& built, const RunResult& result, Vector Frame::*field) {
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

void write_model(JsonWriter& json, const Case& read, const Built& built) {
  json.begin_object().key("nodes").begin_array();
  for (const int i : drawn_nodes(read, built)) {
    const Node& node = built.model.nodes[static_cast<std::size_t>(i)];
    json.begin_object().member("name", node.name).member("x", node.position.x()).member("y", node.position.y()).end_object();
  }
  json.end_array().key("beams");
  write_beams(json, read);
  json.key("bodies");
  write_bodies(json, read, built);
  write_small_parts(json, read, built);
  json.key("interfaces");
  write_interfaces(json, built);
  json.key("loads").begin_array();
  for (const Values& load : read.values.tables("load")) {
    if (!load.has("force")) continue;
    json.begin_object().member("node", load.text("node")).member("fx", load.numbers("force")[0]).member("fy", load.numbers("force")[1]);
    json.member("label", load.has("name") ? load.text("name") : "load").end_object();
  }
  json.end_array().end_object();
}

void write_animations(JsonWriter& json, const ReportInput& input) {
  json.begin_array();
  for (const ReportRun& run : input.runs) {
    const std::vector<Frame>& frames = run.result->frames;
    if (frames.size() < 2) continue;
    json.begin_object().member("run", run.result->label).key("time").begin_array();
    for (const Frame& frame : frames) json.value(frame.time);
    json.end_array().key("nodes").begin_object();
    for (const int i : drawn_nodes(*input.read, *run.built)) {
      json.key(run.built->model.nodes[static_cast<std::size_t>(i)].name).begin_array();
      for (const Frame& frame : frames) json.numbers(std::span<const double>(frame.displacement.data() + 3 * i, 3));
      json.end_array();
    }
    json.end_object().key("openings");
    write_points(json, *run.built, *run.result, &Frame::opening);
    json.key("pressures");
    write_points(json, *run.built, *run.result, &Frame::pressure);
    json.end_object();
  }
  json.end_array();
}

}  // namespace uplift
