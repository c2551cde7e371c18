#include "uplift/io/mesh/med_file.h"

#include <filesystem>
#include <functional>

#include "uplift/base/error.h"
#include "uplift/io/hdf5/child.h"
#include "uplift/io/mesh/med.h"
#include "uplift/io/mesh/med_message.h"

namespace uplift {
namespace {

Mesh read_apart(const std::function<Hdf5Reader()>& open, std::uintmax_t size, const std::string& name, const std::string& mesh) {
  const auto work = [&]() -> std::string {
    try {
      return message_of(read_med(open(), mesh));
    } catch (const InputError& error) {
      return message_of(error);
    }
  };
  const auto bytes = static_cast<std::int64_t>(size);
  const ChildLimits limits{1'000'000'000 + 64 * bytes, static_cast<int>(5 + bytes / 2'000'000)};
  const ChildAnswer answer = answer_of_child(work, limits);
  if (!answer.failure.empty())
    throw InputError({name, 0}, "", "a sound MED file", "a damaged one: " + answer.failure + " while the HDF5 library was reading it");
  return mesh_of_message(answer.bytes, {name, 0});
}

}  // namespace

Mesh read_med_file(const std::string& path, const std::string& mesh) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw InputError({path, 0}, "", "a file", error.message());
  return read_apart([&] { return Hdf5Reader::open(path); }, size, path, mesh);
}

Mesh read_med_here(const std::string& path, const std::string& mesh) {
  return read_med(Hdf5Reader::open(path), mesh);
}

Mesh read_med_bytes(std::string_view bytes, const std::string& name, const std::string& mesh) {
  return read_apart([&] { return Hdf5Reader::from_memory(bytes, name); }, bytes.size(), name, mesh);
}

}  // namespace uplift
