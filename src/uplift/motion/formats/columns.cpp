#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/base/text.h"
#include "uplift/motion/formats/column_reader.h"

// Plain tables: a column of times and columns of values, one column of values, or values at equal steps in rows of any length.
namespace uplift {
namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);

/// Factor from the unit of a column of times to s; 0 when the head is not that of times.
double time_factor(const Columns::Head& head) {
  const std::string name = upper(head.name), unit = upper(head.unit);
  const bool named = name == "T" || name.starts_with("TIME") || name == "SEC" || name == "SECONDS" || name == "S";
  if (unit == "MS" && named) return 1e-3;
  if (unit == "S" || unit == "SEC" || unit == "SECONDS") return 1;
  return named && unit.empty() ? 1 : 0;
}

/// Whether the first cells of the first rows are times: ascending by equal steps, by those that the file or the user states. Times before
/// zero, of a record that begins ahead of its trigger, could be values of a motion: there no step may differ, and there are five at least.
bool begins_with_times(const RecordText& text, const Columns& columns, std::optional<double> stated) {
  std::vector<double> first;
  for (int i = columns.first_row; i <= text.count() && first.size() < 20; ++i) {
    if (trim(text.line(i)).empty() || is_comment(text.line(i))) continue;
    const std::vector<std::string_view> cells = cells_of(columns, text.line(i));
    if (cells.size() != columns.width) break;
    std::string cell(cells.front());
    if (columns.decimal_comma) std::ranges::replace(cell, ',', '.');
    const std::optional<double> time = whole_number(cell);
    if (!time) return false;
    first.push_back(*time);
  }
  const bool before_zero = !first.empty() && first.front() < 0;
  if (first.size() < (before_zero ? 6 : 2)) return false;
  if (stated && std::abs(first[1] - first[0] - *stated) > 0.3 * *stated) return false;
  int even = 0;
  for (std::size_t i = 1; i < first.size(); ++i) {
    if (!(first[i] > first[i - 1])) return false;
    even += std::abs(first[i] - first[i - 1] - (first[1] - first[0])) < 0.3 * (first[1] - first[0]);
  }
  const int steps = static_cast<int>(first.size()) - 1;
  return before_zero ? even == steps : 2 * even >= steps;  // a gap among them is for equal_steps to tell
}

struct Layout {
  std::size_t time = none;
  double factor = 1;                // of the times
  std::vector<std::size_t> values;  // empty: every number of every row, one after the other
};

std::size_t column_asked(const RecordText& text, const Columns& columns, const std::string& word) {
  std::vector<std::string> names;
  for (const Columns::Head& head : columns.heads) names.push_back(head.name);
  if (const auto found = std::ranges::find(names, word); found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const std::optional<double> number = whole_number(word);
  if (number && *number >= 1 && *number <= static_cast<double>(columns.width) && *number == std::floor(*number))
    return static_cast<std::size_t>(*number) - 1;
  const std::string by_number = fmt::format("a column from 1 to {}", columns.width);
  throw InputError(text.where(columns.head_line), "column", names.empty() ? by_number : by_number + ", or " + listed(names),
                   in_quotes(word), nearest_name(word, names));
}

Layout layout_of(const RecordText& text, const Columns& columns, const RecordOptions& options) {
  Layout layout;
  const std::optional<double> stated = options.step ? options.step : columns.step ? std::optional(columns.step->value) : std::nullopt;
  for (std::size_t i = 0; i < columns.heads.size() && layout.time == none && columns.width > 1; ++i)
    if (const double factor = time_factor(columns.heads[i]); factor > 0) {
      layout.time = i;
      layout.factor = factor;
    }
  if (layout.time == none && columns.width > 1 && begins_with_times(text, columns, stated)) layout.time = 0;
  if (!options.column.empty()) {
    layout.values = {column_asked(text, columns, options.column)};
    if (layout.values.front() == layout.time)
      throw InputError(text.where(columns.head_line), "column", "a column of values", "that of the times");
    return layout;
  }
  if (options.unit.empty())
    for (std::size_t i = 0; i < columns.heads.size(); ++i)
      if (i != layout.time && motion_unit(columns.heads[i].unit)) layout.values.push_back(i);
  constexpr std::size_t most = 100;
  if (layout.values.size() > most)
    throw InputError(text.where(columns.head_line), "", fmt::format("at most {} columns of motion (say which one with `column`)", most),
                     fmt::format("{}", layout.values.size()));
  if (!layout.values.empty()) return layout;
  if (layout.time != none)
    layout.values = {layout.time == 0 ? std::size_t{1} : 0};
  else if (columns.width == 2 || !columns.heads.empty())
    layout.values = {0};
  if (layout.time == none && columns.width == 2 && columns.heads.empty() && !options.step)
    throw InputError(text.where(columns.first_row), "", "two columns: times at equal steps, and values",
                     in_quotes(trim(text.line(columns.first_row))));
  return layout;
}

struct Rows {
  std::vector<double> times;
  std::vector<int> lines;
  std::vector<Samples> samples;
};

Rows rows_of(const RecordText& text, const Columns& columns, const Layout& layout) {
  Rows rows;
  rows.samples.resize(layout.values.size());
  for (int i = columns.first_row; i <= text.count(); ++i) {
    if (trim(text.line(i)).empty() || is_comment(text.line(i))) continue;
    const std::vector<std::string_view> cells = cells_of(columns, text.line(i));
    if (i == text.cut_line() && cells.size() < columns.width) break;
    if (cells.size() != columns.width)
      throw InputError(text.where(i), "", fmt::format("{} numbers, as in line {}", columns.width, columns.first_row),
                       fmt::format("{}", cells.size()));
    rows.lines.push_back(i);
    if (layout.time != none) {
      const Cell time = number_of(text, columns, i, cells[layout.time]);
      if (time.missing) throw InputError(text.where(i), "", "a time", in_quotes(cells[layout.time]));
      rows.times.push_back(layout.factor * time.number);
    }
    for (std::size_t k = 0; k < layout.values.size(); ++k) {
      const std::string_view word = cells[layout.values[k]];
      const Cell cell = number_of(text, columns, i, word);
      if (cell.missing)
        rows.samples[k].add_missing(std::string(word), i);
      else
        rows.samples[k].add(cell.number, i);
    }
  }
  return rows;
}

/// Without the empty cells at its end (a shorter column of a table), and with a missing point for every row that is not there.
Samples placed(const Samples& column, const Rows& rows, const TimeSteps* steps) {
  std::size_t size = column.values.size(), missing = column.missing.size();
  for (; missing > 0 && column.missing[missing - 1].index + 1 == size && column.missing[missing - 1].found.empty(); --missing) --size;
  Samples out;
  std::size_t next = 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (steps && steps->indices[i] > out.values.size()) out.add_missing("", rows.lines[i]);
    if (next < missing && column.missing[next].index == i)
      out.add_missing(column.missing[next++].found, rows.lines[i]);
    else
      out.add(column.values[i], rows.lines[i]);
  }
  return out;
}

