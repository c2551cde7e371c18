#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "uplift/base/text.h"
#include "uplift/motion/formats/column_reader.h"
#include "uplift/motion/formats/record_format.h"

namespace uplift {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r';
}
bool is_word(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

std::string utf8_of_latin1(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      out += c;
      continue;
    }
    out += static_cast<char>(0xC0 | (byte >> 6));
    out += static_cast<char>(0x80 | (byte & 0x3F));
  }
  return out;
}

/// How a word that stands for a number which is not there begins: its length, 0 when it is something else.
std::size_t missing_word(std::string_view text) {
  std::size_t stars = 0;
  while (stars < text.size() && text[stars] == '*') ++stars;  // Fortran's mark of a number too long for its field
  if (stars > 0) return stars;
  const std::size_t sign = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  const std::string word = upper(text.substr(sign, 8));
  for (const std::string_view known : {"NAN", "INFINITY", "INF", "NULL", "N/A", "NA"})
    if (word.starts_with(known) && (word.size() == known.size() || !is_word(word[known.size()]))) return sign + known.size();
  return 0;
}

struct Word {
  std::size_t length = 0;        // 0: no number
  std::optional<double> number;  // none: missing
};

/// A number at the beginning of a text, also with Fortran's exponents "1.5D-3".
Word word_of(std::string_view text) {
  if (const std::size_t length = missing_word(text)) return {length, std::nullopt};
  LeadingNumber number = leading_number(text);
  if (number.length == 0) return {};
  std::string exponent;
  if (number.length + 1 < text.size() && (text[number.length] == 'D' || text[number.length] == 'd')) {
    exponent = text.substr(0, std::min<std::size_t>(text.size(), number.length + 8));
    exponent[number.length] = 'e';
    number = leading_number(exponent);
  }
  if (!number.out_of_range) return {number.length, number.value};
  // too small to be told from zero, or too large for anything
  const std::string used = upper(exponent.empty() ? text.substr(0, number.length) : std::string_view(exponent).substr(0, number.length));
  const bool small = used.find('E') == std::string::npos ? used.find('.') < 300 : used.find("E-") != std::string::npos;
  return {number.length, small ? std::optional(0.0) : std::nullopt};
}

/// "E-03" at the end of a line, empty when its last number has no such exponent.
std::string_view last_exponent(std::string_view line) {
  line = trim(line);
  const std::size_t letter = line.find_last_of("eEdD");
  if (letter == line.npos || letter + 2 >= line.size() || (line[letter + 1] != '-' && line[letter + 1] != '+')) return {};
  return line.find_first_not_of("0123456789", letter + 2) == line.npos ? line.substr(letter) : std::string_view();
}

/// Digits behind the point of the last number of a line, 0 without a point.
std::size_t last_decimals(std::string_view line) {
  line = trim(line);
  const std::size_t end = line.size() - last_exponent(line).size(), point = line.substr(0, end).find_last_not_of("0123456789");
  return point == line.npos || line[point] != '.' ? 0 : end - point - 1;
}

/// Where the last number of a line begins when its exponent, as long as in the line `above`, was cut off; npos when it is whole, or no
/// number.
std::size_t cut_number(std::string_view line, std::string_view above) {
  const std::size_t end = line.find_last_not_of(" \t"), length = last_exponent(above).size();
  if (end == line.npos || last_exponent(line).size() >= length) return line.npos;
  const std::size_t separator = line.find_last_of(" \t,;", end), word = separator == line.npos ? 0 : separator + 1;
  // old files leave no blank before a minus: the number before this one ends with its exponent
  for (std::size_t i = end + 1; i-- > word + length;)
    if (last_exponent(line.substr(word, i - word)).size() == length) return i;
  const std::string_view rest = line.substr(word, end + 1 - word);
  const bool number = rest.find_first_not_of("0123456789.+-eEdD") == rest.npos && rest.find_first_of("0123456789") != rest.npos;
  return number && last_decimals(rest) <= last_decimals(above) ? word : line.npos;
}

}  // namespace

