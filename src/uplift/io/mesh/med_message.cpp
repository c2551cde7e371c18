#include "uplift/io/mesh/med_message.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

// A letter, then numbers as they lie in memory; lists are a count (8 bytes) and their items:
//   M dimension, nodes, count of blocks, (type, nodes, numbers in the file) each, count of groups, (name, dimension, cells, nodes) each, E
//   W file, line, path, wanted, found
namespace uplift {
namespace {

constexpr char mesh_mark = 'M', end_mark = 'E', error_mark = 'W';

class Packer {
 public:
  explicit Packer(char mark) { bytes_ += mark; }
  template <class Number>
  void one(Number value) {
    static_assert(std::is_trivially_copyable_v<Number>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  /// Any list of plain items that lie side by side.
  template <class List>
  void list(const List& items) {
    one(static_cast<std::uint64_t>(items.size()));
    if (!items.empty()) bytes_.append(reinterpret_cast<const char*>(items.data()), items.size() * sizeof(*items.data()));
  }
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Thrown by Unpacker, within this file only.
struct BadMessage {};

void require(bool condition) {
  if (!condition) throw BadMessage{};
}

class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}
  template <class Number>
  Number one() {
    require(bytes_.size() >= sizeof(Number));
    Number value;
    std::memcpy(&value, bytes_.data(), sizeof(value));
    bytes_.remove_prefix(sizeof(value));
    return value;
  }
  template <class List>
  List list() {
    using Item = typename List::value_type;
    const auto count = one<std::uint64_t>();
    require(count <= bytes_.size() / sizeof(Item));
    List items(static_cast<std::size_t>(count), Item{});
    if (count > 0) std::memcpy(static_cast<void*>(items.data()), bytes_.data(), static_cast<std::size_t>(count) * sizeof(Item));
    bytes_.remove_prefix(static_cast<std::size_t>(count) * sizeof(Item));
    return items;
  }
  std::string text() { return list<std::string>(); }
  bool empty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
};

using Coordinate = std::array<double, 3>;

CellBlock unpack_block(Unpacker& from, const Mesh& mesh) {
  const auto type = from.one<std::int32_t>();
  require(type >= 0 && type < num_cell_types);
  CellBlock block{static_cast<Cell>(type), from.list<std::vector<int>>()};
  block.file_number = from.list<std::vector<std::int64_t>>();
  require(block.file_number.empty() || block.file_number.size() == static_cast<std::size_t>(block.count()));
  require(mesh.find_block(block.cell) < 0 && block.nodes.size() % static_cast<std::size_t>(info(block.cell).nodes) == 0);
  const auto count = static_cast<int>(mesh.nodes.size());
  require(std::ranges::all_of(block.nodes, [count](int node) { return node >= 0 && node < count; }));
  return block;
}

Group unpack_group(Unpacker& from, const Mesh& mesh) {
  Group group;
  group.dimension = from.one<std::int32_t>();
  group.cells = from.list<std::vector<CellId>>();
  group.nodes = from.list<std::vector<int>>();
  const auto blocks = static_cast<int>(mesh.blocks.size()), nodes = static_cast<int>(mesh.nodes.size());
  std::vector<int> counts;
  for (const CellBlock& block : mesh.blocks) counts.push_back(info(block.cell).dimension == group.dimension ? block.count() : 0);
  for (const CellId cell : group.cells)
    require(cell.block >= 0 && cell.block < blocks && cell.index >= 0 && cell.index < counts[static_cast<std::size_t>(cell.block)]);
  for (const int node : group.nodes) require(node >= 0 && node < nodes);
  const auto falls = [](auto a, auto b) { return !(a < b); };
  require(std::ranges::adjacent_find(group.cells, falls) == group.cells.end());
  require(std::ranges::adjacent_find(group.nodes, falls) == group.nodes.end());
  require(group.cells.empty() || group.nodes.empty());
  return group;
}

Mesh unpack_mesh(Unpacker& from) {
  Mesh mesh;
  mesh.dimension = from.one<std::int32_t>();
  require(mesh.dimension == 2 || mesh.dimension == 3);
  const auto nodes = from.list<std::vector<Coordinate>>();
  require(nodes.size() < INT32_MAX);
  mesh.nodes.reserve(nodes.size());
  for (const Coordinate& x : nodes) {
    require(std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]));
    mesh.nodes.emplace_back(x[0], x[1], x[2]);
  }
  for (auto blocks = from.one<std::uint64_t>(); blocks > 0; --blocks) mesh.blocks.push_back(unpack_block(from, mesh));
  for (auto groups = from.one<std::uint64_t>(); groups > 0; --groups) {
    const std::string name = from.text();
    require(!name.empty() && mesh.groups.emplace(name, unpack_group(from, mesh)).second);
  }
  require(from.one<char>() == end_mark && from.empty());
  return mesh;
}

[[noreturn]] void throw_again(Unpacker& from) {
  Where where{from.text(), from.one<std::int32_t>()};
  const std::string path = from.text(), wanted = from.text(), found = from.text();
  require(from.empty());
  throw InputError(where, path, wanted, found);
}

}  // namespace

std::string message_of(const Mesh& mesh) {
  Packer to(mesh_mark);
  std::size_t bytes = 4096 + mesh.nodes.size() * sizeof(Coordinate);
  for (const CellBlock& block : mesh.blocks)
    bytes += block.nodes.size() * sizeof(int) + block.file_number.size() * sizeof(std::int64_t) + 64;
  for (const auto& [name, group] : mesh.groups) bytes += group.cells.size() * sizeof(CellId) + group.nodes.size() * sizeof(int);
  to.reserve(bytes);
  to.one(static_cast<std::int32_t>(mesh.dimension));
  static_assert(sizeof(Vec3) == sizeof(Coordinate));
  to.list(mesh.nodes);
  to.one(static_cast<std::uint64_t>(mesh.blocks.size()));
  for (const CellBlock& block : mesh.blocks) {
    to.one(static_cast<std::int32_t>(block.cell));
    to.list(block.nodes);
    to.list(block.file_number);
  }
  to.one(static_cast<std::uint64_t>(mesh.groups.size()));
  for (const auto& [name, group] : mesh.groups) {
    to.list(name);
    to.one(static_cast<std::int32_t>(group.dimension));
    to.list(group.cells);
    to.list(group.nodes);
  }
  to.one(end_mark);
  return to.take();
}

std::string message_of(const InputError& error) {
  // PLACE: expected EXPECTED, found FOUND. Wherever it is cut behind the place, it is put together to the same text again.
  const std::string text = error.what(), found = ", found ";
  const std::string begin = std::string(InputError(error.where(), error.path(), "", "").what()) + ": expected ";
  const std::size_t middle = text.rfind(found);
  const bool usual = text.starts_with(begin) && middle != text.npos && begin.size() <= middle;
  Packer to(error_mark);
  to.list(error.where().file);
  to.one(static_cast<std::int32_t>(error.where().line));
  to.list(error.path());
  to.list(usual ? text.substr(begin.size(), middle - begin.size()) : "a sound file");
  to.list(usual ? text.substr(middle + found.size()) : text);
  return to.take();
}

Mesh mesh_of_message(std::string_view bytes, const Where& where) {
  try {
    Unpacker from(bytes);
    const char mark = from.one<char>();
    if (mark == error_mark) throw_again(from);
    require(mark == mesh_mark);
    return unpack_mesh(from);
  } catch (const BadMessage&) {
    throw InputError(where, "", "a sound MED file", "a damaged one: the HDF5 library failed while reading it");
  }
}

}  // namespace uplift
