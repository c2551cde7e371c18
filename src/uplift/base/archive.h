#pragma once
#include <array>
#include <concepts>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

// Values as bytes and back, with every bit of a double. A type is made known by one function for both ways, found by its argument:
//
//     template <class Archive, SameAs<Energies> T>
//     void list_parts(Archive& archive, T& energies) { archive(energies.kinetic, energies.strain, ...); }
//
// Bytes are those of the processor: what one machine wrote, another of the same kind reads.
namespace uplift {

/// `T` or `const T`.
template <class T, class Wanted>
concept SameAs = std::same_as<std::remove_const_t<T>, Wanted>;

template <class T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Appends values to bytes.
class ArchiveWriter {
 public:
  static constexpr bool reads = false;
  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void put_bytes(const void* from, std::size_t count) { bytes_.append(static_cast<const char*>(from), count); }
  template <class T>
  void put(const T& value) {
    if constexpr (Number<T>)
      put_bytes(&value, sizeof value);
    else
      list_parts(*this, value);
  }
  void put(const std::string& text) {
    put(text.size());
    put_bytes(text.data(), text.size());
  }
  template <class T>
  void put(const std::vector<T>& all) {
    put(all.size());
    if constexpr (Number<T>)
      put_bytes(all.data(), all.size() * sizeof(T));
    else
      for (const T& each : all) put(each);
  }
  template <class T, std::size_t n>
  void put(const std::array<T, n>& all) {
    for (const T& each : all) put(each);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }

  std::string bytes_;
};

/// Takes values from bytes. Where there are too few of them it fails for good, and the rest stays as it is.
class ArchiveReader {
 public:
  static constexpr bool reads = true;
  explicit ArchiveReader(std::string_view bytes) : rest_(bytes) {}
  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  bool failed() const { return failed_; }
  bool at_end() const { return rest_.empty(); }
  /// A number of values of so many bytes each at least, which the rest can hold; 0 where it cannot.
  std::size_t count(std::size_t each) {
    std::size_t number = 0;
    get(number);
    if (number > rest_.size() / each) failed_ = true;
    return failed_ ? 0 : number;
  }

 private:
  void get_bytes(void* to, std::size_t count) {
    if (failed_ || count > rest_.size()) {
      failed_ = true;
      return;
    }
    if (count > 0) std::memcpy(to, rest_.data(), count);
    rest_.remove_prefix(count);
  }
  template <class T>
  void get(T& value) {
    if constexpr (std::same_as<T, bool>) {
      char byte = 0;
      get_bytes(&byte, 1);
      value = byte != 0;
    } else if constexpr (Number<T>) {
      get_bytes(&value, sizeof value);
    } else {
      list_parts(*this, value);
    }
  }
  void get(std::string& text) {
    text.resize(count(1));
    get_bytes(text.data(), text.size());
  }
  template <class T>
  void get(std::vector<T>& all) {
    all.clear();
    all.resize(count(Number<T> ? sizeof(T) : 1));
    if constexpr (Number<T>)
      get_bytes(all.data(), all.size() * sizeof(T));
    else
      for (T& each : all) get(each);
  }
  template <class T, std::size_t n>
  void get(std::array<T, n>& all) {
    for (T& each : all) get(each);
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool there = false;
    get(there);
    value.reset();
    if (there && !failed_) get(value.emplace());
  }

  std::string_view rest_;
  bool failed_ = false;
};

/// Bytes with what they are in front of them (`kind`, a line of text) and a checksum.
std::string sealed(std::string_view kind, std::string_view content);
/// The content of such bytes. Other bytes, and those that are cut off or changed, are refused: then `why` says so.
std::optional<std::string_view> unsealed(std::string_view kind, std::string_view bytes, std::string& why);

}  // namespace uplift
