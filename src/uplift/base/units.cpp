#include "uplift/base/units.h"

#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <mutex>
#include <numbers>
#include <vector>

#include "uplift/base/error.h"
#include "uplift/base/text.h"

namespace uplift {
namespace {

constexpr double pi = std::numbers::pi;

constexpr CommonUnit unit_table[] = {
    {"m", "m", 1},
    {"cm", "m", 1e-2},
    {"mm", "m", 1e-3},
    {"um", "m", 1e-6},
    {"km", "m", 1e3},
    {"m2", "m2", 1},
    {"cm2", "m2", 1e-4},
    {"mm2", "m2", 1e-6},
    {"m3", "m3", 1},
    {"m4", "m4", 1},
    {"cm4", "m4", 1e-8},
    {"mm4", "m4", 1e-12},
    {"s", "s", 1},
    {"ms", "s", 1e-3},
    {"min", "s", 60},
    {"Hz", "Hz", 1},
    {"kHz", "Hz", 1e3},
    {"1/s", "1/s", 1},
    {"N", "N", 1},
    {"kN", "N", 1e3},
    {"MN", "N", 1e6},
    {"Pa", "Pa", 1},
    {"kPa", "Pa", 1e3},
    {"MPa", "Pa", 1e6},
    {"GPa", "Pa", 1e9},
    {"kN/m2", "Pa", 1e3},
    {"MN/m2", "Pa", 1e6},
    {"N/mm2", "Pa", 1e6},
    {"Pa/m", "Pa/m", 1},
    {"kPa/m", "Pa/m", 1e3},
    {"MPa/m", "Pa/m", 1e6},
    {"GPa/m", "Pa/m", 1e9},
    {"N/m3", "Pa/m", 1},
    {"kN/m3", "Pa/m", 1e3},
    {"MN/m3", "Pa/m", 1e6},
    {"N/m", "N/m", 1},
    {"kN/m", "N/m", 1e3},
    {"MN/m", "N/m", 1e6},
    {"N/m", "J/m2", 1},
    {"J/m2", "J/m2", 1},
    {"N m", "N m", 1},
    {"kN m", "N m", 1e3},
    {"MN m", "N m", 1e6},
    {"kg", "kg", 1},
    {"t", "kg", 1e3},
    {"kg/m3", "kg/m3", 1},
    {"t/m3", "kg/m3", 1e3},
    {"kg m2", "kg m2", 1},
    {"t m2", "kg m2", 1e3},
    {"m/s", "m/s", 1},
    {"cm/s", "m/s", 1e-2},
    {"mm/s", "m/s", 1e-3},
    {"m/s2", "m/s2", 1},
    {"cm/s2", "m/s2", 1e-2},
    {"g_n", "m/s2", 9.80665},
    {"rad", "rad", 1},
    {"mrad", "rad", 1e-3},
    {"deg", "rad", pi / 180},
    {"rad/s", "rad/s", 1},
    {"Pa s/m", "Pa s/m", 1},
    {"kPa s/m", "Pa s/m", 1e3},
    {"N s/m", "N s/m", 1},
    {"kN s/m", "N s/m", 1e3},
    {"kg/m2", "kg/m2", 1},
    {"t/m2", "kg/m2", 1e3},
    {"N m/rad", "N m/rad", 1},
    {"kN m/rad", "N m/rad", 1e3},
    {"MN m/rad", "N m/rad", 1e6},
    {"%", "1", 1e-2},
};

// Names of what units measure, for messages. Of units with the same dimension the first names what was found.
struct Named {
  std::string_view unit, name;
};
constexpr Named names[] = {
    {"1", "a number"},
    {"m", "a length"},
    {"m2", "an area"},
    {"m3", "a volume"},
    {"m4", "a second moment of area"},
    {"s", "a time"},
    {"Hz", "a frequency"},
    {"1/s", "a rate"},
    {"rad", "an angle"},
    {"rad/s", "an angular velocity"},
    {"rad/s2", "an angular acceleration"},
    {"kg", "a mass"},
    {"kg/m", "a mass per length"},
    {"kg/m2", "a mass per area"},
    {"kg/m3", "a density"},
    {"kg m2", "a rotary inertia"},
    {"m/s", "a velocity"},
    {"m/s2", "an acceleration"},
    {"N", "a force"},
    {"N/m", "a force per length"},
    {"J/m2", "an energy per area"},
    {"N m", "a moment"},
    {"J", "an energy"},
    {"W", "a power"},
    {"N m/rad", "a rotational stiffness"},
    {"N s/m", "a viscous damping"},
    {"N m s/rad", "a rotational viscous damping"},
    {"Pa", "a pressure"},
    {"Pa/m", "a pressure per length"},
    {"Pa s/m", "a viscous damping per area"},
    {"1/m", "a curvature"},
    {"K", "a temperature"},
};

/// Value times factor, rounded once where the factor or its inverse is a whole number: "9 mm" is then the double 0.009.
double scaled(double value, double factor) {
  const double inverse = 1 / factor;
  const auto whole = [](double x) { return std::abs(x - std::round(x)) <= 4 * std::numeric_limits<double>::epsilon() * x; };
  if (factor >= 1 && whole(factor)) return value * std::round(factor);
  if (factor < 1 && whole(inverse)) return value / std::round(inverse);
  return value * factor;
}

// ---- UDUNITS-2 ----

struct Free {
  void operator()(ut_unit* unit) const { ut_free(unit); }
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, Free>;

/// What UDUNITS's own comparison overlooks: radians (dimensionless there) and origins ("degC", "m @ 3", logarithms, dates).
struct Facts {
  const ut_unit* radian = nullptr;
  int radians = 0;
  bool origin = false;
};
ut_status see_basic(const ut_unit* unit, void* facts) {
  Facts& f = *static_cast<Facts*>(facts);
  if (ut_compare(unit, f.radian) == 0) f.radians += 1;
  return UT_SUCCESS;
}
ut_status see_product(const ut_unit*, int count, const ut_unit* const* basic, const int* powers, void* facts) {
  Facts& f = *static_cast<Facts*>(facts);
  for (int i = 0; i < count; ++i)
    if (ut_compare(basic[i], f.radian) == 0) f.radians += powers[i];
  return UT_SUCCESS;
}
ut_status see_galilean(const ut_unit*, double, const ut_unit* underlying, double offset, void* facts);
ut_status see_timestamp(const ut_unit*, const ut_unit*, double, void* facts) {
  static_cast<Facts*>(facts)->origin = true;
  return UT_SUCCESS;
}
ut_status see_logarithmic(const ut_unit*, double, const ut_unit*, void* facts) {
  static_cast<Facts*>(facts)->origin = true;
  return UT_SUCCESS;
}
constexpr ut_visitor visitor{see_basic, see_product, see_galilean, see_timestamp, see_logarithmic};
ut_status see_galilean(const ut_unit*, double, const ut_unit* underlying, double offset, void* facts) {
  if (offset != 0) static_cast<Facts*>(facts)->origin = true;
  return ut_accept_visitor(underlying, &visitor, facts);
}

/// The data base with the words that it lacks: g_n (standard gravity), deg, and short names of pressures and moduli of subgrade reaction.
class UnitSystem {
 public:
  UnitSystem() {
    ut_set_error_message_handler(ut_ignore);  // it would print
    system_ = ut_read_xml(nullptr);
    if (!system_) return;
    map("g_n", "9.80665 m/s2");
    map("deg", "degree");
    map("tf", "9806.65 N");
    map("psf", "lbf/ft2");
    map("ksf", "kip/ft2");
    map("pci", "lbf/in3");
    map("kcf", "kip/ft3");
    radian_ = parse("radian");
  }
  ~UnitSystem() {
    radian_.reset();
    if (system_) ut_free_system(system_);
  }
  UnitSystem(const UnitSystem&) = delete;
  UnitSystem& operator=(const UnitSystem&) = delete;

