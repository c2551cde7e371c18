#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/case/build/bed.h"
#include "uplift/case/build/model.h"
#include "uplift/case/build/water.h"
#include "uplift/elements/discrete.h"
#include "uplift/interface/cut_joint.h"
#include "uplift/interface/facets.h"
#include "uplift/laws/tangential.h"

// Where the joints of an interface stand, and the elastic bed under a footing.
namespace uplift {
namespace {

std::vector<SideNode> side(const std::vector<NameUsed>& used, const CaseNames& names) {
  std::vector<SideNode> nodes;
  for (const int node : names.nodes_of(used)) nodes.push_back({node, names.positions[node]});
  return nodes;
}

Place normal_of(const CaseTable& table, const std::optional<VectorUsed>& stated, Space space) {
  if (!stated) return space.axis(space.up());
  const Vec3 normal = stated->in(space);
  if (normal.norm() == 0) fail(table, "normal", "a direction", "one of length zero");
  return normal.normalized();
}

/// Under each point a node on a spring (and dashpot, and mass) of its own along the normal; it moves in this direction only.
void add_bed(const CaseBed& bed, const std::string& interface, std::vector<JointPoint>& points, ModelBuilder& builder, CaseNames& names) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    JointPoint& point = points[i];
    const std::string name = fmt::format("{}.{}", interface, i + 1);
    const int node = builder.add_node(name, point.position, bed.where());
    names.nodes.add(name, bed.where(), bed.path());
    names.positions.push_back(point.position);
    if (point.normal.cwiseAbs().maxCoeff() < 1 - 1e-12)
      fail(bed, "", "a footing with a vertical or horizontal normal on a bed", "an inclined one");
    const Space space = names.space;
    for (int k = 0; k < space.unknowns(); ++k)
      if (space.is_rotation(k) || std::abs(point.normal.dot(space.axis(k))) < 0.5) builder.fix(node, space.dof(k), bed.where());
    const Connection along{{node}, point.normal, space};
    builder.add_element(std::make_unique<Spring>(along, bed.stiffness * point.area), bed.where("stiffness"));
    if (bed.damping > 0) builder.add_element(std::make_unique<Dashpot>(along, bed.damping * point.area), bed.where("damping"));
    if (bed.mass > 0) builder.add_element(std::make_unique<PointMass>(space, node, bed.mass * point.area, Vec3::Zero()), bed.where("mass"));
    point.lower = {{node, 1.0}};
  }
}

Joint footing_joint(const CaseInterface& interface, const CaseFooting& table, bool rigid_ground, ModelBuilder& builder, CaseNames& names) {
  const bool in_space = names.space.dimension == 3;
  Footing footing;
  footing.body = names.node(table.body);
  footing.centre = names.positions[footing.body];
  if (table.offset) footing.centre += table.offset->in(names.space);
  footing.normal = normal_of(table, table.normal, names.space);
  footing.width = table.width;
  footing.thickness = table.thickness;
  footing.points = table.points;
  const auto check = [&](const char* key, bool given) {
    if (given != in_space)
      fail(table, key, in_space ? "length and points_across in space" : "width alone in the plane", given ? "given" : "none");
  };
  check("length", table.length.has_value());
  check("points_across", table.points_across.has_value());
  if (in_space) {
    footing.length = *table.length;
    footing.points_across = *table.points_across;
    footing.azimuth = table.azimuth;
    footing.thickness = 1;
  }
  footing.gap = interface.gap;
  footing.rule = table.rule;
  Joint joint;
  joint.facts.soil = soil_of(table);
  if (joint.facts.soil) spread_soil(*table.soil, *joint.facts.soil, footing);
  joint.points = footing_points(footing, table.where("points"));
  joint.facts.facets = std::make_shared<Facets>(names.space.dimension == 3 ? rectangle_facets(footing, joint.points)
                                                                           : line_facets(joint.points, footing.thickness));
  joint.facts.body = names.nodes[footing.body];
  joint.facts.corners = footing_corners(footing);
  joint.reference = footing.centre;
  if (table.bed && !rigid_ground) add_bed(*table.bed, interface.name.name, joint.points, builder, names);
  return joint;
}

Place middle_of(const Joint& joint) {
  Vec3 sum = Vec3::Zero();
  for (const JointPoint& point : joint.points) sum += point.area * point.position;
  return sum / joint.facts.area;
}

