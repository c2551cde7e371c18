#include "uplift/session/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "uplift/base/archive.h"
#include "uplift/base/file.h"
#include "uplift/base/image.h"
#include "uplift/base/text.h"

namespace uplift {
namespace fs = std::filesystem;

template <class Archive, SameAs<CheckpointOrigin> T>
void list_parts(Archive& archive, T& origin) {
  archive(origin.verb, origin.case_file, origin.from_folder, origin.resolved, origin.inputs, origin.program, origin.processor,
          origin.step_check);
}

template <class Archive, SameAs<FieldRun::Memory> T>
void list_parts(Archive& archive, T& memory) {
  archive(memory.frames, memory.rest);
}

template <class Archive, SameAs<Checkpoint> T>
void list_parts(Archive& archive, T& checkpoint) {
  archive(checkpoint.origin, checkpoint.label, checkpoint.state, checkpoint.fields);
}

template <class Archive, SameAs<std::pair<std::string, std::string>> T>
void list_parts(Archive& archive, T& pair) {
  archive(pair.first, pair.second);
}

namespace {

constexpr std::string_view magic = "uplift checkpoint 2\n";
constexpr const char *ending = ".ckp", *before_ending = ".before.ckp", *journal_ending = ".frames";

/// Name and flags of the processor, and the shared libraries: what decides the last bits beside the program.
std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  std::string found;
  for (std::string line; std::getline(info, line) && !line.empty();)
    if (line.starts_with("model name") || line.starts_with("flags")) found += line + '\n';
  return found + identity_of_libraries();
}

/// A file's name for a run's label.
std::string stem_of(std::string label) {
  for (char& c : label)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return label;
}

std::optional<Checkpoint> read_checkpoint_file(const fs::path& path, std::string& why) {
  try {
    return read_checkpoint(read_file(path), why);
  } catch (const InputError& error) {
    why = error.what();
    return {};
  }
}

/// The first line that differs, as "`a` instead of `b`".
std::string difference(const std::string& now, const std::string& then) {
  std::size_t a = 0, b = 0;
  while (true) {
    const std::string one = now.substr(a, now.find('\n', a) - a), other = then.substr(b, then.find('\n', b) - b);
    if (one != other) return fmt::format("`{}` instead of `{}`", one, other);
    a = now.find('\n', a), b = then.find('\n', b);
    if (a == std::string::npos || b == std::string::npos) return "another number of lines";
    ++a, ++b;
  }
}

}  // namespace

CheckpointOrigin origin_of(const LoadedCase& loaded, const std::string& verb, bool step_check) {
  return {.verb = verb,
          .case_file = loaded.read.file,
          .from_folder = fs::current_path().string(),
          .resolved = loaded.from.resolved,
          .inputs = loaded.from.inputs,
          .program = identity_of_program(),
          .processor = processor(),
          .step_check = step_check};
}

std::string case_file_of(const CheckpointOrigin& origin) {
  const bool same_folder = fs::current_path().string() == origin.from_folder;
  return same_folder ? origin.case_file : (fs::path(origin.from_folder) / origin.case_file).lexically_normal().string();
}

std::string write_checkpoint(const Checkpoint& checkpoint) {
  ArchiveWriter content;
  content(checkpoint);
  return sealed(magic, content.bytes());
}

std::optional<Checkpoint> read_checkpoint(std::string_view bytes, std::string& why) {
  const std::optional<std::string_view> content = unsealed(magic, bytes, why);
  if (!content) return {};
  std::optional<Checkpoint> checkpoint(std::in_place);
  ArchiveReader reader(*content);
  reader(*checkpoint);
  if (!reader.failed() && reader.at_end()) return checkpoint;
  why = "it was written by another version of the program";
  return {};
}

std::string checkpoints_at(const std::string& path) {
  fs::path place = fs::path(path).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();
  std::error_code error;
  const fs::path above = place.has_parent_path() ? place.parent_path() : fs::path(".");
  const std::string own = place.filename().string(), parts = own + ".part-";
  std::pair<fs::file_time_type, std::string> newest{fs::file_time_type::min(), ""};
  if (fs::exists(place / "summary.json", error)) newest.first = fs::last_write_time(place / "summary.json", error);
  const bool has_results = newest.first != fs::file_time_type::min();
  for (fs::directory_iterator entry(above, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const fs::path inside = entry->path() / Checkpoints::subfolder;
    if ((name != own && !name.starts_with(parts)) || !fs::is_directory(inside, error)) continue;
    if (FolderLock(inside.string()).is_taken())
      throw InputError({path, 0}, "", "results that no process computes any more", "a running one that writes to " + name);
    for (fs::directory_iterator file(inside, error), last; !error && file != last; file.increment(error)) {
      if (file->path().extension() != ending) continue;
      // the results of an interrupted run are written after its checkpoints
      const fs::file_time_type time = name == own ? std::max(newest.first, file->last_write_time()) : file->last_write_time();
      if (time > newest.first || (name == own && newest.second.empty())) newest = {time, inside.string()};
    }
  }
  if (!newest.second.empty()) return newest.second;
  throw InputError({path, 0}, "", "results of a run with [output] checkpoint that was interrupted",
                   has_results ? "results that are complete, or without a checkpoint" : "no checkpoint");
}

CheckpointOrigin origin_of_checkpoints(const std::string& folder) {
  std::string why = "no file";
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() != ending) continue;
    if (std::optional<Checkpoint> checkpoint = read_checkpoint_file(entry->path(), why)) return checkpoint->origin;
  }
  throw InputError({folder, 0}, "", "a checkpoint that is whole", why);
}

