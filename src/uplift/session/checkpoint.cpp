#include "uplift/session/checkpoint.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "uplift/base/archive.h"
#include "uplift/base/file.h"
#include "uplift/base/text.h"

namespace uplift {
namespace fs = std::filesystem;

template <class Archive, SameAs<CheckpointOrigin> T>
void list_parts(Archive& archive, T& origin) {
  archive(origin.case_file, origin.from_folder, origin.resolved, origin.inputs, origin.program, origin.processor, origin.step_check);
}

template <class Archive, SameAs<Checkpoint> T>
void list_parts(Archive& archive, T& checkpoint) {
  archive(checkpoint.origin, checkpoint.label, checkpoint.state);
}

template <class Archive, SameAs<std::pair<std::string, std::string>> T>
void list_parts(Archive& archive, T& pair) {
  archive(pair.first, pair.second);
}

namespace {

constexpr std::string_view magic = "uplift checkpoint 1\n";
constexpr const char *ending = ".ckp", *before_ending = ".before.ckp";

std::size_t checksum(std::string_view bytes) {
  return crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

/// Name and flags of the processor, which decide what the libraries compute with.
std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  std::string found;
  for (std::string line; std::getline(info, line) && !line.empty();)
    if (line.starts_with("model name") || line.starts_with("flags")) found += line + '\n';
  return found;
}

/// A file's name for a run's label.
std::string stem_of(std::string label) {
  for (char& c : label)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return label;
}

/// Everything is on the disk, or nothing has changed. Empty, or the reason why it could not be written.
std::string write_durably(const fs::path& path, const fs::path& before, std::string_view bytes) {
  const std::string beside = path.string() + ".new";
  const int file = open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file < 0) return std::strerror(errno);
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t now = ::write(file, bytes.data() + written, bytes.size() - written);
    if (now < 0 && errno == EINTR) continue;
    if (now <= 0) break;
    written += static_cast<std::size_t>(now);
  }
  std::string why;
  if (written < bytes.size() || fdatasync(file) != 0) why = std::strerror(errno);
  if (close(file) != 0 && why.empty()) why = std::strerror(errno);
  if (why.empty() && fs::exists(path) && std::rename(path.c_str(), before.c_str()) != 0) why = std::strerror(errno);
  if (why.empty() && std::rename(beside.c_str(), path.c_str()) != 0) why = std::strerror(errno);
  if (!why.empty()) {
    std::remove(beside.c_str());
    return why;
  }
  if (const int folder = open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY); folder >= 0) {
    fsync(folder);
    close(folder);
  }
  return {};
}

std::optional<Checkpoint> read_checkpoint_file(const fs::path& path, std::string& why) {
  try {
    return read_checkpoint(read_file(path), why);
  } catch (const InputError& error) {
    why = error.what();
    return {};
  }
}

/// The first line that differs, as "`a` where the checkpoint has `b`".
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

