#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "uplift/model/builder.h"
#include "uplift/model/damping.h"
#include "uplift/model/equal_cells.h"
#include "uplift/model/matrix_sum.h"
#include "uplift/model/numbering.h"

namespace uplift {

namespace {

/// M d, full unknowns, for a translation d of everything. Vectors of all unknowns are large: none outlives its use.
Vector times_translation(const ElementSum& mass, Space space, const Vec3& direction, Index unknowns) {
  Matrix full = Matrix::Zero(unknowns, 1);
  for (Index i = 0; i < unknowns; i += space.unknowns()) full.col(0).segment(i, space.dimension) = direction.head(space.dimension);
  mass.times(full).swap(full);
  return full.col(0);
}

/// Some rows of a matrix, ascending.
Sparse chosen_rows(const Sparse& matrix, const std::vector<int>& rows) {
  std::vector<int> place(static_cast<std::size_t>(matrix.rows()), -1);
  for (std::size_t c = 0; c < rows.size(); ++c) place[static_cast<std::size_t>(rows[c])] = static_cast<int>(c);
  const std::span<const int> of_entries(matrix.innerIndexPtr(), static_cast<std::size_t>(matrix.nonZeros()));
  Sparse made(std::ssize(rows), matrix.cols());
  made.reserve(std::ranges::count_if(of_entries, [&](int row) { return place[static_cast<std::size_t>(row)] >= 0; }));
  for (Index column = 0; column < matrix.cols(); ++column) {
    made.startVec(column);
    for (Sparse::InnerIterator entry(matrix, column); entry; ++entry)
      if (const int row = place[static_cast<std::size_t>(entry.row())]; row >= 0) made.insertBack(row, column) = entry.value();
  }
  made.finalize();
  return made;
}

}  // namespace

void ModelBuilder::assemble(Model& model) const {
  model.assembly.mass_damping = damping_.alpha;
  model.assembly.stiffness_damping = damping_.beta;
  if (is_distributed(model)) return distribute(model);
  // exchanged: an assignment of a sparse matrix is a copy
  sum(&Local::stiffness).reduced(model.expansion).swap(model.stiffness);
  sum(&Local::mass).reduced(model.expansion).swap(model.mass);
  add_rayleigh(model, sum(&Local::damping).reduced(model.expansion), model.damping);
}

bool ModelBuilder::is_distributed(const Model& model) const {
  return home_ != nullptr && model.free() > most_undistributed && damping_.modal.empty();
}

/// Every process makes its rows. Of equal cells there are none, but one matrix for all of them.
void ModelBuilder::distribute(Model& model) const {
  std::vector<int> firsts;
  renumber(numbers_by_parts(model, elements_, *home_, firsts), model);
  EqualElements equal;
  std::shared_ptr<const DistributedCells> cells;
  if (home_->takes_cells()) {
    equal = find_equal_elements(space_, nodes_, elements_, model.expansion);
    cells = home_->keep_cells(firsts, equal.cells);
  }
  std::vector<MatrixOfElements> matrices;
  Matrix stiffness;
  for (const auto wanted : {&Local::stiffness, &Local::mass, &Local::damping}) {
    EqualCellPart& part = matrices.emplace_back(MatrixOfElements{wanted, {cells, {}}}).cells;
    for (const std::vector<int>& one : equal.classes) {
      Matrix& local = part.local.emplace_back();
      ElementSum::form(*elements_[static_cast<std::size_t>(one.front())], wanted, local, stiffness);
      if (local.isZero(0)) local.resize(0, 0);
    }
  }
  std::vector<std::shared_ptr<const DistributedMatrix>> kept =
      home_->keep(firsts, {space_, nodes_, elements_, equal.among, model.expansion}, matrices);
  auto made = std::make_shared<DistributedMatrices>();
  made->cells = std::move(cells);
  made->stiffness = std::move(kept[0]), made->mass = std::move(kept[1]), made->damping = std::move(kept[2]);
  if (made->damping->diagonal().isZero(0)) made->damping.reset();
  model.distributed = std::move(made);
}

void ModelBuilder::make_drives(Model& model, const Matrix& motion_shapes) const {
  const Index unknowns = model.full_unknowns();
  const ElementSum mass = sum(&Local::mass);
  const auto one = std::make_shared<const One>();
  const auto add = [&](std::string name, const Vector& pattern, std::shared_ptr<const TimeFunction> function, bool dead) {
    const bool constant = function->is_one();
    model.time_loads.push_back({std::move(name), model.expansion * pattern, std::move(function), TimeLoad::Order::value, dead, constant});
    SparseVector& kept = model.assembly.loads.emplace_back(unknowns);  // gravity acts on one of six unknowns of a node of solids
    kept.reserve((pattern.array() != 0).count());
    for (Index i = 0; i < unknowns; ++i)
      if (pattern[i] != 0) kept.insertBack(i) = pattern[i];
  };
  if (!gravity_.isZero()) add("gravity", times_translation(mass, space_, gravity_, unknowns), one, true);
  for (std::size_t k = 0; k < interfaces_.size(); ++k)
    if (std::ranges::any_of(interfaces_[k].points, [](const JointPoint& point) { return point.water != 0; }))
      add("water pressure in " + interfaces_[k].name, water_load(model, k), one, true);
  for (const Load& load : loads_) {
    Vector pattern = Vector::Zero(unknowns);
    for (const auto& [unknown, value] : load.pattern) pattern[unknown] += value;
    add(load.name, pattern, load.function ? load.function : one, load.dead);
  }
  for (const GroundAcceleration& ground : grounds_)
    add(ground.name, times_translation(mass, space_, -ground.direction, unknowns), ground.function, false);
  for (const TableOfLoads& table : tables_) {
    Sparse pattern(unknowns, table.functions);
    pattern.setFromTriplets(table.pattern.begin(), table.pattern.end());
    model.time_load_tables.push_back({table.name, model.expansion * pattern, table.values});
    model.assembly.time_load_tables.push_back(std::move(pattern));
  }
  make_motions(model, motion_shapes);
}

/// The forces -T^T A shape of prescribed motions: of stiffness, damping and mass.
void ModelBuilder::make_motions(Model& model, const Matrix& shapes) const {
  if (shapes.cols() == 0) return;
  const Matrix elastic = sum(&Local::stiffness).times(shapes), inertial = sum(&Local::mass).times(shapes);
  const Matrix viscous = sum(&Local::damping).times(shapes) + damping_.alpha * inertial + damping_.beta * elastic;
  for (Index k = 0; k < shapes.cols(); ++k) {
    const Motion& motion = motions_[k];
    const Vector shape = shapes.col(k);
    model.motions.push_back({motion.name, shape, model.assembly.b * shape, motion.function});
    const std::pair<const Matrix*, TimeLoad::Order> parts[] = {
        {&elastic, TimeLoad::Order::value}, {&viscous, TimeLoad::Order::rate}, {&inertial, TimeLoad::Order::acceleration}};
    for (const auto& [force_of, order] : parts) {
      Vector force = -(model.expansion * force_of->col(k));
      if (force.isZero(0)) continue;
      model.time_loads.push_back({motion.name, std::move(force), motion.function, order, false, false, true});
      model.assembly.loads.emplace_back();
    }
  }
}

/// The columns of T that anything resists; a load on another one is refused.
std::vector<int> ModelBuilder::resisted(const Model& model) const {
  std::vector<char> mask(static_cast<std::size_t>(model.free()), 0);
  for (Matrix* Local::*wanted : {&Local::stiffness, &Local::mass, &Local::damping}) {
    const Vector diagonal = sum(wanted).size_of_diagonal(model.expansion);
    for (Index i = 0; i < diagonal.size(); ++i)
      if (diagonal[i] != 0) mask[i] = 1;
  }
  const Sparse b = model.assembly.b * model.reduction();
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
        if (value != 0 && model.expansion.coeff(i, unknown) != 0)
          throw InputError(load.where, load.name, "a load on something that resists",
                           fmt::format("a load on {}, which nothing holds", name_of(unknown)));
  }
  return columns;
}