/// The numbers of a row at equal steps, however many.
void add_row(const RecordText& text, const Columns& columns, int line, Samples& samples) {
  if (!columns.decimal_comma) return add_numbers(text, line, samples);
  for (const std::string_view word : cells_of(columns, text.line(line))) {
    const Cell cell = number_of(text, columns, line, word);
    if (!cell.missing)
      samples.add(cell.number, line);
    else if (!word.empty())
      samples.add_missing(std::string(word), line);
  }
}

RecordDraft draft_of(const Columns& columns, std::size_t column) {
  RecordDraft draft;
  if (columns.decimal_comma && columns.separator != ';') draft.notes.emplace_back("its commas were read as decimal commas");
  draft.step = columns.step;
  draft.unit = columns.unit;
  draft.unit_line = columns.unit_line > 0 ? columns.unit_line : columns.head_line;
  if (column >= columns.heads.size()) return draft;
  draft.component = columns.heads[column].name;
  draft.azimuth = azimuth_of(draft.component);
  if (columns.heads[column].unit.empty()) return draft;
  draft.unit = columns.heads[column].unit;
  draft.unit_line = columns.head_line;
  return draft;
}

std::vector<Motion> read_columns(const RecordText& text, const RecordOptions& options) {
  const Columns columns = columns_of(text);
  const Layout layout = layout_of(text, columns, options);
  if (layout.values.empty()) {
    RecordDraft draft = draft_of(columns, none);
    draft.count = columns.count;
    draft.per_row = columns.width;
    if (columns.separator == ';' && columns.width > 1)
      throw InputError(text.where(columns.first_row), "", "a column of times at equal steps",
                       in_quotes(trim(text.line(columns.first_row))));
    for (int i = columns.first_row; i <= text.count(); ++i)
      if (!is_comment(text.line(i))) add_row(text, columns, i, draft.samples);
    return {finished(text, options, std::move(draft))};
  }
  const Rows rows = rows_of(text, columns, layout);
  std::optional<TimeSteps> steps;
  if (rows.times.size() > 1) steps = equal_steps(text, rows.times, rows.lines, columns.step);
  std::vector<Motion> motions;
  for (std::size_t k = 0; k < layout.values.size(); ++k) {
    RecordDraft draft = draft_of(columns, layout.values[k]);
    if (layout.time == none) draft.count = columns.count;
    draft.samples = placed(rows.samples[k], rows, steps ? &*steps : nullptr);
    if (steps) draft.step = {steps->step, columns.first_row};
    if (steps && rows.times.front() != 0)
      draft.notes.push_back(fmt::format("its times begin at {:g} s; they are counted from there", rows.times.front()));
    motions.push_back(finished(text, options, std::move(draft)));
  }
  return motions;
}

bool is_columns(const RecordText&) {
  return true;
}

}  // namespace

const RecordFormat& entry_record_columns() {
  static const RecordFormat entry{
      {.name = "columns",
       .summary = "text or CSV: times and values in columns, one column, or values in rows; with or without heads",
       .equations =
           "commas, semicolons, tabs or blanks between the numbers (without commas: also decimal commas); # % ! // begin comments\n"
           "a head such as \"time [s], acc [cm/s2]\" gives units, so does a line of units below the names, and so does a comment \"# step "
           "= 0.01 s; unit = g\"\n"
           "all columns with a unit of motion are read; without units the first one after the times",
       .source = "",
       .params = {}},
      is_columns,
      read_columns};
  return entry;
}

}  // namespace uplift
