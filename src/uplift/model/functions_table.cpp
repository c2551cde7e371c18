// Functions of time given by points, with straight lines between them: numbers in the case file, or columns of a CSV file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/base/units.h"
#include "uplift/model/function_jumps.h"

namespace uplift {

namespace {

/// Piecewise linear; the rate is that of the present piece (right-continuous), at the last
/// point that of the piece before it. The acceleration of a straight line is zero and its slope
/// jumps at the points: every jump is spread over the two pieces beside its point, highest there and zero at the neighbours, so that the
/// integral over all time is the jump. On equal steps this is the second central difference, straight in between (error of order 2 for a
/// sampled motion). The first and the last point have none here (bends_of). A time that is outside by no more than round-off (a sum of many
/// steps) belongs to the first or the last point.
class Table : public TimeFunction {
 public:
  Table(std::vector<double> times, std::vector<double> values, bool hold)
      : times_(std::move(times)), values_(std::move(values)), hold_(hold) {}

  double value(double t) const override {
    if (t <= times_.front()) return hold_ || t > times_.front() - round_off() ? values_.front() : 0;
    if (t >= times_.back()) return hold_ || t < times_.back() + round_off() ? values_.back() : 0;
    const std::size_t i = piece(t);
    return values_[i] + slope(i) * (t - times_[i]);
  }
  double rate(double t) const override { return t < times_.front() || t > times_.back() + round_off() ? 0 : slope(piece(t)); }
  double acceleration(double t) const override {
    if (t <= times_.front() || t >= times_.back()) return 0;
    const std::size_t i = piece(t);
    const double share = (t - times_[i]) / (times_[i + 1] - times_[i]);
    return (1 - share) * curvature(i) + share * curvature(i + 1);
  }

  std::vector<FunctionJump> jumps() const {
    if (hold_) return {};
    std::vector<FunctionJump> found;
    if (values_.front() != 0) found.push_back({times_.front(), 0, values_.front()});
    if (values_.back() != 0) found.push_back({times_.back(), values_.back(), 0});
    return found;
  }
  std::vector<FunctionBend> bends() const { return {{times_.front(), slope(0), 0}, {times_.back(), -slope(times_.size() - 2), 0}}; }

 private:
  double round_off() const { return 1e-9 * std::max(std::abs(times_.back()), times_.back() - times_.front()); }  // s
  /// Left end of the piece that holds t.
  std::size_t piece(double t) const {
    const auto next = std::upper_bound(times_.begin(), times_.end(), t);
    const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - times_.begin() - 1, 0));
    return std::min(i, times_.size() - 2);
  }
  double slope(std::size_t i) const { return (values_[i + 1] - values_[i]) / (times_[i + 1] - times_[i]); }
  /// Jump of the slope at a point over half of the pieces beside it.
  double curvature(std::size_t i) const {
    return i == 0 || i + 1 == times_.size() ? 0 : 2 * (slope(i) - slope(i - 1)) / (times_[i + 1] - times_[i - 1]);
  }
  std::vector<double> times_, values_;
  bool hold_;
};

Field outside(const char* standard) {
  return choice("outside", {"hold", "zero"}, "before the first and after the last point: the value there, or zero").standard(standard);
}

std::unique_ptr<const TimeFunction> make_table(const Values& v) {
  const std::vector<double>&times = v.numbers("times"), &values = v.numbers("values");
  if (times.size() < 2) throw InputError(v.where("times"), v.path("times"), "at least two times", fmt::format("{}", times.size()));
  if (values.size() != times.size())
    throw InputError(v.where("values"), v.path("values"), fmt::format("as many values as times ({})", times.size()),
                     fmt::format("{}", values.size()));
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1]))
      throw InputError(v.where("times"), v.path("times"), "times in ascending order",
                       fmt::format("{:g} s after {:g} s", times[i], times[i - 1]));
  return std::make_unique<Table>(times, values, v.text("outside") == "hold");
}

// ---- CSV ----

