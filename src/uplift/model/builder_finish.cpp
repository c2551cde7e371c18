#include <fmt/format.h>

#include "uplift/model/builder.h"
#include "uplift/model/damping.h"

namespace uplift {

namespace {

void add_to(Space space, const Element& element, const Matrix& local, double factor, std::vector<Triplet>& entries) {
  const auto nodes = element.nodes();
  const int each = element.unknowns_per_node();
  const auto unknown = [&](Index i) { return space.unknowns() * nodes[i / each] + static_cast<int>(i % each); };
  for (Index j = 0; j < local.cols(); ++j)
    for (Index i = 0; i < local.rows(); ++i)
      if (local(i, j) != 0) entries.emplace_back(unknown(i), unknown(j), factor * local(i, j));
}

/// Entries of all element matrices, at most.
std::size_t entries_of(const std::vector<std::unique_ptr<const Element>>& elements) {
  std::size_t count = 0;
  for (const auto& element : elements) {
    const std::size_t unknowns = element->nodes().size() * static_cast<std::size_t>(element->unknowns_per_node());
    count += unknowns * unknowns;
  }
  return count;
}

Sparse from(int unknowns, const std::vector<Triplet>& entries) {
  Sparse matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Diagonal of |T|^T |A| |T|.
Vector sizes(const Sparse& t, const Sparse& a) {
  Vector size = Vector::Zero(t.cols()), weight = Vector::Zero(t.rows());  // weight: |column of T|
  for (Index j = 0; j < t.cols(); ++j) {
    for (Sparse::InnerIterator row(t, j); row; ++row) weight[row.row()] = std::abs(row.value());
    for (Sparse::InnerIterator row(t, j); row; ++row)
      for (Sparse::InnerIterator entry(a, row.row()); entry; ++entry)
        size[j] += std::abs(entry.value()) * weight[entry.row()] * std::abs(row.value());
    for (Sparse::InnerIterator row(t, j); row; ++row) weight[row.row()] = 0;
  }
  return size;
}

/// T^T A T. Entries that are only round-off of a cancellation become true zeros, so that «massless» and «without stiffness» are facts.
Sparse reduced(const Sparse& t, const Sparse& a) {
  Sparse result = t.transpose() * a * t;
  const Vector size = sizes(t, a);
  Vector diagonal = result.diagonal();
  for (Index i = 0; i < diagonal.size(); ++i)
    if (std::abs(diagonal[i]) <= 1e-12 * size[i]) diagonal[i] = 0;
  result.prune([&](Index i, Index j, double value) { return std::abs(value) > 1e-15 * std::sqrt(std::abs(diagonal[i] * diagonal[j])); });
  return result;
}

Vector translation(Space space, const Vec3& direction, Index unknowns) {
  Vector full = Vector::Zero(unknowns);
  for (Index i = 0; i < unknowns; i += space.unknowns()) full.segment(i, space.dimension) = direction.head(space.dimension);
  return full;
}

/// True for the unknowns that anything resists.
std::vector<char> resisted(const Model& model, const Sparse& b) {
  std::vector<char> mask(model.free(), 0);
  for (const Sparse* matrix : {&model.stiffness, &model.mass, &model.damping})
    for (int i = 0; i < model.free(); ++i)
      if (matrix->coeff(i, i) != 0) mask[i] = 1;
  for (int i = 0; i < model.free(); ++i)
    for (Sparse::InnerIterator entry(b, i); entry; ++entry)
      if (entry.value() != 0) mask[i] = 1;
  return mask;
}

}  // namespace

void ModelBuilder::assemble(Assembly& assembly) const {
  const int unknowns = space_.unknowns() * static_cast<int>(nodes_.size());
  // one matrix after another: the lists of entries are the largest thing that is ever there beside the factors
  const auto sum = [&](Matrix* Local::*wanted, bool proportional) {
    std::vector<Triplet> entries;
    if (wanted != &Local::damping) entries.reserve(entries_of(elements_));  // a list that grows is there twice
    for (const auto& element : elements_) {
      Matrix local, stiffness;
      Local one;
      one.*wanted = &local;
      if (proportional && element->beta != 0) one.stiffness = &stiffness;
      element->form(one);
      add_to(space_, *element, local, 1, entries);
      if (stiffness.size() > 0) add_to(space_, *element, stiffness, element->beta, entries);
    }
    return from(unknowns, entries);
  };
  assembly.stiffness = sum(&Local::stiffness, false);
  assembly.mass = sum(&Local::mass, false);
  assembly.damping = sum(&Local::damping, true);
  if (damping_.alpha != 0) assembly.damping += damping_.alpha * assembly.mass;
  if (damping_.beta != 0) assembly.damping += damping_.beta * assembly.stiffness;
  assembly.gravity = gravity_;
}

void ModelBuilder::make_drives(Model& model, const Matrix& motion_shapes) const {
  const Assembly& full = model.assembly;
  const Index unknowns = full.mass.rows();
  const auto one = std::make_shared<const One>();
  const auto add = [&](std::string name, const Vector& pattern, std::shared_ptr<const TimeFunction> function, bool dead) {
    model.drives.push_back({std::move(name), model.reduction.transpose() * pattern, std::move(function), Drive::Order::value, dead});
    model.assembly.loads.push_back(pattern);
  };
  if (!gravity_.isZero()) add("gravity", full.mass * translation(space_, gravity_, unknowns), one, true);
  for (const Load& load : loads_) {
    Vector pattern = Vector::Zero(unknowns);
    for (const auto& [unknown, value] : load.pattern) pattern[unknown] += value;
    add(load.name, pattern, load.function ? load.function : one, load.dead);
  }
  for (const GroundAcceleration& ground : grounds_)
    add(ground.name, -(full.mass * translation(space_, ground.direction, unknowns)), ground.function, false);
  for (const Feeding& feed : feeds_) {
    Sparse pattern(unknowns, feed.functions);
    pattern.setFromTriplets(feed.pattern.begin(), feed.pattern.end());
    model.feeds.push_back({feed.name, model.reduction.transpose() * pattern, feed.values});
  }
  for (Index k = 0; k < motion_shapes.cols(); ++k) {
    const Motion& motion = motions_[k];
    const Vector shape = motion_shapes.col(k);
    model.motions.push_back({motion.name, shape, full.b * shape, motion.function});
    const std::pair<const Sparse*, Drive::Order> parts[] = {
        {&full.stiffness, Drive::Order::value}, {&full.damping, Drive::Order::rate}, {&full.mass, Drive::Order::acceleration}};
    for (const auto& [matrix, order] : parts) {
      Vector force = -(model.reduction.transpose() * (*matrix * shape));
      if (force.isZero(0)) continue;
      model.drives.push_back({motion.name, std::move(force), motion.function, order, false});
      model.assembly.loads.emplace_back();
    }
  }
}

Model ModelBuilder::finish() {
  Model model;
  model.space = space_;
  Matrix motion_shapes;
  assemble(model.assembly);
  eliminate(model, motion_shapes);
  if (!keeps_tangents_) drop_dead_tangents(model, motion_shapes);
  place_interfaces(model);

  const Assembly& full = model.assembly;
  const auto reduce = [&] {
    model.stiffness = reduced(model.reduction, full.stiffness);
    model.mass = reduced(model.reduction, full.mass);
    model.damping = reduced(model.reduction, full.damping);
  };
  reduce();
  const std::vector<char> mask = resisted(model, full.b * model.reduction);
  std::vector<int> columns;
  for (int i = 0; i < model.free(); ++i) {
    if (mask[i]) {
      columns.push_back(i);
      continue;
    }
    for (const Load& load : loads_)
      for (const auto& [unknown, value] : load.pattern)
        if (value != 0 && model.reduction.coeff(unknown, i) != 0)
          throw InputError(load.where, load.name, "a load on something that resists",
                           fmt::format("a load on {}, which nothing holds", name_of(unknown)));
  }
  Sparse select(model.free(), static_cast<Index>(columns.size()));
  for (Index c = 0; c < select.cols(); ++c) select.insert(columns[c], c) = 1;
  model.reduction = (model.reduction * select).eval();
  model.expansion = model.reduction.transpose();
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c] = model.kept[columns[c]];
  model.kept = std::move(columns);
  for (const int unknown : model.kept) model.unknown_names.push_back(name_of(unknown));
  reduce();
  Index first = 0;
  const Sparse b = full.b * model.reduction;
  const SparseRows b_rows = b;
  for (Interface& face : model.interfaces) {
    face.b = b_rows.middleRows(first, face.rows());
    first += face.rows();
  }
  make_drives(model, motion_shapes);
  if (!damping_.modal.empty()) model.damping += modal_damping(model, damping_.modal, damping_.modal_count, {});
  model.grounds = grounds_;
  model.nodes = std::move(nodes_);
  model.elements = std::move(elements_);
  return model;
}

}  // namespace uplift
