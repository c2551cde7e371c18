#pragma once
#include <string>
#include <string_view>

// Numbers as an engineer says them.
namespace uplift {

/// A unit as it is printed: "m/s²" for "m/s2".
std::string format_unit(std::string_view unit);
/// "35.9 mm", "1.37 MN m", "0.5 s": three significant digits, with a prefix where the unit takes one.
std::string format_quantity(double value, std::string_view unit);
/// The same, with no more decimals than make sense beside `resolution`, in which the value still moves: "0.001 mrad" beside 0.022 mrad.
std::string format_quantity_within(double value, double resolution, std::string_view unit);
/// "69 %", "1.2 %", and "46 times" from ten on; a fraction is given. Halves are rounded away from zero.
std::string percent(double fraction);
/// One, two or five times a power of ten, not above the value: 0.002 of 0.0047. A positive number is given.
double rounded_down(double value);
/// A relative change: "+40 %", "-52 %", "unchanged", and from ten times on "12.4 times as large".
std::string format_change(double change);

}  // namespace uplift