/// Between semicolons commas are decimal commas.
std::vector<std::string_view> cells_of(std::string_view line) {
  const bool semicolons = line.find(';') != std::string_view::npos, separated = semicolons || line.find(',') != std::string_view::npos;
  const std::string_view separators = semicolons ? ";" : separated ? "," : " \t";
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t end = line.find_first_of(separators);
    const std::string_view cell = trim(line.substr(0, end));
    if (separated || !cell.empty()) cells.push_back(cell);
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> number_of(std::string_view cell) {
  std::string pointed(cell);
  std::ranges::replace(pointed, ',', '.');
  const LeadingNumber number = leading_number(pointed);
  if (number.length == 0 || number.length != cell.size() || number.out_of_range) return std::nullopt;
  return number.value;
}

/// Factor from the unit of a column to SI, whatever its dimension is.
double unit_factor(const Values& v, std::string_view key, const std::vector<std::string>& wanted) {
  if (!v.has(key)) return 1;
  std::string nearest;
  for (const std::string& si : wanted) {
    const Quantity one = parse_quantity("1 " + v.text(key), si);
    if (one.ok) return one.value;
    if (nearest.empty()) nearest = one.nearest;
  }
  throw InputError(v.where(key), v.path(key), "a unit that converts to " + listed(wanted), in_quotes(v.text(key)), nearest);
}

/// Which column a key means: a number from 1, or a word of the head line.
std::size_t column_of(const Values& v, std::string_view key, const std::vector<std::string>& head, const Where& head_place) {
  const std::string& word = v.text(key);
  if (const auto found = std::ranges::find(head, word); found != head.end()) return static_cast<std::size_t>(found - head.begin());
  const std::optional<double> number = number_of(word);
  if (number && *number >= 1 && *number == std::floor(*number) && *number <= 1000) return static_cast<std::size_t>(*number) - 1;
  throw InputError(v.where(key), v.path(key),
                   head.empty() ? "the number of a column, from 1 (the file has no head line)"
                                : fmt::format("a column of {}:{}: {}", head_place.file, head_place.line, listed(head)),
                   in_quotes(word), nearest_name(word, head));
}

std::unique_ptr<const TimeFunction> make_csv(const Values& v) {
  const std::filesystem::path path = path_beside(v.where("file"), v.text("file"));
  require_file(path, v.where("file"), v.path("file"));

  const double time_factor = unit_factor(v, "time_unit", {"s"});
  const double factor = v.number("scale") * unit_factor(v, "unit", {"1", "m/s2", "m/s", "m", "N", "N m", "Pa", "rad"});
  std::vector<double> times, values;
  std::vector<std::string> head;
  Where place{path.string(), 0};
  std::size_t time_column = 0, value_column = 0;
  bool first = true;
  const std::string content = read_file(path);
  for (std::size_t begin = content.starts_with("\xEF\xBB\xBF") ? 3 : 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    const std::string_view text = trim(std::string_view(content).substr(begin, end - begin));
    begin = end + 1;
    ++place.line;
    if (text.empty() || text.front() == '#') continue;
    const std::vector<std::string_view> cells = cells_of(text);
    if (first) {
      const bool is_head = std::ranges::any_of(cells, [](std::string_view cell) { return !number_of(cell); });
      if (is_head) head.assign(cells.begin(), cells.end());
      time_column = column_of(v, "time_column", head, place);
      value_column = column_of(v, "value_column", head, place);
      first = false;
      if (is_head) continue;
    }
    const auto cell = [&](std::size_t column) {
      if (column >= cells.size())
        throw InputError(place, "", fmt::format("at least {} columns", column + 1), fmt::format("{}", cells.size()));
      const std::optional<double> number = number_of(cells[column]);
      if (!number) throw InputError(place, "", fmt::format("a number in column {}", column + 1), in_quotes(cells[column]));
      return *number;
    };
    times.push_back(time_factor * cell(time_column));
    values.push_back(factor * cell(value_column));
    if (times.size() > 1 && !(times.back() > times[times.size() - 2]))
      throw InputError(place, "", "times in ascending order", fmt::format("{:g} s after {:g} s", times.back(), times[times.size() - 2]));
  }
  if (times.size() < 2) throw InputError(place, "", "at least two rows of numbers", fmt::format("{}", times.size()));
  return std::make_unique<Table>(std::move(times), std::move(values), v.text("outside") == "hold");
}

}  // namespace

std::vector<FunctionBend> bends_of_table(const TimeFunction& function) {
  const auto* table = dynamic_cast<const Table*>(&function);
  return table != nullptr ? table->bends() : std::vector<FunctionBend>();
}

std::vector<FunctionJump> jumps_of(const TimeFunction& function) {
  const auto* table = dynamic_cast<const Table*>(&function);
  return table != nullptr ? table->jumps() : std::vector<FunctionJump>();
}

const Entry<TimeFunction>& entry_function_table() {
  static const Entry<TimeFunction> entry{
      {.name = "table",
       .summary = "points given in the case file, straight lines between them",
       .equations = "f(t) = linear interpolation; as a prescribed motion its velocity jumps at the points, and each jump acts as an "
                    "acceleration spread over both pieces beside its point",
       .source = "",
       .params = {numbers("times", "s", "times, ascending"), numbers("values", "1", "values at these times"), outside("hold")}},
      make_table};
  return entry;
}

const Entry<TimeFunction>& entry_function_csv() {
  static const Entry<TimeFunction> entry{
      {.name = "csv",
       .summary = "two columns of a text file (comma, semicolon or blanks between them), straight lines between the points",
       .equations = "f(t) = scale * value; lines that begin with # are comments, the first line may name the columns; between semicolons, "
                    "commas are decimal commas",
       .source = "",
       .params = {text("file", "path, relative to the case file"), text("time_column", "name, or number from 1").standard("1"),
                  text("value_column", "name, or number from 1").standard("2"), number("scale", "1", "factor on the values").standard(1.0),
                  text("unit", "unit of the values, converted to SI (\"cm/s2\", \"g_n\", \"kN\"); absent: taken as they are").optional(),
                  text("time_unit", "unit of the times").standard("s"), outside("zero")}},
      make_csv};
  return entry;
}

}  // namespace uplift
