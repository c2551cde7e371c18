#include "uplift/motion/formats/column_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/base/text.h"

namespace uplift {
namespace {

constexpr int most_head_lines = 100;

/// The text after a key and "=", ":", "of", "is" or "are" in a comment.
std::string_view value_after(std::string_view line, std::string_view key) {
  const std::string capital = upper(line);
  for (std::size_t at = find_word(capital, key); at != capital.npos; at = find_word(capital, key, at + 1)) {
    const std::size_t next = capital.find_first_not_of(" \t", at + key.size());
    if (next == capital.npos) return {};
    for (const std::string_view link : {"=", ":", "OF ", "IS ", "ARE "})
      if (std::string_view(capital).substr(next).starts_with(link)) {
        const std::string_view value = line.substr(next + link.size());
        return trim(value.substr(0, value.find_first_of(";,")));
      }
  }
  return {};
}

/// "1559 points at equal spacing of 0.02 sec", "step = 0.02 s; unit = g".
void read_comment(std::string_view line, int number, Columns& columns) {
  for (const std::string_view key : {"STEP", "DT", "SPACING", "INTERVAL", "INTERVALS"}) {
    const std::string_view value = value_after(line, key);
    const LeadingNumber step = leading_number(value);
    const std::string unit = upper(trim(value.substr(step.length)));
    const bool seconds = unit.empty() || unit == "S" || unit == "SEC" || unit == "SECONDS";
    if (!columns.step && step.length > 0 && !step.out_of_range && seconds) columns.step = {step.value, number};
  }
  for (const std::string_view key : {"UNIT", "UNITS"}) {
    const std::string_view value = value_after(line, key);
    if (!columns.unit.empty() || value.empty() || !motion_unit(value)) continue;
    columns.unit = value;
    columns.unit_line = number;
  }
  const std::string capital = upper(line);
  const std::string_view before = trim(std::string_view(capital).substr(0, std::min(find_word(capital, "POINTS"), capital.size())));
  if (columns.count || before.size() == capital.size() || before.empty()) return;
  if (const std::optional<double> count = whole_number(before.substr(before.find_last_of(" \t#%!/;,") + 1)))
    columns.count = {*count, number};
}

char separator_of(std::string_view line) {
  for (const char c : {';', '\t', ','})
    if (line.find(c) != line.npos) return c;
  return ' ';
}

std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  const std::string_view ends = separator == ' ' ? std::string_view(" \t\v\f") : std::string_view(&separator, 1);
  while (true) {
    const std::size_t end = line.find_first_of(ends);
    const std::string_view cell = trim(line.substr(0, end));
    if (separator != ' ' || !cell.empty()) cells.push_back(cell);
    if (end == line.npos) return cells;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> number_in(const Columns& columns, std::string_view cell) {
  if (!columns.decimal_comma) return whole_number(cell);
  std::string pointed(cell);
  std::ranges::replace(pointed, ',', '.');
  return whole_number(pointed);
}

bool is_missing(std::string_view cell) {
  if (cell.empty()) return true;
  const std::string word = upper(cell.front() == '-' || cell.front() == '+' ? cell.substr(1) : cell);
  if (word.find_first_not_of('*') == word.npos) return !word.empty();
  return word == "NAN" || word == "INF" || word == "INFINITY" || word == "NULL" || word == "NA" || word == "N/A";
}

/// Whether a line is a row of numbers, and then how its cells are separated.
bool is_row(std::string_view line, Columns& columns) {
  columns.separator = separator_of(line);
  columns.decimal_comma = columns.separator == ';' && line.find(',') != line.npos;
  const std::vector<std::string_view> cells = cells_of(columns, line);
  columns.width = cells.size();
  const auto number = [&](std::string_view cell) { return number_in(columns, cell).has_value(); };
  return std::ranges::any_of(cells, number) &&
         std::ranges::all_of(cells, [&](std::string_view cell) { return number(cell) || is_missing(cell); });
}

/// "acc NS [cm/s2]" or "acc NS (cm/s2)".
Columns::Head head_of(std::string_view cell) {
  if (cell.size() >= 2 && (cell.front() == '"' || cell.front() == '\'') && cell.back() == cell.front())
    cell = trim(cell.substr(1, cell.size() - 2));
  const std::size_t open = cell.find_last_of("[(");
  if (open == cell.npos || open == 0 || (cell.back() != ']' && cell.back() != ')')) return {std::string(cell), ""};
  return {std::string(trim(cell.substr(0, open))), std::string(trim(cell.substr(open + 1, cell.size() - open - 2)))};
}

/// Names of the columns from the line before the rows, when it has as many.
void read_heads(const RecordText& text, int line, Columns& columns) {
  std::vector<std::string> cells;
  for (const std::string_view cell : split(trim(text.line(line)), separator_of(text.line(line)))) {
    const bool unit = separator_of(text.line(line)) == ' ' && !cells.empty() && (cell.front() == '[' || cell.front() == '(');
    if (unit)
      cells.back() += " " + std::string(cell);
    else
      cells.emplace_back(cell);
  }
  if (columns.width == 1 && cells.size() > 1) cells = {std::string(trim(text.line(line)))};
  if (cells.size() != columns.width) return;
  columns.head_line = line;
  for (const std::string& cell : cells) columns.heads.push_back(head_of(cell));
}

/// 0.005 where the division gave 0.0049999999999999996.
double rounded(double step) {
  const double short_step = leading_number(fmt::format("{:.10g}", step)).value;
  return std::abs(short_step - step) <= 1e-9 * step ? short_step : step;
}

}  // namespace

bool is_comment(std::string_view line) {
  line = trim(line);
  return !line.empty() && (line.front() == '#' || line.front() == '%' || line.front() == '!' || line.starts_with("//"));
}

std::vector<std::string_view> cells_of(const Columns& columns, std::string_view line) {
  std::vector<std::string_view> cells = split(trim(line), columns.separator);
  while (cells.size() > std::max<std::size_t>(columns.width, 1) && cells.back().empty()) cells.pop_back();
  return cells;
}

Columns columns_of(const RecordText& text) {
  Columns columns;
  int before = 0, heads = 0;
  for (int i = 1; i <= text.count() && heads <= most_head_lines; ++i) {
    const std::string_view line = trim(text.line(i));
    if (line.empty()) continue;
    if (is_comment(line)) {
      read_comment(line, i, columns);
      continue;
    }
    columns.width = 0;
    if (is_row(line, columns)) {
      columns.first_row = i;
      if (before > 0) read_heads(text, before, columns);
      return columns;
    }
    // digits and signs that are no numbers are a row gone wrong, not a title
    if (line.find_first_not_of("0123456789+-.eEdD \t,;") == line.npos)
      throw InputError(text.where(i), "", "a row of numbers", in_quotes(line));
    before = i;
    ++heads;
  }
  std::vector<std::string> names;
  for (const PartInfo* format : record_formats()) names.emplace_back(format->name);
  throw InputError(text.where(), "", "a record of ground motion (" + listed(names) + ")",
                   fmt::format("no row of numbers within the first {} lines of text", std::min(heads, most_head_lines)));
}

Cell number_of(const RecordText& text, const Columns& columns, int line, std::string_view cell) {
  if (const std::optional<double> number = number_in(columns, cell)) return {*number, false};
  if (is_missing(cell) || leading_number(cell).out_of_range) return {0, true};
  throw InputError(text.where(line), "", "a number", in_quotes(cell));
}

TimeSteps equal_steps(const RecordText& text, const std::vector<double>& times, const std::vector<int>& lines,
                      const std::optional<Stated>& stated) {
  std::vector<double> differences;
  for (std::size_t i = 1; i < times.size(); ++i) {
    differences.push_back(times[i] - times[i - 1]);
    if (!(differences.back() > 0) || !std::isfinite(differences.back()))
      throw InputError(text.where(lines[i]), "", "times in ascending order", fmt::format("{:g} s after {:g} s", times[i], times[i - 1]));
  }
  std::vector<double> sorted = differences;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  const double usual = *middle;
  TimeSteps steps{usual, {0}};
  for (std::size_t i = 1; i < times.size(); ++i) {
    // Times are printed with few digits: a third of a step is allowed. One row may be missing between two.
    const double count = std::round(differences[i - 1] / usual);
    if (count < 1 || count > 2 || std::abs(differences[i - 1] - count * usual) > 0.3 * usual)
      throw InputError(text.where(lines[i]), "", fmt::format("times at equal steps of {:.4g} s", usual),
                       fmt::format("{:g} s after {:g} s", times[i], times[i - 1]));
    steps.indices.push_back(steps.indices.back() + static_cast<std::size_t>(count));
  }
  const double mean = (times.back() - times.front()) / static_cast<double>(steps.indices.back());
  const bool agrees = stated && std::abs(stated->value - mean) * static_cast<double>(steps.indices.back()) <= 0.5 * mean;
  steps.step = agrees ? stated->value : rounded(mean);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double equal = times.front() + steps.step * static_cast<double>(steps.indices[i]);
    if (std::abs(times[i] - equal) > 0.6 * steps.step)
      throw InputError(text.where(lines[i]), "", fmt::format("times at equal steps of {:.4g} s ({:g} s here)", steps.step, equal),
                       fmt::format("{:g} s", times[i]));
  }
  return steps;
}

}  // namespace uplift
