#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace uplift {

/// A place in an input file; line 0 means that the place is the file (or the command line) as a whole.
struct Where {
  std::string file;
  int line = 0;
  int column = 0;  // from 1, in bytes; 0 where it is not known
};

/// Bad input, found before the first step. The text reads
/// `FILE:LINE: PATH: expected EXPECTED, found FOUND (did you mean "NEAREST"?)`.
class InputError : public std::runtime_error {
 public:
  /// `path` is the key as the user would write it ("interface[0].law.K_n"); any part may be empty.
  InputError(Where where, std::string path, const std::string& wanted, const std::string& found, const std::string& nearest = {});

  const Where& where() const { return where_; }
  const std::string& path() const { return path_; }

 private:
  Where where_;
  std::string path_;
};

/// The candidate nearest to `name` by edit distance; empty when none is near enough to be a likely misspelling.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace uplift