RecordText::RecordText(std::string_view text, std::string file) : file_(std::move(file)) {
  constexpr std::size_t longest = 4'000'000;  // bytes of a line: 250 000 numbers in one row
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (const std::size_t zero = text.find('\0'); zero != text.npos)
    throw InputError({file_, 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n'))}, "",
                     "text", "a zero byte (a binary file, or UTF-16)");
  if (invalid_utf8(text)) {
    text_ = utf8_of_latin1(text);
    repairs_.emplace_back("bytes that are not UTF-8 were read as Latin-1");
  } else {
    text_ = text;
  }
  bool unix_ends = false, dos_ends = false, mac_ends = false;
  for (std::size_t begin = 0; begin < text_.size();) {
    const std::size_t end = std::min(text_.find_first_of("\r\n", begin), text_.size());
    lines_.emplace_back(begin, end - begin);
    if (end - begin > longest)
      throw InputError(where(count()), "", fmt::format("lines of at most {} characters", longest), fmt::format("{}", end - begin));
    std::size_t next = end;
    while (next < text_.size() && text_[next] == '\r') ++next;
    const bool feed = next < text_.size() && text_[next] == '\n';
    if (!feed && next > end + 1) next = end + 1;  // empty lines with single returns
    (feed ? (next > end ? dos_ends : unix_ends) : mac_ends) |= end < text_.size();
    begin = feed ? next + 1 : std::max(next, end + 1);
  }
  if (unix_ends + dos_ends + mac_ends > 1) repairs_.emplace_back("line ends of different systems are mixed; each was taken as one");
  if (!text_.empty() && text_.back() != '\n' && text_.back() != '\r' && !leave_out_cut_number())
    repairs_.emplace_back("the last line has no end; it was taken as complete");
}

/// "4.6434E" or "4.6434" at the end of a file whose numbers end as in "4.6434E-03": without its exponent it would be a thousand times
/// too large. The lines above tell how the exponents are written.
bool RecordText::leave_out_cut_number() {
  constexpr int lines_above = 5;
  if (count() <= lines_above || is_comment(line(count()))) return false;
  const std::string_view above = line(count() - 1);
  const std::size_t length = last_exponent(above).size();
  for (int i = count() - lines_above; i < count(); ++i)
    if (length == 0 || last_exponent(line(i)).size() != length || last_decimals(line(i)) != last_decimals(above)) return false;
  const std::size_t cut = cut_number(line(count()), above);
  if (cut == std::string_view::npos) return false;
  cut_line_ = count();
  repairs_.push_back("the end of the file cut off its last number, " + in_quotes(trim(line(count()).substr(cut))) + ": left out");
  lines_.back().second = cut;
  return true;
}

std::string_view RecordText::line(int number) const {
  if (number < 1 || number > count()) return {};
  const auto [begin, length] = lines_[static_cast<std::size_t>(number) - 1];
  return std::string_view(text_).substr(begin, length);
}

void Samples::add(double value, int line) {
  values.push_back(value);
  last_line = line;
}

void Samples::add_missing(std::string found, int line) {
  missing.push_back({values.size(), line, std::move(found)});
  add(0, line);
}

void add_numbers(const RecordText& text, int line, Samples& samples, std::size_t width) {
  std::string_view rest = text.line(line);
  const auto add = [&](std::string_view field) {
    const Word word = word_of(field);
    if (word.length == 0) throw InputError(text.where(line), "", "numbers", in_quotes(field.substr(0, field.find_first_of(" \t,;"))));
    if (word.number)
      samples.add(*word.number, line);
    else
      samples.add_missing(std::string(field.substr(0, word.length)), line);
    return word.length;
  };
  if (width > 0 && rest.find('\t') == rest.npos) {
    for (; !trim(rest).empty(); rest.remove_prefix(std::min(width, rest.size()))) {
      const std::string_view field = trim(rest.substr(0, width));
      if (field.empty() || add(field) != field.size())
        throw InputError(text.where(line), "", "numbers in fields of " + std::to_string(width) + " characters",
                         in_quotes(rest.substr(0, width)));
    }
    return;
  }
  while (true) {
    while (!rest.empty() && (is_blank(rest.front()) || rest.front() == ',')) rest.remove_prefix(1);
    if (rest.empty()) return;
    rest.remove_prefix(add(rest));
    // what follows a number is a separator, or the sign of the next one
    if (!rest.empty() && !is_blank(rest.front()) && rest.front() != ',' && rest.front() != '-' && rest.front() != '+')
      throw InputError(text.where(line), "", "numbers", in_quotes(rest.substr(0, rest.find_first_of(" \t,;"))));
  }
}

RowForm row_form(std::string_view line) {
  const std::string capital = upper(line);
  for (std::size_t open = capital.find('('); open != capital.npos; open = capital.find('(', open + 1)) {
    const std::size_t letter = capital.find_first_not_of("0123456789", open + 1);
    if (letter == capital.npos || std::string_view("FEI").find(capital[letter]) == std::string_view::npos) continue;
    const LeadingNumber numbers = leading_number(std::string_view(capital).substr(open + 1));
    const LeadingNumber width = leading_number(std::string_view(capital).substr(letter + 1));
    if (width.length == 0 || width.value < 1 || width.value > 80 || numbers.value > 80) continue;
    return {numbers.length == 0 ? 1 : static_cast<std::size_t>(numbers.value), static_cast<std::size_t>(width.value)};
  }
  return {};
}

int add_block(const RecordText& text, int first, double count, std::size_t width, Samples& samples) {
  if (width > 0) {
    Samples row;
    try {
      add_numbers(text, first, row, width);
    } catch (const InputError&) {
      width = 0;  // written with blanks by another program
    }
  }
  int line = first;
  for (; line <= text.count() && static_cast<double>(samples.values.size()) < count; ++line) {
    const std::string start = upper(trim(text.line(line)).substr(0, 3));
    if (start.starts_with("END") || start.starts_with("/&") || start.starts_with("|")) break;
    add_numbers(text, line, samples, width);
  }
  return line;
}

std::string_view text_after(std::string_view line, std::string_view label) {
  const std::size_t at = upper(line).find(upper(label));
  if (at == std::string::npos) return {};
  line.remove_prefix(at + label.size());
  const std::size_t begin = line.find_first_not_of(" \t=:.");
  return begin == line.npos ? std::string_view() : trim(line.substr(begin));
}

std::optional<double> whole_number(std::string_view word) {
  const Word found = word_of(trim(word));
  return found.length > 0 && found.length == trim(word).size() ? found.number : std::nullopt;
}

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

std::size_t find_word(std::string_view text, std::string_view word, std::size_t from) {
  for (std::size_t at = text.find(word, from); at != text.npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_word(text[at - 1])) && (end == text.size() || !is_word(text[end]))) return at;
  }
  return std::string_view::npos;
}

