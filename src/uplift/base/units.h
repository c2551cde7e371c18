#pragma once
#include <span>
#include <string>
#include <string_view>

// Units of the input, by UDUNITS-2. Its data base is read at the first unit that is not in the short table of common_units(): that costs
// 4 ms, a sixth of what a whole run may take.
namespace uplift {

/// A text with a unit, converted.
struct Quantity {
  double value = 0;  // in the wanted unit
  bool ok = false;
  // When not ok, for InputError:
  std::string found;    // "\"3 m\" (a length)", "\"3 MPaa\" (unknown unit \"MPaa\")"
  std::string nearest;  // a unit that was perhaps meant
};

/// Converts "20000 MPa" to the wanted SI unit ("Pa"; "1" for a plain number). A text without unit ("3.5") is taken as SI.
/// - Accelerations take "g_n" (standard gravity, 9.80665 m/s2); "g" is the gram and refused there with a hint.
/// - Angles are kept apart from plain numbers, and rad/s from Hz, where UDUNITS would convert with factor 1.
/// - NaN, infinity, values beyond the range of a double, trailing text and units with an origin (degC) are refused.
/// May be called from several threads (calls that need UDUNITS wait for each other).
Quantity parse_quantity(std::string_view text, std::string_view wanted_unit);

/// What a unit measures: "a pressure [Pa]"; "a number" for "1"; "a number [kg3]" for units without a name here.
std::string quantity_name(std::string_view unit);
/// The same without the unit: "a pressure".
std::string_view dimension_name(std::string_view unit);

/// A unit word whose conversion is known without the data base. A test compares every row with UDUNITS.
struct CommonUnit {
  std::string_view word, si;
  double factor;  // [si] per [word]
};
std::span<const CommonUnit> common_units();
/// Factor from one unit to another by UDUNITS alone, without the table; NaN when there is none. For tests of the table and of declarations.
double udunits_factor(std::string_view from, std::string_view to);

}  // namespace uplift
