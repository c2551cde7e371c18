#pragma once
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include "uplift/base/archive.h"
#include "uplift/io/fields/fields.h"

// Frames of a run that keeps checkpoints, in the order in which they were written: a run that goes on from a checkpoint writes them again,
// so that its files are those of a run that was never interrupted, byte for byte. The files themselves would not do: an HDF5 file whose
// process was killed cannot be read.
namespace uplift {

template <class Archive, SameAs<FieldValues> T>
void list_parts(Archive& archive, T& values) {
  archive(values.name, values.unit, values.kind, values.values);
}
template <class Archive, SameAs<BlockFields> T>
void list_parts(Archive& archive, T& fields) {
  archive(fields.points, fields.cells);
}
template <class Archive, SameAs<FieldFrame> T>
void list_parts(Archive& archive, T& frame) {
  archive(frame.time, frame.blocks);
}

class FrameJournal {
 public:
  /// Begins a file.
  explicit FrameJournal(const std::string& path);
  void append(const FieldFrame& frame);
  /// From here on what was appended outlives a power cut. Returns the bytes of the file; throws filesystem_error where a part of them could
  /// not be written.
  std::uint64_t sync();
  /// A frame is missing: sync() throws from now on.
  void fail() { failed_ = true; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::string path_;
  const std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t bytes_ = 0;
  bool failed_;
};

/// Hands out the frames in the first `bytes` of a journal, one by one. False where they are cut off or changed: then `why` says so.
bool read_journal(const std::string& path, std::uint64_t bytes, const std::function<void(const FieldFrame&)>& take, std::string& why);

}  // namespace uplift
