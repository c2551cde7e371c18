#pragma once
#include <string>
#include <string_view>

// Numbers as an engineer says them.
namespace uplift {

/// "35.9 mm", "1.37 MN m", "0.5 s": three significant digits, with a prefix where the unit takes one.
std::string spoken(double value, std::string_view unit);
/// The same, with no more decimals than make sense beside `resolution`, in which the value still moves: "0.001 mrad" beside 0.022 mrad.
std::string spoken_within(double value, double resolution, std::string_view unit);
/// "69 %", "1.2 %", and "46 times" from ten on; a fraction is given.
std::string percent(double fraction);
/// "2.4 times as large", "37 % less", "the same": of a value beside a reference.
std::string beside(double value, double reference);

}  // namespace uplift