Model ModelBuilder::finish() {
  Model model;
  std::unordered_set<std::string>().swap(node_names_);  // of a large mesh as large as its nodes
  model.space = space_;
  Matrix motion_shapes;
  model.assembly.gravity = gravity_;
  eliminate(model, motion_shapes);
  if (!keeps_tangents_) drop_dead_tangents(model, motion_shapes);
  place_interfaces(model);

  {
    const std::vector<int> columns = resisted(model);
    if (static_cast<int>(columns.size()) < model.free()) chosen_rows(model.expansion, columns).swap(model.expansion);
    std::vector<int> kept(columns.size());
    for (std::size_t c = 0; c < columns.size(); ++c) kept[c] = model.kept[columns[c]];
    kept.swap(model.kept);
  }
  assemble(model);
  Index first = 0;
  const Sparse b = model.assembly.b * model.reduction();
  const SparseRows b_rows = b;
  for (Interface& face : model.interfaces) {
    face.b = b_rows.middleRows(first, face.rows());
    first += face.rows();
  }
  make_drives(model, motion_shapes);
  if (!damping_.modal.empty()) {
    model.assembly.modal_damping = modal_damping(model, damping_.modal, damping_.modal_count, {});
    model.damping += model.assembly.modal_damping;
  }
  model.grounds = grounds_;
  model.nodes = std::move(nodes_);
  model.second_names = std::move(second_names_);
  model.elements = std::move(elements_);
  return model;
}

}  // namespace uplift
