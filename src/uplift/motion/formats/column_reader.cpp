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

/// Cells between separators; a cell in quotes may hold the separator, and loses its quotes.
std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  const std::string_view ends = separator == ' ' ? std::string_view(" \t\v\f") : std::string_view(&separator, 1);
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t\v\f"), quote = begin == line.npos || line[begin] != '"' ? line.npos : begin;
    const std::size_t closing = quote == line.npos ? line.npos : line.find('"', quote + 1);
    const std::size_t end = line.find_first_of(ends, closing == line.npos ? 0 : closing);
    std::string_view cell = trim(line.substr(0, end));
    if (closing != line.npos && cell.size() >= 2 && cell.back() == '"') cell = trim(cell.substr(1, cell.size() - 2));
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

bool reads_as_row(std::string_view line, Columns& columns) {
  const std::vector<std::string_view> cells = cells_of(columns, line);
  columns.width = cells.size();
  const auto number = [&](std::string_view cell) { return number_in(columns, cell).has_value(); };
  return std::ranges::any_of(cells, number) &&
         std::ranges::all_of(cells, [&](std::string_view cell) { return number(cell) || is_missing(cell); });
}

/// Whether a line is a row of numbers, and then how its cells are separated: decimal commas where commas cannot separate.
bool is_row(std::string_view line, Columns& columns) {
  columns.separator = separator_of(line);
  columns.decimal_comma = false;
  columns.width = 0;
  if (reads_as_row(line, columns)) return true;
  if (line.find(',') == line.npos) return false;
  if (columns.separator == ',') columns.separator = ' ';
  columns.decimal_comma = true;
  columns.width = 0;
  return reads_as_row(line, columns);
}

/// "1,5" or "-0,25E-2": two numbers, or one with a decimal comma.
bool may_be_decimal(std::string_view line) {
  const std::size_t comma = line.find(',');
  if (comma == line.npos || comma + 1 == line.size() || line.find_first_not_of("+-0123456789,eEdD") != line.npos) return false;
  const std::string_view whole = line.substr(0, comma);
  return whole.find_first_not_of("+-0123456789") == whole.npos && line[comma + 1] >= '0' && line[comma + 1] <= '9' &&
         line.find(',', comma + 1) == line.npos;
}

/// A whole number is not written "-0", and none begins with a zero: "-0,25", "1,05".
bool is_decimal(std::string_view line) {
  const std::size_t comma = line.find(',');
  const std::string_view whole = line.substr(0, comma), rest = line.substr(comma + 1);
  return whole == "-0" || whole == "+0" || (rest.size() > 1 && rest[0] == '0' && rest[1] >= '0' && rest[1] <= '9');
}

bool are_numbers_in_steps(const std::vector<double>& numbers) {
  for (std::size_t i = 1; i < numbers.size(); ++i)
    if (!(numbers[i] > numbers[i - 1])) return false;
  return numbers.size() > 1;
}

/// A column of numbers with decimal commas looks like two columns of whole numbers: told apart by zeros, or refused.
void tell_one_column_from_two(const RecordText& text, Columns& columns) {
  bool decimal = false;
  std::vector<double> first;
  for (int i = columns.first_row; i <= text.count(); ++i) {
    const std::string_view line = trim(text.line(i));
    if (line.empty() || is_comment(line)) continue;
    if (!may_be_decimal(line) && line.find(',') != line.npos) return;  // has decimal points, or other cells
    if (line.find(',') == line.npos && !whole_number(line)) return;
    decimal = decimal || (line.find(',') != line.npos && is_decimal(line));
    first.push_back(whole_number(line.substr(0, line.find(','))).value_or(0));
  }
  if (!decimal && are_numbers_in_steps(first)) return;
  if (!decimal)
    throw InputError(text.where(columns.first_row), "",
                     "decimal points, or columns that semicolons, tabs or blanks separate (two columns of whole numbers, or one column of "
                     "decimal commas?)",
                     in_quotes(trim(text.line(columns.first_row))));
  columns.separator = ' ';
  columns.decimal_comma = true;
  columns.width = 1;
}