  bool ready() const { return system_ != nullptr; }
  /// Null when the text is not a unit.
  Unit parse(std::string_view text) const { return Unit(ut_parse(system_, std::string(text).c_str(), UT_UTF8)); }
  Facts facts(const Unit& unit) const {
    Facts f{radian_.get()};
    ut_accept_visitor(unit.get(), &visitor, &f);
    return f;
  }
  std::mutex& guard() const { return guard_; }

 private:
  void map(const char* name, std::string_view text) const {
    if (const Unit unit = parse(text)) ut_map_name_to_unit(name, UT_ASCII, unit.get());
  }
  ut_system* system_ = nullptr;
  Unit radian_;
  mutable std::mutex guard_;  // UDUNITS's parser keeps its state in globals
};

/// Made at the first call and constant from then on.
const UnitSystem& unit_system() {
  static const UnitSystem system;
  return system;
}

/// NaN when there is none. UDUNITS converts reciprocals too (10 s is 0.1 Hz to it), which is no factor.
double factor_between(const Unit& from, const Unit& to) {
  const std::unique_ptr<cv_converter, Free> converter(ut_get_converter(from.get(), to.get()));
  if (!converter) return std::numeric_limits<double>::quiet_NaN();
  const double one = cv_convert_double(converter.get(), 1), two = cv_convert_double(converter.get(), 2);
  return std::abs(two - 2 * one) <= 1e-12 * std::abs(one) ? one : std::numeric_limits<double>::quiet_NaN();
}
bool convertible(const Unit& from, const Unit& to) {
  return from && to && std::isfinite(factor_between(from, to));
}

/// UDUNITS takes radians as plain numbers. Here "30 deg" is no ratio and "10 Hz" no angular velocity (a silent factor 2 pi), while a ratio
/// may be an angle ("2 mm/m") and the radian of a rotational stiffness may be left out ("5 kN m" for N m/rad).
bool same_dimension(const UnitSystem& system, const Unit& found, const Unit& wanted) {
  if (!convertible(found, wanted)) return false;
  const int had = system.facts(found).radians, want = system.facts(wanted).radians;
  if (had == want) return true;
  if (had != 0) return false;
  for (const char* rate : {"1/s", "1/s2"})
    if (convertible(wanted, system.parse(rate))) return false;
  return true;
}

std::string dimension_of(const UnitSystem& system, const Unit& unit) {
  const int radians = system.facts(unit).radians;
  for (const Named& known : names) {
    const Unit other = system.parse(known.unit);
    if (convertible(unit, other) && system.facts(other).radians == radians) return std::string(known.name);
  }
  std::array<char, 200> definition{};
  const int length = ut_format(unit.get(), definition.data(), definition.size(), UT_ASCII | UT_DEFINITION);
  return length > 0 && length < static_cast<int>(definition.size()) ? std::string(definition.data()) : "another dimension";
}

// ---- the unit as it is written ----

bool is_unit_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 0x80;
}

/// Numbers in a unit that UDUNITS would read as factors or as power 0: "m 3" = 3 m, "m^0.5" = 5, "g0" = 1. Only whole exponents stand in a
/// unit here, and a leading "1/". Returns what is wrong, or nothing.
std::string fault_of(std::string_view unit) {
  if (unit.size() > 80) return "a unit that is too long";
  if (unit.find('@') != unit.npos) return "a unit with an origin";
  if (unit[0] == ',') return "use a decimal point, not a comma";
  for (const char c : unit)  // UDUNITS prints some of the others
    if (!is_letter(c) && !is_unit_digit(c) && std::string_view(" .*/^-+()%_'").find(c) == std::string_view::npos)
      return "no unit has the character " + in_quotes({&c, 1});
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (!is_unit_digit(unit[i])) continue;
    std::size_t end = i;
    while (end < unit.size() && is_unit_digit(unit[end])) ++end;
    std::size_t begin = i;
    if (begin > 0 && (unit[begin - 1] == '-' || unit[begin - 1] == '+')) --begin;
    while (begin > 0 && (unit[begin - 1] == '^' || unit[begin - 1] == '*')) --begin;
    const bool exponent = begin > 0 && (is_letter(unit[begin - 1]) || unit[begin - 1] == ')');
    const std::string_view rest = trim(unit.substr(end));
    const bool one_over = i == 0 && end == 1 && unit[0] == '1' && !rest.empty() && rest[0] == '/';
    if (exponent && unit.substr(i, end - i).find_first_not_of('0') == std::string_view::npos)
      return unit.starts_with("g0") ? "g0 is the gram to the power 0; standard gravity is g_n" : "a unit to the power 0";
    if (!exponent && !one_over) return "a number inside the unit";
    i = end - 1;
  }
  if (!is_letter(unit[0]) && unit[0] != '%' && unit[0] != '(' && unit[0] != '1') return "not a unit after the number";
  return {};
}

Quantity refused(std::string_view text, std::string_view why, std::string nearest = {}) {
  return {0, false, in_quotes(text) + " (" + std::string(why) + ")", std::move(nearest)};
}

std::string nearest_unit(std::string_view unit) {
  std::vector<std::string> words;
  for (const CommonUnit& row : unit_table) words.emplace_back(row.word);
  return nearest_name(unit, words);
}

/// To UDUNITS a ton is the American one of 907 kg, which hardly anybody means here. What is wrong, and the word to use.
std::pair<std::string_view, std::string_view> ambiguous_ton(std::string_view unit) {
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const std::size_t begin = i;
    while (i < unit.size() && (is_letter(unit[i]) || unit[i] == '_')) ++i;
    const std::string_view word = unit.substr(begin, i - begin);
    if (word == "ton" || word == "tons") return {"a ton is 907, 1000 or 1016 kg; t is 1000 kg", "t"};
    if (word == "tonf" || word == "ton_force") return {"a ton-force is 8.896, 9.807 or 9.964 kN; tf is 9.80665 kN", "tf"};
  }
  return {};
}

