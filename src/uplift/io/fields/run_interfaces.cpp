#include <algorithm>
#include <cassert>

#include "uplift/case/mesh/mesh.h"
#include "uplift/interface/face_joint.h"
#include "uplift/io/fields/run_frames.h"
#include "uplift/math/dense.h"

// Joint points stand at the nodes of faces or at Gauss points; what is written stands at the nodes of every face.
namespace uplift {
namespace {

using Terms = std::vector<std::pair<int, double>>;

/// Direction of a local component of an interface point; the normal is the last one.
Vec3 direction(const Interface& interface, int point, int component) {
  return component_axis(interface, point, component).axis;
}

/// From the Gauss points of a face to its nodes: the least-squares fit of the shape functions, weighted with the areas, so that the
/// integral over the face is kept: (S^T A S) v = S^T A f.
std::vector<Terms> fitted_places(std::span<const int> lower, const FaceJoints& joints, const std::vector<int>& own) {
  if (own.empty()) return std::vector<Terms>(lower.size());  // all its nodes are inside the continuum
  Matrix shape = Matrix::Zero(static_cast<Index>(own.size()), static_cast<Index>(lower.size()));
  Vector area(static_cast<Index>(own.size()));
  for (std::size_t i = 0; i < own.size(); ++i) {
    const JointPoint& point = joints.points[static_cast<std::size_t>(own[i])];
    area[static_cast<Index>(i)] = point.area;
    for (const auto& [node, value] : point.lower) shape(static_cast<Index>(i), std::ranges::find(lower, node) - lower.begin()) = value;
  }
  const Matrix weighted = shape.transpose() * area.asDiagonal();
  const Matrix fit = PivotedLdlt(weighted * shape).solve(weighted);
  std::vector<Terms> terms(lower.size());
  for (std::size_t a = 0; a < terms.size(); ++a)
    for (std::size_t i = 0; i < own.size(); ++i) terms[a].emplace_back(own[i], fit(static_cast<Index>(a), static_cast<Index>(i)));
  return terms;
}

/// For every node of every face what stands there, made of the joint points.
std::vector<Terms> places_of(const Mesh& mesh, const std::vector<FacePair>& faces, FaceQuadrature quadrature,
                             [[maybe_unused]] int joint_points) {
  std::vector<Terms> places;
  const FaceJoints joints = face_joints(mesh, faces, quadrature, 1, 0);
  assert(static_cast<int>(joints.points.size()) == joint_points);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::span<const int> lower = mesh.cell(faces[f].lower);
    const std::vector<int>& own = joints.of_face[f];
    std::vector<Terms> here(lower.size());
    if (quadrature == FaceQuadrature::gauss) here = fitted_places(lower, joints, own);
    for (std::size_t a = 0; quadrature == FaceQuadrature::nodal && a < lower.size() && !own.empty(); ++a)
      if (own[a] >= 0) here[a] = {{own[a], 1.0}};
    places.insert(places.end(), here.begin(), here.end());
  }
  return places;
}

/// A number of a law or cone that may not be there.
double number_or(const Values& behaviour, std::string_view key, double otherwise) {
  return behaviour.items().contains(key) && behaviour.has(key) ? behaviour.number(key) : otherwise;
}

}  // namespace

InterfaceFrames::InterfaceFrames(const Case& read, const BuiltCase& built)
    : model_(&built.model), gap_tolerance_(built.plan.gap_tolerance) {
  std::vector<OpenedSurface> faces;
  int row = 0;
  for (std::size_t k = 0; k < built.facts.size(); ++k) {
    const Interface& interface = model_->interfaces[k];
    const InterfaceFacts& facts = built.facts[k];
    if (!facts.faces.empty()) {
      const Values& behaviour = *built.behaviours[k];
      Surface surface{static_cast<int>(k), row, -1, 0, gap_rule(interface), {}};
      surface.friction = number_or(behaviour, "friction", -1);
      surface.cohesion = number_or(behaviour, "cohesion", 0);
      surface.places =
          places_of(read.mesh->mesh, facts.faces, facts.nodal ? FaceQuadrature::nodal : FaceQuadrature::gauss, interface.batch.points);
      surfaces_.push_back(std::move(surface));
      faces.push_back({interface.name, facts.faces, {}});
    }
    row += interface.rows();
  }
  mesh_ = interface_mesh(read.mesh->mesh, "interfaces", faces);
}

int InterfaceFrames::status(const Surface& surface, double gap, double pressure, double shear) const {
  constexpr double reached = 1 - 1e-6;
  if (gap > gap_tolerance_) return 0;
  return surface.friction >= 0 && shear >= reached * (surface.friction * std::max(pressure, 0.0) + surface.cohesion) ? 2 : 1;
}

/// One joint point, added at the end.
void InterfaceFrames::add_point(const Surface& surface, const State& state, int point, JointValues& values) const {
  const Interface& interface = model_->interfaces[static_cast<std::size_t>(surface.interface)];
  const int translations = interface.batch.translations();
  Vec3 slip = Vec3::Zero(), shear = Vec3::Zero(), traction = Vec3::Zero();
  double opening = 0, gap = 0, pressure = 0;
  for (int c = 0; c < translations; ++c) {
    const int row = surface.first_row + c * interface.batch.points + point;
    const Vec3 axis = direction(interface, point, c);
    const double stress = state.mean_force[row] / interface.area[point];
    traction += stress * axis;
    if (c == translations - 1) {
      opening = state.opening[row];
      gap = surface.rule.gap(opening, state.force[row] / interface.area[point]);
      pressure = 0.0 - stress;
    } else {
      slip += state.opening[row] * axis;
      shear += stress * axis;
    }
  }
  values.opening.push_back(opening);
  values.pressure.push_back(pressure);
  values.slip.insert(values.slip.end(), slip.begin(), slip.end());
  values.traction.insert(values.traction.end(), traction.begin(), traction.end());
  values.status.push_back(status(surface, gap, pressure, shear.norm()));
}

InterfaceFrames::JointValues InterfaceFrames::at(const State& state) const {
  JointValues all;
  for (const Surface& surface : surfaces_) {
    JointValues points;
    const int count = model_->interfaces[static_cast<std::size_t>(surface.interface)].batch.points;
    for (int point = 0; point < count; ++point) add_point(surface, state, point, points);
    const auto sum = [](const Terms& terms, const std::vector<double>& values, std::size_t width, std::vector<double>& to) {
      for (std::size_t c = 0; c < width; ++c) {
        double total = 0;
        for (const auto& [point, weight] : terms) total += weight * values[width * static_cast<std::size_t>(point) + c];
        to.push_back(total);
      }
    };
    for (const Terms& terms : surface.places) {
      sum(terms, points.opening, 1, all.opening);
      sum(terms, points.slip, 3, all.slip);
      sum(terms, points.traction, 3, all.traction);
      sum(terms, points.pressure, 1, all.pressure);
      const auto weight = [](const std::pair<int, double>& term) { return term.second; };
      all.status.push_back(terms.empty() ? 1 : points.status[static_cast<std::size_t>(std::ranges::max_element(terms, {}, weight)->first)]);
    }
  }
  return all;
}

}  // namespace uplift
