#include "uplift/base/error.h"

#include <algorithm>
#include <cctype>

#include "uplift/base/text.h"

namespace uplift {
namespace {

/// Keys and names of the input may be of any length. Paths of files end with what matters: one that the system can open stays whole.
std::string shortened(const std::string& text, std::size_t accepted = 300) {
  constexpr std::size_t most = 300;
  if (text.size() <= accepted) return text;
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // no character is cut in two
  return text.substr(0, end) + "...";
}

std::string message(const Where& where, const std::string& path, const std::string& wanted, const std::string& found,
                    const std::string& nearest) {
  constexpr std::size_t longest_path = 4096;
  std::string place = shortened(where.file, longest_path);
  if (where.line > 0) place += (place.empty() ? "line " : ":") + std::to_string(where.line);
  std::string what;
  if (!wanted.empty()) what = "expected " + wanted;
  if (!found.empty()) what += (what.empty() ? "found " : ", found ") + shortened(found);
  if (!nearest.empty()) what += (what.empty() ? "did you mean " : " (did you mean ") + escaped(nearest) + (what.empty() ? "?" : "?)");
  std::string out;
  for (const std::string& part : {place, shortened(path), what}) {
    if (part.empty()) continue;
    if (!out.empty()) out += ": ";
    out += part;
  }
  return out.empty() ? "bad input" : out;
}

// Distances are counted in half edits, so that a wrong case or separator is nearer than a wrong letter.
constexpr int edit = 2, slip = 1;

char folded(char c) {
  return c == '-' || c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Optimal string alignment distance (Damerau-Levenshtein without edits of a transposed pair): insert, delete, replace, swap neighbours.
int distance(std::string_view a, std::string_view b) {
  const std::size_t n = b.size();
  std::vector<int> before(n + 1), last(n + 1), now(n + 1);
  for (std::size_t j = 0; j <= n; ++j) last[j] = edit * static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = edit * static_cast<int>(i);
    for (std::size_t j = 1; j <= n; ++j) {
      const int change = a[i - 1] == b[j - 1] ? 0 : folded(a[i - 1]) == folded(b[j - 1]) ? slip : edit;
      now[j] = std::min({last[j] + edit, now[j - 1] + edit, last[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) now[j] = std::min(now[j], before[j - 2] + edit);
    }
    std::swap(before, last);
    std::swap(last, now);
  }
  return last[n];
}

}  // namespace

InputError::InputError(Where where, std::string path, const std::string& wanted, const std::string& found, const std::string& nearest)
    : std::runtime_error(message(where, path, wanted, found, nearest)), where_(std::move(where)), path_(std::move(path)) {}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 100;  // nobody misspells longer names, and the table of the distance grows with the square
  if (name.empty() || name.size() > longest) return {};
  std::string best, beginning;
  int least = 0;
  for (const std::string& candidate : candidates) {
    if (candidate.empty() || candidate.size() > longest) continue;
    const std::size_t length = std::max(name.size(), candidate.size());
    // One letter may differ only in its case, up to five letters allow one edit, then a third of the letters.
    const int most = length == 1 ? slip : edit * std::max(1, static_cast<int>(length) / 3);
    const int d = distance(name, candidate);
    const bool twice = name.starts_with(candidate) && name.back() == candidate.back();  // the last letter; of equals the likeliest
    if (d <= most && (best.empty() || d < least || (d == least && twice))) {
      best = candidate;
      least = d;
    }
    if (beginning.empty() && name.size() >= 3 && candidate.starts_with(name)) beginning = candidate;
  }
  return best.empty() ? beginning : best;
}

}  // namespace uplift
