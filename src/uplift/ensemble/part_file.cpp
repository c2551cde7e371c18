#include "uplift/ensemble/part_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "uplift/io/files.h"
#include "uplift/io/text/json_writer.h"

namespace uplift {
namespace {

constexpr std::string_view before_checksum = ",\"crc\":\"", after_checksum = "\"}";
constexpr std::size_t checksum_size = before_checksum.size() + 8 + after_checksum.size();

std::string checksum(std::string_view text) {
  return fmt::format("{:08x}", crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size())));
}

void write_numbers(JsonWriter& json, const StudyResult& result) {
  json.key("numbers").begin_array();
  for (const StudyNumber& number : result.numbers)
    json.begin_array().value(number.quantity).value(number.of).value(number.value).end_array();
  json.end_array().key("spectra").begin_array();
  for (const StudySpectrum& spectrum : result.spectra)
    json.begin_object()
        .member("floor", spectrum.floor)
        .member("damping", spectrum.damping)
        .key("frequencies")
        .numbers(spectrum.frequencies)
        .key("psa")
        .numbers(spectrum.values)
        .end_object();
  json.end_array();
}

using Json = nlohmann::json;

StudyOutcome outcome_of(const Json& json) {
  const auto* word = std::ranges::find(study_outcomes, json.get<std::string>());
  if (word == std::end(study_outcomes)) throw std::out_of_range("outcome");
  return static_cast<StudyOutcome>(word - std::begin(study_outcomes));
}

StudyResult result_of(const Json& json) {
  StudyResult result;
  result.id = json.at("id").get<std::string>();
  result.motion = json.at("motion").get<std::string>();
  result.sample = json.at("sample").get<long>();
  result.factor = json.at("factor").get<double>();
  result.intensity = json.at("intensity").get<double>();
  result.outcome = outcome_of(json.at("outcome"));
  if (json.contains("bonded")) result.bonded = outcome_of(json.at("bonded"));
  result.reason = json.at("reason").get<std::string>();
  result.attempt = json.at("attempt").get<long>();
  for (const Json& number : json.at("numbers"))
    result.numbers.push_back({number.at(0).get<std::string>(), number.at(1).get<std::string>(), number.at(2).get<double>()});
  for (const Json& spectrum : json.at("spectra"))
    result.spectra.push_back({spectrum.at("floor").get<std::string>(), spectrum.at("damping").get<double>(),
                              spectrum.at("frequencies").get<std::vector<double>>(), spectrum.at("psa").get<std::vector<double>>()});
  result.end_time = json.at("end_time").get<double>();
  result.created = json.at("created").get<double>();
  result.steps = json.at("steps").get<long>();
  result.retries = json.at("retries").get<long>();
  result.replay = json.at("replay").get<bool>();
  result.wall = json.at("wall").get<double>();
  return result;
}

}  // namespace

std::string line_of(const StudyResult& result) {
  JsonWriter json;
  json.begin_object()
      .member("id", result.id)
      .member("motion", result.motion)
      .member("sample", result.sample)
      .member("factor", result.factor);
  json.member("intensity", result.intensity).member("outcome", to_string(result.outcome)).member("reason", result.reason);
  if (result.bonded) json.member("bonded", to_string(*result.bonded));
  json.member("attempt", result.attempt)
      .member("end_time", result.end_time)
      .member("created", result.created)
      .member("steps", result.steps);
  json.member("retries", result.retries).member("replay", result.replay).member("wall", result.wall);
  write_numbers(json, result);
  std::string text = json.end_object().take();
  text.pop_back();
  return fmt::format("{}{}{}{}\n", text, before_checksum, checksum(text), after_checksum);
}

std::optional<StudyResult> read_line(std::string_view line) {
  if (line.size() < checksum_size) return std::nullopt;
  const std::string_view text = line.substr(0, line.size() - checksum_size);
  if (line.substr(text.size()) != fmt::format("{}{}{}", before_checksum, checksum(text), after_checksum)) return std::nullopt;
  try {
    return result_of(Json::parse(line));
  } catch (const std::exception&) {  // of another version of the program
    return std::nullopt;
  }
}

PartFile::~PartFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

namespace {

[[noreturn]] void fail(const std::string& path) {
  throw OutputError(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
}

void sync_folder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void PartFile::open() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  std::string name(host.data());
  std::ranges::replace(name, '/', '_');
  // another process may have had this number before, or have it now on a machine of the same name
  for (int i = 1; descriptor_ < 0; ++i) {
    path_ = fmt::format("{}/{}-{}{}.jsonl", folder_, name, ::getpid(), i == 1 ? "" : fmt::format("-{}", i));
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) fail(path_);
  }
  sync_folder(folder_);  // the file and its folder outlive a power cut as what is in the file does
  sync_folder(folder_ + "/..");
}

void PartFile::append(std::string_view lines) {
  if (lines.empty()) return;
  if (descriptor_ < 0) open();
  dirty_ = true;
  while (!lines.empty()) {
    const ssize_t written = ::write(descriptor_, lines.data(), lines.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(path_);
    lines.remove_prefix(static_cast<std::size_t>(written));
  }
}

void PartFile::sync() {
  if (!dirty_) return;
  if (::fdatasync(descriptor_) != 0) fail(path_);
  dirty_ = false;
}

}  // namespace uplift
