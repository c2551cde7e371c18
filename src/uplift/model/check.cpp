#include "uplift/model/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "uplift/math/dense.h"
#include "uplift/math/sparse_solvers.h"
#include "uplift/model/hinges.h"
#include "uplift/model/matrix_sum.h"
#include "uplift/model/rigid_parts.h"

namespace uplift {

namespace {

/// Diagonal scaling to ones, so that pivots can be compared; unknowns without stiffness get a one that never couples.
Sparse unit_diagonal(const Sparse& a, Vector& scale, std::vector<int>& empty) {
  scale = Vector(a.diagonal());
  Sparse result = a;
  for (Index i = 0; i < scale.size(); ++i) {
    if (!(scale[i] > 0)) {
      empty.push_back(static_cast<int>(i));
      result.coeffRef(i, i) = 1;
      scale[i] = 1;
    } else {
      scale[i] = 1 / std::sqrt(scale[i]);
    }
  }
  return scale.asDiagonal() * result * scale.asDiagonal();
}

/// Translation and rotation of every node.
struct Motions {
  std::vector<Vec3> translation, rotation;
};

Motions motions_of(const Model& model, const Vector& full) {
  const Space space = model.space;
  Motions motions{std::vector<Vec3>(model.nodes.size(), Vec3::Zero()), std::vector<Vec3>(model.nodes.size(), Vec3::Zero())};
  for (int i = 0; i < static_cast<int>(full.size()); ++i)
    (space.is_rotation(i) ? motions.rotation : motions.translation)[space.node_of(i)] += full[i] * space.axis(space.index_of(i));
  return motions;
}

/// Three digits, round-off shown as 0.
std::string text(const Vec3& v, Space space) {
  return to_string(v.unaryExpr([](double value) { return std::abs(value) < 1e-6 ? 0.0 : value; }), space, 3);
}

/// The direction whose first number that is not zero is positive.
Vec3 forward(const Vec3& v) {
  const Vec3 direction = v.normalized();
  for (int k = 0; k < 3; ++k)
    if (std::abs(direction[k]) > 1e-9) return direction[k] < 0 ? Vec3(-direction) : direction;
  return direction;
}

/// Rotation of the rigid motion that fits the translations of some nodes best; that of the first node when none moves.
Vec3 turn_of(const Model& model, const Motions& motions, const std::vector<int>& nodes) {
  Vec3 centre = Vec3::Zero(), mean = Vec3::Zero();
  for (const int i : nodes) {
    centre += model.nodes[i].position / static_cast<double>(nodes.size());
    mean += motions.translation[i] / static_cast<double>(nodes.size());
  }
  Matrix inertia = Matrix::Zero(3, 3);
  Vector spin = Vector::Zero(3);
  for (const int i : nodes) {
    const Vec3 r = model.nodes[i].position - centre;
    inertia += r.squaredNorm() * Matrix::Identity(3, 3) - r * r.transpose();
    spin += cross(r, motions.translation[i] - mean);
  }
  const Vec3& first = motions.rotation[nodes.front()];
  if (spin.norm() <= 1e-9 * inertia.norm() * first.norm()) return first;  // at one place, or on the axis
  return CompleteQr(inertia).solve(spin);
}

}  // namespace

std::string describe_motion(const Model& model, const Vector& motion) {
  const Motions motions = motions_of(model, model.expand(motion));
  const auto& [u, theta] = motions;
  double size = 1e-3, largest = 0;
  for (const Node& node : model.nodes) size = std::max(size, (node.position - model.nodes.front().position).norm());
  const int count = static_cast<int>(model.nodes.size());
  const auto moved = [&](int i) { return std::max(u[i].norm(), theta[i].norm() * size); };
  for (int i = 0; i < count; ++i) largest = std::max(largest, moved(i));
  std::vector<std::string> names;
  std::vector<int> moving;
  for (int i = 0; i < count; ++i)
    if (moved(i) > 1e-6 * largest) {
      moving.push_back(i);
      if (names.size() < 5) names.push_back("\"" + model.nodes[i].name + "\"");
    }
  if (moving.size() > names.size()) names.push_back(fmt::format("{} more nodes", moving.size() - names.size()));
  const std::string who = fmt::format("{}", fmt::join(names, ", "));

  const int first = moving.front();
  const Vec3 turn = turn_of(model, motions, moving);
  const bool together = std::ranges::all_of(moving, [&](int i) {
    const Vec3 r = model.nodes[i].position - model.nodes[first].position;
    const bool turns = theta[i].isZero(0) || (theta[i] - turn).norm() * size < 1e-5 * largest;  // nodes of solids have no rotation
    return (u[i] - u[first] - cross(turn, r)).norm() < 1e-5 * largest && turns;
  });
  if (together && turn.norm() * size < 1e-6 * largest)
    return fmt::format("{} can move along {}", who, text(forward(u[first]), model.space));
  if (together) {
    const Vec3 centre = model.nodes[first].position + cross(turn, u[first]) / turn.squaredNorm();  // moves along the axis at most
    if (model.space.dimension == 2) return fmt::format("{} can turn about the point {} m", who, text(centre, model.space));
    return fmt::format("{} can turn about the axis {} through {} m", who, text(forward(turn), model.space), text(centre, model.space));
  }
  Index most = 0;
  motion.cwiseAbs().maxCoeff(&most);
  return fmt::format("{} can move, most of all {}", who, model.unknown_name(most));
}

namespace {

/// Of the first interface; without: `other`.
Where place_of_interface(const Model& model, const Where& other) {
  return model.assembly.interface_where.empty() ? other : model.assembly.interface_where.front();
}

/// Whether a motion of the free unknowns moves a node on which an interface acts.
bool moves_interfaces(const Model& model, const Vector& motion) {
  Vector touched = Vector::Zero(model.free());
  for (const Interface& interface : model.interfaces) touched += interface.b.cwiseAbs().transpose() * Vector::Ones(interface.b.rows());
  const Vector by_interfaces = model.reduction().cwiseAbs() * touched, moved = model.expand(motion).cwiseAbs();
  const double least = 1e-6 * moved.maxCoeff();
  const int unknowns = model.space.unknowns();
  for (Index first = 0; first + unknowns <= moved.size(); first += unknowns)
    if (by_interfaces.segment(first, unknowns).maxCoeff() > 0 && moved.segment(first, unknowns).maxCoeff() > least) return true;
  return false;
}

/// Groups of unknowns that the matrix couples.
std::vector<int> blocks(const Sparse& a) {
  std::vector<int> parent(a.rows());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (Index j = 0; j < a.outerSize(); ++j)
    for (Sparse::InnerIterator entry(a, j); entry; ++entry) parent[root(static_cast<int>(entry.row()))] = root(static_cast<int>(j));
  for (int i = 0; i < static_cast<int>(parent.size()); ++i) parent[i] = root(i);
  return parent;
}

}  // namespace

void check_static(const Model& model, const std::function<Where(const std::string& node)>& place_of) {
  const Vector motion = unresisted_motion(model, Resistance::stiffness);
  if (motion.size() == 0) return;
  const std::string loose = describe_motion(model, motion);
  const std::vector<Vec3> moved = motions_of(model, model.expand(motion)).translation;
  double largest = 0;
  for (const Vec3& each : moved) largest = std::max(largest, each.norm());
  const auto first = std::ranges::find_if(moved, [&](const Vec3& each) { return each.norm() >= 0.5 * largest; });
  const Where node = place_of ? place_of(model.nodes[static_cast<std::size_t>(first - moved.begin())].name) : Where();
  const std::vector<int> hinged = hinges(model);
  const char* wanted =
      model.interfaces.empty() ? "a structure that its supports hold" : "a structure that stands when all its interfaces are closed";
  const bool on_interface = moves_interfaces(model, motion);
  throw InputError(on_interface || !place_of ? place_of_interface(model, node) : node, "", wanted,
                   fmt::format("a mechanism: {} without resistance{}", loose,
                               !hinged.empty() ? "; beams end in hinges of solids: " + named_places(model, hinged)
                               : on_interface  ? "; hold it by a [[support]], a [[spring]] or K_t of an interface"
                                               : "; hold it by a [[support]] or a [[spring]]"));
}

namespace {

/// Throws where an interface touches an unknown without mass that `refused` names.
template <class Refused>
void require_mass(const Model& model, const Refused& refused) {
  const Vector mass = diagonal_of(model, &Model::mass);
  for (std::size_t k = 0; k < model.interfaces.size(); ++k) {
    const Sparse& b = model.interfaces[k].b;
    for (int i = 0; i < model.free(); ++i)
      for (Sparse::InnerIterator entry(b, i); entry; ++entry)
        if (entry.value() != 0 && !(mass[i] > 0) && refused(model.interfaces[k], i))
          throw InputError(model.assembly.interface_where[k], "interface." + model.interfaces[k].name,
                           "a mass on everything that the interface touches",
                           fmt::format("zero mass where mass is needed: {} has none", model.unknown_name(i)));
  }
}

/// Throws where the mass matrix is singular although not massless.
void check_masses(const Model& model, const Where& file) {
  Vector scale;
  std::vector<int> massless;
  // a motion without kinetic energy moves no node of a massive solid: those need not be looked at
  const std::vector<char> by_solid = moved_by_solid_mass(model);
  std::vector<int> others;
  std::vector<Triplet> chosen;
  for (int i = 0; i < model.free(); ++i)
    if (!by_solid[i]) {
      chosen.emplace_back(i, static_cast<int>(others.size()), 1.0);
      others.push_back(i);
    }
  if (others.empty()) return;
  Sparse select(model.free(), static_cast<Index>(others.size()));
  select.setFromTriplets(chosen.begin(), chosen.end());
  const Sparse scaled = unit_diagonal(chosen_block(model, &Model::mass, select), scale, massless);
  const SparseLdlt ldlt(scaled);
  for (Index k = 0; k < scaled.rows(); ++k) {
    if (ldlt.vectorD()[k] > 1e-12) continue;
    const int broken = ldlt.permutationPinv().indices()[k];
    const std::vector<int> block = blocks(scaled);
    std::vector<std::string> members;
    for (std::size_t i = 0; i < others.size(); ++i)
      if (block[i] == block[broken] && members.size() < 6) members.push_back(model.unknown_name(others[i]));
    throw InputError(
        place_of_interface(model, file), "mass", "a mass matrix that is regular where it is not zero",
        fmt::format(
            "zero mass where mass is needed: a motion of {} without kinetic energy (a point mass off its node needs an inertia > 0)",
            fmt::join(members, ", ")));
  }
}

}  // namespace

void check_impulses(const Model& model) {
  require_mass(model, [](const Interface&, int) { return true; });
}

void check_dynamic(const Model& model, const Where& file) {
  if (model.free() == 0) return;
  require_mass(model, [](const Interface& face, int) { return face.cone != nullptr; });
  check_masses(model, file);
  const Vector unresisted = unresisted_motion(model, Resistance::dynamic);
  if (unresisted.size() > 0)
    throw InputError(place_of_interface(model, file), "", "a stiffness, a mass, a dashpot or an interface against every motion",
                     describe_motion(model, unresisted) + " without any of them");
}

}  // namespace uplift
