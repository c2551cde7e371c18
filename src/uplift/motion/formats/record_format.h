#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/base/declare.h"
#include "uplift/motion/formats/read.h"

// What a reader of records is, and what all of them share. A new format is one file with entry_record_NAME() and one line in parts.def.
namespace uplift {

/// A record as lines. Any line ends; bytes that are not UTF-8 are taken as Latin-1, and a mark of the byte order is skipped.
/// Throws InputError for what is no text (zero bytes) and for lines longer than any record's.
class RecordText {
 public:
  RecordText(std::string_view text, std::string file);

  int count() const { return static_cast<int>(lines_.size()); }
  /// From 1, without its end; empty beyond the last one.
  std::string_view line(int number) const;
  Where where(int number = 0) const { return {file_, number}; }
  const std::string& file() const { return file_; }
  std::size_t bytes() const { return text_.size(); }
  /// What was mended on this level.
  const std::vector<std::string>& repairs() const { return repairs_; }
  /// The line whose last number was left out because the end of the file cut it off; 0: none.
  int cut_line() const { return cut_line_; }

 private:
  bool leave_out_cut_number();

  int cut_line_ = 0;
  std::string file_, text_;
  std::vector<std::pair<std::size_t, std::size_t>> lines_;  // begin, length
  std::vector<std::string> repairs_;
};

/// The numbers of one component as they stand in the file, in the file's unit.
struct Samples {
  std::vector<double> values;  // 0 where one is missing
  struct Missing {
    std::size_t index;
    int line;
    std::string found;
  };
  std::vector<Missing> missing;
  int last_line = 0;

  void add(double value, int line);
  void add_missing(std::string found, int line);
};

/// Adds all numbers of a line: blanks between them, or the sign of the next one, or fields of `width` characters when it is not 0.
/// "NaN", "Inf" and "*****" are missing numbers; anything else is an InputError.
void add_numbers(const RecordText& text, int line, Samples& samples, std::size_t width = 0);
/// A row as Fortran's "(8F10.5)" in the text of a line describes it: 8 numbers in fields of 10 characters; zeros when there is none.
struct RowForm {
  std::size_t numbers = 0, width = 0;
};
RowForm row_form(std::string_view line);
/// Adds the numbers of the lines from `first` on, until there are `count` of them or the next line is one of text that ends a block
/// ("End of data", "/&", "|"). Fields of the given width unless the first row has other ones. Returns the line after them.
int add_block(const RecordText& text, int first, double count, std::size_t width, Samples& samples);
/// The number that a whole word is ("1.5", ".5", "1.5D-3"); none for anything else.
std::optional<double> whole_number(std::string_view word);

/// A unit of ground motion as records write it ("g", "cm/sec/sec", "GAL", "M/S^2").
struct MotionUnit {
  MotionKind kind;
  double factor;     // to SI
  std::string name;  // "cm/s2"
};
std::optional<MotionUnit> motion_unit(std::string_view word);
/// The same; throws InputError with what is known. `path` is where it was given ("unit"), or empty.
MotionUnit wanted_unit(std::string_view word, const Where& where, const std::string& path = {});

/// A number that the head of a file states, and where.
struct Stated {
  double value = 0;
  int line = 0;
};

/// One component as a format found it, before it is checked.
struct RecordDraft {
  std::string name, event, station, component;
  std::optional<double> azimuth;   // rad
  std::optional<MotionKind> kind;  // when the file says so in words
  std::string unit;                // of the numbers; empty: the file does not say
  int unit_line = 0;
  double scale = 1;                // of the numbers in the file, before the unit
  std::optional<Stated> step;      // s
  std::optional<Stated> count;     // points announced
  std::optional<Stated> peak;      // in the unit, signed
  bool peak_signed = true;         // or a magnitude only
  bool arbitrary_zero = false;     // counts of a digitiser: their mean is taken off
  std::vector<std::string> notes;  // repairs made by the format
  Samples samples;
  std::size_t per_row = 1;  // numbers in a full row
};

/// Checks a draft (step, number of points, gaps, unit, magnitude, stated peak), mends what can be, and says so in Motion::repairs.
Motion finished(const RecordText& text, const RecordOptions& options, RecordDraft draft);

/// "090", "N21E", "S 45 W", "NS", "E-W": clockwise from north, in rad; none for verticals and unknown words.
std::optional<double> azimuth_of(std::string_view component);

/// A format of files with recorded motions. Formats are asked in the order of parts.def; the last one takes every text.
struct RecordFormat : PartInfo {
  bool (*recognises)(const RecordText&) = nullptr;
  std::vector<Motion> (*read)(const RecordText&, const RecordOptions&) = nullptr;
};
std::span<const RecordFormat* const> record_catalog();
std::span<const PartInfo* const> record_formats();

// ---- words of heads ----

std::string upper(std::string_view text);
/// Position of a word of letters, digits and "_" in an upper-case text, not as a part of another word; npos when absent.
std::size_t find_word(std::string_view text, std::string_view word, std::size_t from = 0);
/// The text after a label ("Station Code"), past blanks and "=", ":" and "."; empty when the line has no such label. Case matters not.
std::string_view text_after(std::string_view line, std::string_view label);
/// The number after a position, past blanks and "=", ":" and ",".
std::optional<double> number_after(std::string_view text, std::size_t position);

}  // namespace uplift
