#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "uplift/motion/formats/record_format.h"

// Tables of numbers in a text: where they begin, what separates them, what their columns are called.
namespace uplift {

struct Columns {
  char separator = ' ';              // ',', ';', '\t' or blanks
  bool decimal_comma = false;        // "0,01;0,12"
  int first_row = 0, head_line = 0;  // 0: there is none
  std::size_t width = 0;             // cells of the first row
  struct Head {
    std::string name, unit;
  };
  std::vector<Head> heads;  // empty or `width`
  // of comments: "# step = 0.01 s; unit = g", "# 1559 points at equal spacing of 0.02 sec"
  std::optional<Stated> step, count;
  std::string unit;
  int unit_line = 0;
};

/// Throws InputError when there is no row of numbers within the first lines.
Columns columns_of(const RecordText& text);
bool is_comment(std::string_view line);
/// Cells of a row of numbers; trailing empty cells beyond the width are dropped.
std::vector<std::string_view> cells_of(const Columns& columns, std::string_view line);
/// The number of a cell; `missing` for empty cells and NaN. Throws InputError for anything else.
struct Cell {
  double number = 0;
  bool missing = false;
};
Cell number_of(const RecordText& text, const Columns& columns, int line, std::string_view cell);

/// Times that were read, with their lines, made equal steps of.
struct TimeSteps {
  double step = 0;                   // s
  std::vector<std::size_t> indices;  // of every row: > row number after a missing row
};
TimeSteps equal_steps(const RecordText& text, const std::vector<double>& times, const std::vector<int>& lines,
                      const std::optional<Stated>& stated);

}  // namespace uplift
