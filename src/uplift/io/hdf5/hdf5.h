#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// HDF5 files by the C library, whose headers only hdf5.cpp and write.cpp see. Objects are named by their path ("/ENS_MAA/soil").
// Several threads may use several files at the same time: their calls wait for each other.
namespace uplift {

/// An object of the library, released with it. An identifier is not negative.
class Hdf5Id {
 public:
  using Release = int (*)(std::int64_t);
  Hdf5Id() = default;
  Hdf5Id(std::int64_t id, Release release) : id_(id), release_(release) {}
  Hdf5Id(Hdf5Id&& other) noexcept;
  Hdf5Id& operator=(Hdf5Id&& other) noexcept;
  ~Hdf5Id();
  std::int64_t get() const { return id_; }
  bool ok() const { return id_ >= 0; }

 private:
  std::int64_t id_ = -1;
  Release release_ = nullptr;
};

/// Reads a file of unknown origin. Every function throws InputError, with the file and the path of the object, for what is missing, damaged
/// or of another type, and never makes room for more numbers than the file can hold; HDF5 itself prints nothing. Refused: links out of the
/// file, external or virtual storage, and filters other than deflate, shuffle, Fletcher-32, szip.
class Hdf5Reader {
 public:
  /// Opens a file on the disk, without locking it.
  static Hdf5Reader open(const std::string& path);
  /// The same for a file in memory (the bytes are copied); `name` stands for it in messages.
  static Hdf5Reader from_memory(std::string_view bytes, const std::string& name);

  /// Is there a group or a data set?
  bool has(const std::string& path) const;
  /// Names in a group, ascending.
  std::vector<std::string> children(const std::string& group) const;
  /// An attribute of one integer; none when there is no such attribute.
  std::optional<std::int64_t> integer_attribute(const std::string& object, const std::string& name) const;
  /// Lengths of a data set in each direction.
  std::vector<std::int64_t> shape(const std::string& data) const;
  /// All numbers of a data set of integers (4 or 8 bytes each), row after row; those beyond the range of int become its ends.
  std::vector<int> integers(const std::string& data) const;
  /// All numbers of a data set of floating-point numbers or integers (4 or 8 bytes each), row after row.
  std::vector<double> numbers(const std::string& data) const;
  /// Texts of fixed length: strings or arrays of bytes, without the zeros at their ends.
  std::vector<std::string> texts(const std::string& data) const;

  const std::string& file() const { return name_; }
  [[noreturn]] void fail(const std::string& object, const std::string& wanted, const std::string& found) const;

 private:
  Hdf5Reader(Hdf5Id file, std::string name, std::uint64_t bytes) : file_(std::move(file)), name_(std::move(name)), bytes_(bytes) {}
  Hdf5Id object(const std::string& path) const;
  Hdf5Id data(const std::string& path) const;
  std::uint64_t items(const std::string& path, const Hdf5Id& data) const;
  void check_storage(const std::string& path, const Hdf5Id& data) const;
  void read(const std::string& path, const Hdf5Id& data, std::int64_t memory_type, void* to) const;

  Hdf5Id file_;
  std::string name_;
  std::uint64_t bytes_;  // of the file
};

/// Writes a file: groups are made as paths need them, numbers are stored as little-endian, in rows. Throws InputError when the disk
/// refuses; a path that is written twice is a bug (assertion).
class Hdf5Writer {
 public:
  /// A new file; an older one is overwritten.
  static Hdf5Writer create(const std::string& path);
  /// A file that is kept in memory: see image().
  static Hdf5Writer in_memory();

  void group(const std::string& path);
  /// The product of the lengths in `shape` is the number of values. Data sets without values are written too.
  void numbers(const std::string& data, std::span<const double> values, std::span<const std::int64_t> shape);
  void numbers(const std::string& data, std::span<const float> values, std::span<const std::int64_t> shape);
  void integers(const std::string& data, std::span<const int> values, std::span<const std::int64_t> shape);
  void attribute(const std::string& object, const std::string& name, int value);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, std::string_view text);
  /// Everything written so far is on the disk after this. To be called at the end: the destructor cannot report a full disk.
  void flush();
  /// The file's bytes.
  std::string image();

 private:
  Hdf5Writer(Hdf5Id file, std::string name) : file_(std::move(file)), name_(std::move(name)) {}
  void write(const std::string& path, std::int64_t file_type, std::int64_t memory_type, const void* values, std::size_t count,
             std::span<const std::int64_t> shape);
  void attach(const std::string& object, const std::string& name, std::int64_t file_type, std::int64_t memory_type, const void* value);
  [[noreturn]] void fail(const std::string& object) const;

  Hdf5Id file_;
  std::string name_;
};

}  // namespace uplift
