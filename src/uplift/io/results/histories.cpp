#include "uplift/io/results/histories.h"

#include <algorithm>
#include <cmath>

#include "uplift/io/text/numbers.h"
#include "uplift/run/quantities.h"

namespace uplift {

namespace {

using Table = std::vector<std::vector<double>>;

bool finite_row(const Table& table, std::size_t row) {
  return std::ranges::all_of(table, [row](const std::vector<double>& column) { return std::isfinite(column[row]); });
}

/// `step_means`: forces of interfaces and accelerations are means over the step.
std::string head_of(std::string_view first_column, const std::vector<Request>& columns, bool step_means) {
  std::string text(first_column);
  for (const Request& column : columns)
    text += "," + csv_cell(column.name + " [" + column.unit + (step_means && is_step_mean(column.kind) ? "; mean of the step]" : "]"));
  return text + '\n';
}

void add_rows(const Table& table, std::size_t from, std::string& text) {
  const std::size_t rows = table.empty() ? 0 : table[0].size();
  if (from >= rows) return;
  std::vector<char> line(table.size() * (number_room + 1));
  text.reserve(text.size() + (rows - from) * table.size() * 13);
  for (std::size_t row = from; row < rows; ++row) {
    if (!finite_row(table, row)) continue;
    char* at = line.data();
    for (const std::vector<double>& column : table) {
      at = write_number(at, column[row]);
      *at++ = ',';
    }
    at[-1] = '\n';
    text.append(line.data(), at);
  }
}

std::string table_csv(std::string_view first_column, const std::vector<Request>& columns, const Table& table, bool step_means) {
  std::string text = head_of(first_column, columns, step_means);
  add_rows(table, 0, text);
  return text;
}

}  // namespace

bool finite_row(const RunResult& result, std::size_t row) {
  return finite_row(result.table, row);
}

std::string histories_csv(const RunResult& result, std::string_view first_column) {
  return table_csv(first_column, result.columns, result.table, result.step_means);
}

std::string histories_head(const RunResult& result) {
  return head_of(time_column, result.columns, result.step_means);
}

std::string histories_rows(const RunResult& result, std::size_t from) {
  std::string text;
  add_rows(result.table, from, text);
  return text;
}

std::string load_steps_csv(const RunResult& result, const std::vector<Request>& columns) {
  return table_csv(load_factor_column, columns, result.load_steps, false);
}

}  // namespace uplift
