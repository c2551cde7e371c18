#include "uplift/model/eliminate.h"

#include <cmath>

namespace uplift {

namespace {

constexpr double negligible = 1e-11;  // of the largest scaled coefficient of a row: cancelled but for round-off

void add_scaled(std::map<int, double>& to, const std::map<int, double>& from, double factor) {
  for (const auto& [index, value] : from) to[index] += factor * value;
}

}  // namespace

Elimination::Elimination(std::vector<double> scale, int motions) : scale_(std::move(scale)), motions_(motions) {}

Elimination::Row Elimination::substitute(const Row& row) const {
  Row result{{}, row.motions};
  double largest = 0;
  for (const auto& [unknown, value] : row.unknowns) {
    largest = std::max(largest, std::abs(value) * scale_[unknown]);
    const auto expression = expression_.find(unknown);
    if (expression == expression_.end()) {
      result.unknowns[unknown] += value;
    } else {
      add_scaled(result.unknowns, expression->second.unknowns, value);
      add_scaled(result.motions, expression->second.motions, -value);
    }
  }
  for (const auto& [motion, value] : row.motions) largest = std::max(largest, std::abs(value));
  std::erase_if(result.unknowns, [&](const auto& entry) { return std::abs(entry.second) * scale_[entry.first] <= negligible * largest; });
  std::erase_if(result.motions, [&](const auto& entry) { return std::abs(entry.second) <= negligible * largest; });
  return result;
}

int Elimination::choose_pivot(const Row& row, int preferred) const {
  double largest = 0;
  for (const auto& [unknown, value] : row.unknowns) largest = std::max(largest, std::abs(value) * scale_[unknown]);
  const auto wanted = row.unknowns.find(preferred);
  if (wanted != row.unknowns.end() && std::abs(wanted->second) * scale_[preferred] >= 0.1 * largest) return preferred;
  int best = -1;
  std::size_t best_uses = 0;
  for (const auto& [unknown, value] : row.unknowns) {
    if (std::abs(value) * scale_[unknown] < 0.5 * largest) continue;
    const auto used = used_.find(unknown);
    const std::size_t uses = used == used_.end() ? 0 : used->second.size();
    if (best < 0 || uses <= best_uses) {  // of equals the last: the first node of a chain stays
      best = unknown;
      best_uses = uses;
    }
  }
  return best;
}

Elimination::Result Elimination::add(const Row& given, int preferred) {
  Row row = substitute(given);
  if (row.unknowns.empty()) return row.motions.empty() ? Result::redundant : Result::contradictory;
  const int pivot = choose_pivot(row, preferred);
  const double divisor = row.unknowns[pivot];
  row.unknowns.erase(pivot);
  Row expression;  // x_pivot = -(other unknowns)/divisor + motions/divisor
  add_scaled(expression.unknowns, row.unknowns, -1 / divisor);
  add_scaled(expression.motions, row.motions, 1 / divisor);
  for (const int user : used_[pivot]) {
    Row& old = expression_[user];
    const double factor = old.unknowns[pivot];
    old.unknowns.erase(pivot);
    add_scaled(old.unknowns, expression.unknowns, factor);
    add_scaled(old.motions, expression.motions, factor);
    for (const auto& [unknown, value] : expression.unknowns) used_[unknown].insert(user);
  }
  used_.erase(pivot);
  for (const auto& [unknown, value] : expression.unknowns) used_[unknown].insert(pivot);
  expression_[pivot] = std::move(expression);
  return Result::independent;
}

std::vector<int> Elimination::kept() const {
  std::vector<int> kept;
  for (int i = 0; i < static_cast<int>(scale_.size()); ++i)
    if (!expression_.contains(i)) kept.push_back(i);
  return kept;
}

Sparse Elimination::reduction() const {
  const std::vector<int> columns = kept();
  std::vector<Triplet> entries;
  std::vector<int> column_of(scale_.size(), -1);
  for (int c = 0; c < static_cast<int>(columns.size()); ++c) {
    column_of[columns[c]] = c;
    entries.emplace_back(columns[c], c, 1.0);
  }
  for (const auto& [unknown, expression] : expression_)
    for (const auto& [other, value] : expression.unknowns)
      if (std::abs(value) * scale_[other] > negligible * scale_[unknown]) entries.emplace_back(unknown, column_of[other], value);
  Sparse reduction(static_cast<Index>(scale_.size()), static_cast<Index>(columns.size()));
  reduction.setFromTriplets(entries.begin(), entries.end());
  return reduction;
}

Matrix Elimination::motions() const {
  Matrix shapes = Matrix::Zero(static_cast<Index>(scale_.size()), motions_);
  for (const auto& [unknown, expression] : expression_)
    for (const auto& [motion, value] : expression.motions) shapes(unknown, motion) = value;
  return shapes;
}

}  // namespace uplift
