#include "uplift/ensemble/store.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "uplift/base/file.h"
#include "uplift/ensemble/part_file.h"

namespace uplift {
namespace {

/// Whether `fresh` takes the place of `old`.
bool counts_more(const StudyResult& fresh, const StudyResult& old) {
  if (fresh.attempt != old.attempt) return fresh.attempt > old.attempt;
  if (fresh.outcome != old.outcome) return fresh.outcome < old.outcome;
  return line_of(fresh) < line_of(old);
}

}  // namespace

StudyStore::StudyStore(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/parts", error))
    if (entry.path().extension() == ".jsonl" && entry.is_regular_file(error)) paths.push_back(entry.path().string());
  std::ranges::sort(paths);
  for (const std::string& path : paths) read(path);
}

void StudyStore::read(const std::string& path) {
  const std::string text = read_file(path, std::numeric_limits<double>::infinity());
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == rest.npos ? rest.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);  // copied through a system that ends lines with two characters
    if (line.empty()) continue;
    if (std::optional<StudyResult> result = read_line(line))
      add(std::move(*result));
    else if (end != line.npos)
      ++damaged_;
  }
}

void StudyStore::add(StudyResult result) {
  const auto found = results_.find(result.id);
  if (found == results_.end()) {
    std::string id = result.id;
    results_.emplace(std::move(id), std::move(result));
    return;
  }
  ++repeated_;
  if (counts_more(result, found->second)) found->second = std::move(result);
}

const StudyResult* StudyStore::find(const std::string& id) const {
  const auto found = results_.find(id);
  return found == results_.end() ? nullptr : &found->second;
}

long StudyStore::attempts(const std::string& id) const {
  if (const auto found = attempts_.find(id); found != attempts_.end()) return found->second;
  const StudyResult* result = find(id);
  return result == nullptr ? 0 : result->attempt;
}

std::size_t StudyStore::forget_failed() {
  for (const auto& [id, result] : results_)
    if (!says_something(result.outcome)) attempts_[id] = result.attempt;
  return std::erase_if(results_, [](const auto& entry) { return !says_something(entry.second.outcome); });
}

}  // namespace uplift
