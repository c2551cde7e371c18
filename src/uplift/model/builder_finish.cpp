#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "uplift/model/builder.h"
#include "uplift/model/damping.h"

namespace uplift {

namespace {

/// Diagonal of T^T A T.
Vector reduced_diagonal(const Sparse& t, const Sparse& a) {
  Vector diagonal = Vector::Zero(t.cols()), weight = Vector::Zero(t.rows());  // weight: column of T
  for (Index j = 0; j < t.cols(); ++j) {
    for (Sparse::InnerIterator row(t, j); row; ++row) weight[row.row()] = row.value();
    for (Sparse::InnerIterator row(t, j); row; ++row)
      for (Sparse::InnerIterator entry(a, row.row()); entry; ++entry) diagonal[j] += weight[entry.row()] * entry.value() * row.value();
    for (Sparse::InnerIterator row(t, j); row; ++row) weight[row.row()] = 0;
  }
  return diagonal;
}

/// T^T A T without entries that are only round-off, column by column: a product of sparse matrices takes three times the memory.
Sparse reduced(const Sparse& t, const Sparse& a) {
  const Sparse rows = t.transpose();
  const Vector diagonal = reduced_diagonal(t, a);
  Sparse result(t.cols(), t.cols());
  result.reserve(a.nonZeros());
  Vector sum = Vector::Zero(t.cols());
  std::vector<char> met(static_cast<std::size_t>(t.cols()), 0);
  std::vector<int> entries;  // of the column
  for (Index j = 0; j < t.cols(); ++j) {
    for (Sparse::InnerIterator row(t, j); row; ++row)
      for (Sparse::InnerIterator entry(a, row.row()); entry; ++entry)
        for (Sparse::InnerIterator to(rows, entry.row()); to; ++to) {
          sum[to.row()] += to.value() * entry.value() * row.value();
          if (std::exchange(met[static_cast<std::size_t>(to.row())], 1) == 0) entries.push_back(static_cast<int>(to.row()));
        }
    std::ranges::sort(entries);
    result.startVec(j);
    for (const int i : entries) {
      if (std::abs(sum[i]) > 1e-15 * std::sqrt(std::abs(diagonal[i] * diagonal[j]))) result.insertBack(i, j) = sum[i];
      sum[i] = 0;
      met[static_cast<std::size_t>(i)] = 0;
    }
    entries.clear();
  }
  result.finalize();
  return result;
}

Vector translation(Space space, const Vec3& direction, Index unknowns) {
  Vector full = Vector::Zero(unknowns);
  for (Index i = 0; i < unknowns; i += space.unknowns()) full.segment(i, space.dimension) = direction.head(space.dimension);
  return full;
}

}  // namespace

ModelBuilder::Full ModelBuilder::assemble() const {
  const auto sum = [&](Matrix* Local::*wanted) { return assembled(space_, nodes_.size(), elements_, wanted); };
  // one matrix after another: the lists of entries are the largest thing that is ever there beside the factors
  Full full{.stiffness = sum(&Local::stiffness), .mass = sum(&Local::mass), .damping = sum(&Local::damping)};
  if (damping_.alpha != 0) full.damping += damping_.alpha * full.mass;
  if (damping_.beta != 0) full.damping += damping_.beta * full.stiffness;
  return full;
}

void ModelBuilder::make_drives(Model& model, const Full& full, const Matrix& motion_shapes) const {
  const Index unknowns = full.mass.rows();
  const auto one = std::make_shared<const One>();
  const auto add = [&](std::string name, const Vector& pattern, std::shared_ptr<const TimeFunction> function, bool dead) {
    const bool constant = function->is_one();
    model.time_loads.push_back(
        {std::move(name), model.reduction.transpose() * pattern, std::move(function), TimeLoad::Order::value, dead, constant});
    model.assembly.loads.push_back(pattern);
  };
  if (!gravity_.isZero()) add("gravity", full.mass * translation(space_, gravity_, unknowns), one, true);
  for (std::size_t k = 0; k < interfaces_.size(); ++k)
    if (std::ranges::any_of(interfaces_[k].points, [](const JointPoint& point) { return point.water != 0; }))
      add("water pressure in " + interfaces_[k].name, water_load(model, k), one, true);
  for (const Load& load : loads_) {
    Vector pattern = Vector::Zero(unknowns);
    for (const auto& [unknown, value] : load.pattern) pattern[unknown] += value;
    add(load.name, pattern, load.function ? load.function : one, load.dead);
  }
  for (const GroundAcceleration& ground : grounds_)
    add(ground.name, -(full.mass * translation(space_, ground.direction, unknowns)), ground.function, false);
  for (const TableOfLoads& table : tables_) {
    Sparse pattern(unknowns, table.functions);
    pattern.setFromTriplets(table.pattern.begin(), table.pattern.end());
    model.time_load_tables.push_back({table.name, model.reduction.transpose() * pattern, table.values});
    model.assembly.time_load_tables.push_back(std::move(pattern));
  }
  for (Index k = 0; k < motion_shapes.cols(); ++k) {
    const Motion& motion = motions_[k];
    const Vector shape = motion_shapes.col(k);
    model.motions.push_back({motion.name, shape, model.assembly.b * shape, motion.function});
    const std::pair<const Sparse*, TimeLoad::Order> parts[] = {
        {&full.stiffness, TimeLoad::Order::value}, {&full.damping, TimeLoad::Order::rate}, {&full.mass, TimeLoad::Order::acceleration}};
    for (const auto& [matrix, order] : parts) {
      Vector force = -(model.reduction.transpose() * (*matrix * shape));
      if (force.isZero(0)) continue;
      model.time_loads.push_back({motion.name, std::move(force), motion.function, order, false, false, true});
      model.assembly.loads.emplace_back();
    }
  }
}

/// The columns of T that anything resists; a load on another one is refused.
std::vector<int> ModelBuilder::resisted(const Model& model, const Full& full) const {
  std::vector<char> mask(static_cast<std::size_t>(model.free()), 0);
  for (const Sparse* matrix : {&full.stiffness, &full.mass, &full.damping}) {
    const Vector diagonal = reduced_diagonal(model.reduction, *matrix);
    for (Index i = 0; i < diagonal.size(); ++i)
      if (diagonal[i] != 0) mask[i] = 1;
  }
  const Sparse b = model.assembly.b * model.reduction;
  for (int i = 0; i < model.free(); ++i)
    for (Sparse::InnerIterator entry(b, i); entry; ++entry)
      if (entry.value() != 0) mask[i] = 1;
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
  return columns;
}

Model ModelBuilder::finish() {
  Model model;
  model.space = space_;
  Matrix motion_shapes;
  model.assembly.gravity = gravity_;
  const Full full = assemble();
  eliminate(model, motion_shapes);
  if (!keeps_tangents_) drop_dead_tangents(model, motion_shapes);
  place_interfaces(model);

  std::vector<int> columns = resisted(model, full);
  if (static_cast<int>(columns.size()) < model.free()) {
    Sparse select(model.free(), static_cast<Index>(columns.size()));
    for (Index c = 0; c < select.cols(); ++c) select.insert(columns[c], c) = 1;
    model.reduction = (model.reduction * select).eval();
  }
  model.expansion = model.reduction.transpose();
  model.stiffness = reduced(model.reduction, full.stiffness);
  model.mass = reduced(model.reduction, full.mass);
  model.damping = reduced(model.reduction, full.damping);
  for (std::size_t c = 0; c < columns.size(); ++c) columns[c] = model.kept[columns[c]];
  model.kept = std::move(columns);
  for (const int unknown : model.kept) model.unknown_names.push_back(name_of(unknown));
  Index first = 0;
  const Sparse b = model.assembly.b * model.reduction;
  const SparseRows b_rows = b;
  for (Interface& face : model.interfaces) {
    face.b = b_rows.middleRows(first, face.rows());
    first += face.rows();
  }
  make_drives(model, full, motion_shapes);
  model.assembly.mass_damping = damping_.alpha;
  model.assembly.stiffness_damping = damping_.beta;
  if (!damping_.modal.empty()) {
    model.assembly.modal_damping = modal_damping(model, damping_.modal, damping_.modal_count, {});
    model.damping += model.assembly.modal_damping;
  }
  model.grounds = grounds_;
  model.nodes = std::move(nodes_);
  model.elements = std::move(elements_);
  return model;
}

}  // namespace uplift
