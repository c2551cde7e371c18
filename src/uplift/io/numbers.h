#pragma once
#include <string>

// Numbers as text, fast: a run of 10 000 steps writes some hundred thousand of them.
namespace uplift {

/// Appends a number with at most `digits` (1 to 15) significant digits, without trailing zeros: "0.0358759", "-1.2e-07", "300000".
/// A value within about 1e-18 (relative) of a tie may be rounded either way. The value must be finite (NaN and infinities: assertion).
void append_number(std::string& text, double value, int digits = 10);
/// Shortest text that reads back as the same number.
void append_exact(std::string& text, double value);

}  // namespace uplift
