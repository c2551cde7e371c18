#pragma once
#include <span>
#include <string>

// Cells of tables. Numbers as text: a run of 10 000 steps writes some hundred thousand of them.
namespace uplift {

/// Room that write_number() needs.
inline constexpr int number_room = 32;
/// Writes a number rounded to at most `digits` (1 to 15) significant digits, as "%g" does: "0.0358759", "-1.2e-07", "300000". Returns the
/// end. The value must be finite (NaN and infinities: assertion).
char* write_number(char* out, double value, int digits = 10);
/// The same, appended to a text.
void append_number(std::string& text, double value, int digits = 10);
/// Numbers with commas between them; null for what is not finite.
void append_numbers(std::string& text, std::span<const double> values, int digits = 10);
/// A cell of text in a table with commas (RFC 4180): in quotes where it needs them.
std::string csv_cell(const std::string& text);
/// Shortest text that reads back as the same number.
void append_exact(std::string& text, double value);

}  // namespace uplift