CheckpointOrigin origin_of(const LoadedCase& loaded, bool step_check) {
  return {.case_file = loaded.read.file,
          .from_folder = fs::current_path().string(),
          .resolved = loaded.from.resolved,
          .inputs = loaded.from.inputs,
          .program = sha256(read_file("/proc/self/exe")),
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
  ArchiveWriter head;
  head(content.bytes().size(), checksum(content.bytes()));
  return std::string(magic) + head.bytes() + content.bytes();
}

std::optional<Checkpoint> read_checkpoint(std::string_view bytes, std::string& why) {
  constexpr std::size_t head = 2 * sizeof(std::size_t);
  why = "no checkpoint";
  if (!bytes.starts_with(magic)) return {};
  bytes.remove_prefix(magic.size());
  why = "cut off";
  if (bytes.size() < head) return {};
  std::size_t size = 0, sum = 0;
  ArchiveReader(bytes.substr(0, head))(size, sum);
  bytes.remove_prefix(head);
  if (bytes.size() < size) return {};
  why = "damaged";
  if (bytes.size() > size || checksum(bytes) != sum) return {};
  std::optional<Checkpoint> checkpoint(std::in_place);
  ArchiveReader reader(bytes);
  reader(*checkpoint);
  if (reader.failed() || !reader.at_end()) return {};
  why.clear();
  return checkpoint;
}

std::string checkpoints_at(const std::string& path) {
  fs::path place = fs::path(path).lexically_normal();
  if (!place.has_filename()) place = place.parent_path();
  std::error_code error;
  std::vector<std::pair<fs::file_time_type, std::string>> found;
  const fs::path above = place.has_parent_path() ? place.parent_path() : fs::path(".");
  const std::string parts = place.filename().string() + ".part-";
  for (fs::directory_iterator entry(above, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const fs::path inside = entry->path() / Checkpoints::subfolder;
    if (!name.starts_with(parts) || !fs::is_directory(inside, error)) continue;
    if (belongs_to_a_process(entry->path().string()))
      throw InputError({path, 0}, "", "results that no process computes any more", "the folder " + name + " of a running one");
    fs::file_time_type newest = fs::file_time_type::min();
    for (fs::directory_iterator file(inside, error), last; !error && file != last; file.increment(error))
      if (file->path().extension() == ending) newest = std::max(newest, file->last_write_time());
    if (newest != fs::file_time_type::min()) found.emplace_back(newest, inside.string());
  }
  if (!found.empty()) return std::ranges::max(found).second;
  const fs::path inside = place / Checkpoints::subfolder;
  if (fs::is_directory(inside, error)) return inside.string();
  throw InputError({path, 0}, "", "results of a run with [output] checkpoint that was interrupted",
                   fs::exists(place / "summary.json", error) ? "results that are complete, or without a checkpoint" : "no checkpoint");
}

CheckpointOrigin origin_of_checkpoints(const std::string& folder) {
  std::string why = "no file", first;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() != ending) continue;
    if (std::optional<Checkpoint> checkpoint = read_checkpoint_file(entry->path(), why)) return checkpoint->origin;
  }
  throw InputError({folder, 0}, "", "a checkpoint that is whole", why);
}

Checkpoints::Checkpoints(CheckpointOrigin origin, double seconds, const ResultFolder& folder, const std::string& from)
    : origin_(std::move(origin)), seconds_(seconds), folder_((fs::path(folder.working_path()) / subfolder).string()), from_(from) {
  if (from_.empty()) return;
  const CheckpointOrigin then = origin_of_checkpoints(from_);
  const Where where{from_, 0};
  if (then.program != origin_.program) throw InputError(where, "", "the program that wrote the checkpoint", "another one");
  if (then.resolved != origin_.resolved) throw InputError(where, "", "the case as it was", difference(origin_.resolved, then.resolved));
  for (std::size_t i = 0; i < std::max(then.inputs.size(), origin_.inputs.size()); ++i)
    if (i >= then.inputs.size() || i >= origin_.inputs.size() || then.inputs[i].second != origin_.inputs[i].second)
      throw InputError(where, "", "the files of the case as they were",
                       "another content of " + in_quotes((i < origin_.inputs.size() ? origin_ : then).inputs[i].first));
  if (then.processor != origin_.processor) note("the run goes on on another processor: not bit for bit");
}

std::optional<RunState> Checkpoints::begin(const std::string& label) {
  if (from_.empty()) return {};
  for (const char* each : {ending, before_ending}) {
    const fs::path path = fs::path(from_) / (stem_of(label) + each);
    std::error_code error;
    if (!fs::exists(path, error)) continue;
    std::string why;
    std::optional<Checkpoint> checkpoint = read_checkpoint_file(path, why);
    std::optional<RunState> state;
    if (checkpoint) state = read_run_state(checkpoint->state, why);
    if (state && checkpoint->label == label) return state;
    note(fmt::format("{}: {}, an earlier checkpoint or the beginning is taken instead", path.string(), why));
  }
  return {};
}

bool Checkpoints::write(const std::string& label, const RunState& state) {
  const fs::path folder(folder_);
  std::error_code error;
  fs::create_directories(folder, error);
  const std::string bytes = write_checkpoint({origin_, label, write_run_state(state)});
  const std::string why = write_durably(folder / (stem_of(label) + ending), folder / (stem_of(label) + before_ending), bytes);
  if (why.empty()) return true;
  note(fmt::format("a checkpoint of \"{}\" could not be written: {}", label, why));
  return false;
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

void KeptRun::attach(Keeping& keeping, Watch& watch) {
  if (checkpoints_ == nullptr) return;
  keeping.every = every_;
  if (from_) keeping.from = &*from_;
  keeping.keep = [this](const RunState& state) {
    const auto now = Clock::now();
    if (!stop_asked_ && std::chrono::duration<double>(now - last_).count() < checkpoints_->seconds()) return;
    checkpoints_->write(label_, state);
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