/// The first row may hold no fraction: "0;0", then "0,01;0,12".
void find_decimal_commas(const RecordText& text, Columns& columns) {
  for (int i = columns.first_row; i <= text.count() && !columns.decimal_comma; ++i) {
    const std::string_view line = trim(text.line(i));
    if (line.find(',') == line.npos || is_comment(line)) continue;
    Columns with_commas = columns;
    with_commas.decimal_comma = true;
    const std::vector<std::string_view> cells = cells_of(with_commas, line);
    const bool numbers = std::ranges::all_of(cells, [&](std::string_view cell) {
      return is_missing(cell) || (number_in(with_commas, cell) && (cell.find(',') == cell.npos || cell.find('.') == cell.npos));
    });
    if (!numbers || (columns.width <= 2 && cells.size() != columns.width)) return;
    columns.decimal_comma = true;
  }
}

/// "acc NS [cm/s2]" or "acc NS (cm/s2)".
Columns::Head head_of(std::string_view cell) {
  if (cell.size() >= 2 && (cell.front() == '"' || cell.front() == '\'') && cell.back() == cell.front())
    cell = trim(cell.substr(1, cell.size() - 2));
  const std::size_t open = cell.find_last_of("[(");
  if (open == cell.npos || open == 0 || (cell.back() != ']' && cell.back() != ')')) return {std::string(cell), ""};
  return {std::string(trim(cell.substr(0, open))), std::string(trim(cell.substr(open + 1, cell.size() - open - 2)))};
}

std::vector<std::string> head_cells(std::string_view line, std::size_t width) {
  std::vector<std::string> cells;
  const char separator = separator_of(line);
  const auto in_brackets = [](std::string_view cell) { return cell.front() == '[' || cell.front() == '('; };
  const std::vector<std::string_view> parts = split(trim(line), separator);
  const bool units_alone = separator == ' ' && std::ranges::all_of(parts, in_brackets);
  for (const std::string_view cell : parts) {
    if (separator == ' ' && !units_alone && !cells.empty() && in_brackets(cell))
      cells.back() += " " + std::string(cell);
    else
      cells.emplace_back(cell);
  }
  while (cells.size() > width && cells.back().empty()) cells.pop_back();
  if (width == 1 && cells.size() > 1) cells = {std::string(trim(line))};
  return cells;
}

std::string without_brackets(std::string_view cell) {
  const bool open = !cell.empty() && (cell.front() == '[' || cell.front() == '('),
             closed = open && (cell.back() == ']' || cell.back() == ')');
  return std::string(closed ? trim(cell.substr(1, cell.size() - 2)) : cell);
}

bool is_unit(const std::string& cell) {
  const std::string word = upper(without_brackets(cell));
  return word == "S" || word == "SEC" || word == "SECONDS" || word == "MS" || motion_unit(word).has_value();
}

/// Names of the columns from the line before the rows, when it has as many; a line of units alone stands below that of the names.
void read_heads(const RecordText& text, int line, int before, Columns& columns) {
  const std::vector<std::string> cells = head_cells(text.line(line), columns.width);
  if (cells.size() != columns.width) return;
  columns.head_line = line;
  for (const std::string& cell : cells) columns.heads.push_back(head_of(cell));
  if (before == 0 || !std::ranges::all_of(cells, is_unit)) return;
  const std::vector<std::string> names = head_cells(text.line(before), columns.width);
  if (names.size() != columns.width) return;
  for (std::size_t i = 0; i < names.size(); ++i) columns.heads[i] = {head_of(names[i]).name, without_brackets(cells[i])};
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
  int before = 0, before_that = 0, heads = 0;
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
      if (before > 0) read_heads(text, before, before_that, columns);
      if (columns.separator != ',')
        find_decimal_commas(text, columns);
      else if (columns.width == 2 && columns.heads.empty())
        tell_one_column_from_two(text, columns);
      return columns;
    }
    // digits and signs that are no numbers are a row gone wrong, not a title
    if (line.find_first_not_of("0123456789+-.eEdD \t,;") == line.npos)
      throw InputError(text.where(i), "", "a row of numbers", in_quotes(line));
    before_that = before;
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