/// Nodes of one side of the points, each once.
std::vector<int> nodes_of_side(const std::vector<JointPoint>& points, std::vector<std::pair<int, double>> JointPoint::*side) {
  std::vector<int> nodes;
  for (const JointPoint& point : points)
    for (const auto& [node, shape] : point.*side) nodes.push_back(node);
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void add_surface(const CaseInterface& interface, const CaseSurface& surface, const std::vector<FacePair>& open, const CaseNames& names,
                 Joint& joint) {
  const FaceQuadrature quadrature = surface.nodal ? FaceQuadrature::nodal : FaceQuadrature::gauss;
  const Mesh& mesh = names.solids->mesh();
  const double thickness = thickness_of(*names.solids, open, surface);
  FaceJoints joints = face_joints(mesh, open, quadrature, thickness, interface.gap);
  joint.facts.facets =
      std::make_shared<Facets>(mesh.dimension == 3 ? face_facets(mesh, open, quadrature, joints) : line_facets(joints.points, thickness));
  joint.points = std::move(joints.points);
  for (JointPoint& point : joint.points)
    for (auto* side : {&point.upper, &point.lower})
      for (auto& [node, shape] : *side) node += names.first_of_mesh;
}

/// Of cells with doubles of their own: see jump_equations.
void limit_jumps(const CaseCut& cut, const std::vector<CutFace>& faces, const Vec3& normal, const CaseNames& names, ModelBuilder& builder) {
  const JumpShape shape = cut.jump == CaseCut::Jump::rigid ? JumpShape::rigid : JumpShape::constant;
  for (const CutFace& face : faces)
    for (const JumpEquation& equation : jump_equations(names.solids->mesh(), face, normal, shape)) {
      std::vector<std::pair<int, double>> terms;
      for (const JumpTerm& term : equation)
        terms.emplace_back(names.space.unknowns() * (names.first_of_mesh + term.node) + term.component, term.factor);
      builder.relate(std::move(terms), cut.where("jump"));
    }
}

/// Cones hold their points by constraints, which are too many on inclined faces and in triangles and tetrahedra: their tractions would not
/// be determined, and points of a closed base would open.
void add_cut(const CaseInterface& interface, const CaseCut& cut, const std::vector<CutFace>& faces, const CaseNames& names,
             ModelBuilder& builder, Joint& joint) {
  const Mesh& mesh = names.solids->mesh();
  const double thickness = mesh.dimension == 2 ? thickness_of(*names.solids, faces, cut) : 1;
  const Vec3 normal = normal_of_cut(cut, mesh.dimension);
  CutJoints made = cut_joints(mesh, faces, normal, thickness, interface.gap);
  if (cut.jump != CaseCut::Jump::linear) limit_jumps(cut, faces, normal, names, builder);
  joint.facts.facets = std::make_shared<Facets>(std::move(made.facets));
  if (made.simplices) joint.facts.why_no_cones = mesh.dimension == 2 ? "a plane through triangles" : "a plane through tetrahedra";
  if (made.inclined) joint.facts.why_no_cones = "a plane that cuts its cells at an angle";
  if (cut.jump != CaseCut::Jump::linear) joint.facts.why_no_cones = "a plane with constant or rigid jumps";
  for (const CutFace& face : faces) joint.facts.corners.insert(joint.facts.corners.end(), face.corners.begin(), face.corners.end());
  joint.points = std::move(made.points);
  for (JointPoint& point : joint.points)
    for (auto* side : {&point.upper, &point.lower})
      for (auto& [node, shape] : *side) node += names.first_of_mesh;
}

/// See InterfaceFacts::depth.
double depth_of(const CaseInterface& interface, const std::vector<FacePair>& open, const std::vector<CutFace>& cut,
                const CaseNames& names) {
  if (names.space.dimension == 3) return 0;
  if (const CaseFooting* footing = interface.footing()) return footing->thickness;
  if (const auto* line = std::get_if<CaseLine>(&interface.place)) return line->thickness;
  if (const CaseCut* table = interface.cut()) return thickness_of(*names.solids, cut, *table);
  return interface.surface() ? thickness_of(*names.solids, open, *interface.surface()) : 0;
}

}  // namespace

Joint make_joint(const CaseInterface& interface, const std::vector<FacePair>& open, const std::vector<CutFace>& cut_faces,
                 bool rigid_ground, ModelBuilder& builder, CaseNames& names) {
  const CaseFooting* footing = interface.footing();
  const CaseSurface* surface = interface.surface();
  const CaseCut* cut = interface.cut();
  Joint joint;
  if (footing) joint = footing_joint(interface, *footing, rigid_ground, builder, names);
  if (const auto* pairs = std::get_if<CasePairs>(&interface.place))
    joint.points = pair_points(side(pairs->upper, names), side(pairs->lower, names), normal_of(*pairs, pairs->normal, names.space),
                               pairs->area, interface.gap, names.space, pairs->where());
  if (const auto* line = std::get_if<CaseLine>(&interface.place)) {
    if (names.space.dimension == 3) fail(*line, "", "footing, pairs or surface in a model in space", "line");
    LineJoint made{side(line->upper, names), side(line->lower, names), line->nodes_per_element,
                   line->quadrature,         line->thickness,          interface.gap};
    joint.points = line_points(made, line->where());
    joint.facts.facets = std::make_shared<Facets>(line_facets(joint.points, made.thickness));
  }
  if (surface) add_surface(interface, *surface, open, names, joint);
  if (cut) add_cut(interface, *cut, cut_faces, names, builder, joint);
  if (surface) joint.facts.faces = open, joint.facts.nodal = surface->nodal;
  joint.facts.depth = depth_of(interface, open, cut_faces, names);
  set_gaps(interface, joint.points, names);
  set_water(interface.water, joint.points, names);
  const Place reference = joint.reference;
  joint = with_points(joint, joint.points);
  if (footing) joint.reference = reference;
  joint.facts.name = interface.name.name;
  return joint;
}

Joint with_points(const Joint& joint, std::vector<JointPoint> points) {
  Joint made{std::move(points), joint.facts, {}};
  made.facts.upper = nodes_of_side(made.points, &JointPoint::upper);
  made.facts.lower = nodes_of_side(made.points, &JointPoint::lower);
  made.facts.area = 0;
  for (const JointPoint& point : made.points) made.facts.area += point.area;
  made.reference = middle_of(made);
  if (joint.facts.facets && made.points.size() != joint.points.size())  // a line that was divided
    made.facts.facets = std::make_shared<Facets>(line_facets(made.points, joint.facts.depth));
  return made;
}

int components_of(const Values& behaviour, Space space) {
  if (const auto tangential = stated_tangential(behaviour)) return *tangential == "none" ? 1 : space.dimension;
  return behaviour.type() == "unilateral" ? 1 : space.dimension;
}

}  // namespace uplift