/// Conversion by UDUNITS; `number` [unit] was read from `text`.
Quantity convert(std::string_view text, double number, std::string_view unit, std::string_view wanted_unit) {
  if (const auto [why, word] = ambiguous_ton(unit); !why.empty()) return refused(text, why, std::string(word));
  const UnitSystem& system = unit_system();
  if (!system.ready()) return refused(text, "the data base of UDUNITS-2 is missing: install libudunits2-data");
  const std::lock_guard lock(system.guard());
  const Unit wanted = system.parse(wanted_unit), found = system.parse(unit);
  if (!found) return refused(text, "unknown unit " + in_quotes(unit), nearest_unit(unit));
  if (system.facts(found).origin) return refused(text, "a unit with an origin");
  if (same_dimension(system, found, wanted)) {
    const double value = scaled(number, factor_between(found, wanted));
    if (!std::isfinite(value) || (value == 0 && number != 0)) return refused(text, "beyond the range of numbers");
    return {value, true, {}, {}};
  }
  if (unit == "g" && dimension_name(wanted_unit) == "an acceleration") return refused(text, "g is the gram; standard gravity is g_n");
  std::string what = dimension_of(system, found);
  constexpr std::string_view masses[] = {"a mass", "a mass per length", "a mass per area", "a density"};
  if (std::ranges::find(masses, what) != std::end(masses) && convertible(system.parse("(" + std::string(unit) + ") m/s2"), wanted))
    what += "; the forces of kg, t and lb are kgf, tf and lbf";
  return refused(text, what);
}

}  // namespace