std::optional<double> number_after(std::string_view text, std::size_t position) {
  if (position >= text.size()) return std::nullopt;
  text.remove_prefix(position);
  const std::size_t begin = text.find_first_not_of(" \t=:,");
  if (begin == text.npos) return std::nullopt;
  const Word word = word_of(text.substr(begin));
  return word.length > 0 ? word.number : std::nullopt;
}

std::optional<double> azimuth_of(std::string_view component) {
  std::string word;
  for (const char c : upper(component))
    if (c != ' ' && c != '-' && c != '_') word += c;
  const auto rad = [](double degrees) { return degrees * std::numbers::pi / 180; };
  const LeadingNumber number = leading_number(word);
  if (number.length > 0 && number.length <= 5 && number.value >= 0 && number.value <= 360) {
    const std::string after = word.substr(number.length);
    if (after.empty() || after.starts_with("DEG") || after.starts_with("(")) return rad(number.value);
    return std::nullopt;
  }
  if (word == "NS" || word == "N" || word == "NORTH") return 0;
  if (word == "EW" || word == "E" || word == "EAST") return rad(90);
  if (word == "S" || word == "SN" || word == "SOUTH") return rad(180);
  if (word == "W" || word == "WE" || word == "WEST") return rad(270);
  // a quadrant: "N21E", "S45W"
  if (word.size() < 3 || (word.front() != 'N' && word.front() != 'S') || (word.back() != 'E' && word.back() != 'W')) return std::nullopt;
  const std::optional<double> angle = whole_number(std::string_view(word).substr(1, word.size() - 2));
  if (!angle || *angle < 0 || *angle > 90) return std::nullopt;
  const double east = word.back() == 'E' ? 1 : -1;
  return rad(word.front() == 'N' ? std::fmod(360 + east * *angle, 360) : 180 - east * *angle);
}

}  // namespace uplift
