#include "uplift/io/histories.h"

#include <cmath>

#include "uplift/io/numbers.h"

namespace uplift {

bool finite_row(const RunResult& result, std::size_t row) {
  for (const std::vector<double>& column : result.table)
    if (!std::isfinite(column[row])) return false;
  return true;
}

std::string histories_csv(const RunResult& result) {
  std::string text = "time [s]";
  for (const Request& column : result.columns)
    text += "," + column.name + " [" + column.unit + (result.step_means && is_step_mean(column.kind) ? "; mean of the step]" : "]");
  text += '\n';
  const std::size_t rows = result.table.empty() ? 0 : result.table[0].size();
  std::vector<char> line(result.table.size() * (number_room + 1));
  text.reserve(text.size() + rows * result.table.size() * 13);
  for (std::size_t row = 0; row < rows; ++row) {
    if (!finite_row(result, row)) continue;
    char* at = line.data();
    for (const std::vector<double>& column : result.table) {
      at = write_number(at, column[row]);
      *at++ = ',';
    }
    at[-1] = '\n';
    text.append(line.data(), at);
  }
  return text;
}

}  // namespace uplift
