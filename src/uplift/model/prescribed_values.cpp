#include "uplift/model/prescribed_values.h"

#include <fmt/format.h>

#include <numeric>
#include <unordered_map>
#include <unordered_set>

#include "uplift/math/dense.h"

namespace uplift {

namespace {

/// Prescribed values that share free unknowns, and these unknowns.
struct Coupled {
  std::vector<Index> rows, columns;
};

/// The blocks into which the rows fall apart: one for each rigid body or chain of inextensible beams, most of them a single unknown.
std::vector<Coupled> coupled_rows(const Model& model, const std::vector<PrescribedValue>& prescribed) {
  std::vector<Index> parent(static_cast<std::size_t>(model.free()));
  std::iota(parent.begin(), parent.end(), Index{0});
  const auto root = [&](Index column) {
    while (parent[static_cast<std::size_t>(column)] != column) {
      Index& above = parent[static_cast<std::size_t>(column)];
      column = above = parent[static_cast<std::size_t>(above)];
    }
    return column;
  };
  const auto columns = [&](std::size_t row) { return Sparse::InnerIterator(model.expansion, prescribed[row].unknown); };
  for (std::size_t row = 0; row < prescribed.size(); ++row)
    for (auto entry = columns(row); entry; ++entry) parent[static_cast<std::size_t>(root(entry.row()))] = root(columns(row).row());
  std::vector<Coupled> blocks;
  std::unordered_map<Index, std::size_t> block_of;  // of the root of each block; -1: of unknowns that nothing can move
  std::unordered_set<Index> met;
  for (std::size_t row = 0; row < prescribed.size(); ++row) {
    const auto first = columns(row);
    const auto [found, added] = block_of.emplace(first ? root(first.row()) : -1, blocks.size());
    if (added) blocks.emplace_back();
    Coupled& block = blocks[found->second];
    block.rows.push_back(static_cast<Index>(row));
    for (auto entry = columns(row); entry; ++entry)
      if (met.insert(entry.row()).second) block.columns.push_back(entry.row());
  }
  return blocks;
}

[[noreturn]] void refuse_value(const Model& model, const PrescribedValue& asked, double possible) {
  throw InputError(asked.where, "initial", "values that supports, prescribed motions, rigid bodies and inextensible beams allow",
                   fmt::format("value = {:g} at {}.{}, where only {:g} is possible together with the other values", asked.value,
                               model.nodes[static_cast<std::size_t>(model.space.node_of(asked.unknown))].name,
                               to_string(model.space.dof(model.space.index_of(asked.unknown))), possible));
}

}  // namespace

Vector free_values(const Model& model, const std::vector<PrescribedValue>& prescribed) {
  Vector q = Vector::Zero(model.free());
  double size = 0;
  for (const PrescribedValue& each : prescribed) size = std::max(size, std::abs(each.value));
  std::vector<Index> place(static_cast<std::size_t>(model.free()), 0);  // of a column in its block
  for (const Coupled& block : coupled_rows(model, prescribed)) {
    const auto rows = static_cast<Index>(block.rows.size()), columns = static_cast<Index>(block.columns.size());
    Matrix matrix = Matrix::Zero(rows, columns);
    Vector values(rows);
    for (Index k = 0; k < columns; ++k) place[static_cast<std::size_t>(block.columns[static_cast<std::size_t>(k)])] = k;
    for (Index i = 0; i < rows; ++i) {
      const PrescribedValue& each = prescribed[static_cast<std::size_t>(block.rows[static_cast<std::size_t>(i)])];
      values[i] = each.value;
      for (Sparse::InnerIterator entry(model.expansion, each.unknown); entry; ++entry)
        matrix(i, place[static_cast<std::size_t>(entry.row())]) = entry.value();
    }
    const Vector solution = columns > 0 ? Vector(CompleteQr(matrix).solve(values)) : Vector();
    const Vector error = columns > 0 ? Vector(matrix * solution - values) : Vector(-values);
    Index worst = 0;
    if (error.cwiseAbs().maxCoeff(&worst) > 1e-9 * size)
      refuse_value(model, prescribed[static_cast<std::size_t>(block.rows[static_cast<std::size_t>(worst)])], values[worst] + error[worst]);
    for (Index k = 0; k < columns; ++k) q[block.columns[static_cast<std::size_t>(k)]] = solution[k];
  }
  return q;
}

Vector free_values(const Model& model, const std::vector<std::pair<int, double>>& prescribed, const Where& where) {
  std::vector<PrescribedValue> values;
  for (const auto& [unknown, value] : prescribed) values.push_back({unknown, value, where});
  return free_values(model, values);
}

}  // namespace uplift