std::string_view dimension_name(std::string_view unit) {
  for (const Named& known : names)
    if (known.unit == unit) return known.name;
  return "a number";
}

std::string quantity_name(std::string_view unit) {
  const std::string name(dimension_name(unit));
  return unit.empty() || unit == "1" ? name : name + " [" + std::string(unit) + "]";
}

std::span<const CommonUnit> common_units() {
  return unit_table;
}

double udunits_factor(std::string_view from, std::string_view to) {
  const UnitSystem& system = unit_system();
  if (!system.ready()) return std::numeric_limits<double>::quiet_NaN();
  const std::lock_guard lock(system.guard());
  const Unit a = system.parse(from), b = system.parse(to);
  return a && b && same_dimension(system, a, b) ? factor_between(a, b) : std::numeric_limits<double>::quiet_NaN();
}

Quantity parse_quantity(std::string_view text, std::string_view wanted_unit) {
  const std::string_view whole = trim(text);
  if (whole.empty()) return {0, false, "an empty text", {}};
  const LeadingNumber number = leading_number(whole);
  if (number.out_of_range) return refused(text, "beyond the range of numbers");
  if (number.length == 0) return {0, false, in_quotes(text), {}};
  const std::string_view unit = trim(whole.substr(number.length));
  if (unit.empty()) return {number.value, true, {}, {}};
  if (wanted_unit.empty()) wanted_unit = "1";
  for (const CommonUnit& row : unit_table)
    if (row.word == unit && row.si == wanted_unit) {
      const double value = scaled(number.value, row.factor);
      if (!std::isfinite(value) || (value == 0 && number.value != 0)) return refused(text, "beyond the range of numbers");
      return {value, true, {}, {}};
    }
  if (const std::string fault = fault_of(unit); !fault.empty()) return refused(text, fault);
  return convert(text, number.value, unit, wanted_unit);
}

}  // namespace uplift