Checkpoints::Checkpoints(CheckpointOrigin origin, double seconds, const ResultFolder& folder, const std::string& from)
    : origin_(std::move(origin)), seconds_(seconds), folder_((fs::path(folder.working_path()) / subfolder).string()), from_(from) {
  std::error_code error;
  fs::create_directories(folder_, error);
  lock_.emplace(folder_);
  if (from_.empty()) return;
  const CheckpointOrigin then = origin_of_checkpoints(from_);
  const Where where{from_, 0};
  if (then.program != origin_.program) throw InputError(where, "", "the program that wrote the checkpoint", "another one");
  if (then.resolved != origin_.resolved) throw InputError(where, "", "the case as it was", difference(origin_.resolved, then.resolved));
  for (std::size_t i = 0; i < std::max(then.inputs.size(), origin_.inputs.size()); ++i)
    if (i >= then.inputs.size() || i >= origin_.inputs.size() || then.inputs[i].second != origin_.inputs[i].second)
      throw InputError(where, "", "the files of the case as they were",
                       "another content of " + in_quotes((i < origin_.inputs.size() ? origin_ : then).inputs[i].first));
  if (then.processor != origin_.processor) note("the run goes on on another processor or with other shared libraries: not bit for bit");
}

std::optional<Checkpoints::Begin> Checkpoints::begin(const std::string& label) {
  if (from_.empty()) return {};
  for (const char* each : {ending, before_ending}) {
    const fs::path path = fs::path(from_) / (stem_of(label) + each);
    std::error_code error;
    if (!fs::exists(path, error)) continue;
    std::string why;
    std::optional<Checkpoint> checkpoint = read_checkpoint_file(path, why);
    std::optional<RunState> state;
    if (checkpoint) state = read_run_state(checkpoint->state, why);
    const std::string frames = (fs::path(from_) / (stem_of(label) + journal_ending)).string();
    if (state && checkpoint->label == label &&
        read_journal(
            frames, checkpoint->fields.frames, [](const FieldFrame&) {}, why))
      return Begin{std::move(*state), std::move(checkpoint->fields), frames};
    note(fmt::format("{}: {}, an earlier checkpoint or the beginning is taken instead", path.string(), why));
  }
  return {};
}

Checkpoints::~Checkpoints() {
  std::error_code error;
  const auto is_checkpoint = [](const fs::directory_entry& entry) { return entry.path().extension() == ending; };
  if (!fs::is_directory(folder_, error)) return;
  if (std::ranges::none_of(fs::directory_iterator(folder_, error), fs::directory_iterator(), is_checkpoint)) fs::remove_all(folder_, error);
}

std::string Checkpoints::journal(const std::string& label) const {
  return (fs::path(folder_) / (stem_of(label) + journal_ending)).string();
}

void Checkpoints::write(const std::string& label, const RunState& state, FieldRun* fields) {
  const fs::path stem = fs::path(folder_) / stem_of(label);
  const std::string newest = stem.string() + ending, next = newest + ".next";
  try {
    const FieldRun::Memory memory = fields != nullptr ? fields->memory() : FieldRun::Memory();
    write_file_durably(next, write_checkpoint({origin_, label, write_run_state(state), memory}));
    if (fs::exists(newest)) fs::rename(newest, stem.string() + before_ending);
    fs::rename(next, newest);
  } catch (const fs::filesystem_error& problem) {
    note(fmt::format("a checkpoint of \"{}\" could not be written: {}", label, problem.code().message()));
  }
}

void Checkpoints::remove() {
  std::error_code error;
  fs::remove_all(folder_, error);
}

std::vector<std::string> Checkpoints::notes() const {
  const std::lock_guard lock(mutex_);
  return notes_;
}

void Checkpoints::note(std::string text) {
  const std::lock_guard lock(mutex_);
  if (std::ranges::find(notes_, text) == notes_.end()) notes_.push_back(std::move(text));
}

namespace {

/// Steps between two states of a run from which it could go on: each costs about as much as a step more.
long steps_between(Index unknowns) {
  return unknowns < 3000 ? 256 : unknowns < 30000 ? 64 : 16;
}

}  // namespace

KeptRun::KeptRun(Checkpoints* checkpoints, std::string label, Index unknowns)
    : checkpoints_(checkpoints), label_(std::move(label)), every_(steps_between(unknowns)) {
  if (checkpoints_ != nullptr) from_ = checkpoints_->begin(label_);
}

void KeptRun::attach(Keeping& keeping, Watch& watch, FieldRun* fields) {
  if (checkpoints_ == nullptr) return;
  keeping.every = every_;
  if (from_) keeping.from = &from_->state;
  if (fields != nullptr) fields->keep_frames(checkpoints_->journal(label_));
  if (fields != nullptr && from_) fields->resume(from_->fields, from_->journal);
  keeping.keep = [this, fields](const RunState& state) {
    const auto now = Clock::now();
    if (!stop_asked_ && std::chrono::duration<double>(now - last_).count() < checkpoints_->seconds()) return;
    checkpoints_->write(label_, state, fields);
    last_ = Clock::now();
    stop_ = stop_asked_;
  };
  if (watch)
    watch = [this, inner = std::move(watch)](const Progress& progress) {
      if (!inner(progress)) stop_asked_ = true;
      return !stop_;
    };
}

}  // namespace uplift
