#include "uplift/io/fields/parts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace uplift {

std::string title(const FieldValues& field) {
  return field.unit.empty() ? field.name : field.name + " [" + field.unit + "]";
}

std::string xml_text(std::string_view text) {
  std::string result;
  for (const char c : text) switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  return result;
}

std::vector<std::string> plain_names(const std::vector<std::string>& names) {
  std::vector<std::string> result;
  for (const std::string& name : names) {
    std::string plain = name.empty() ? "_" : name;
    for (char& c : plain)
      if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-')) c = '_';
    const auto taken = [&](const std::string& one) { return std::find(result.begin(), result.end(), one) != result.end(); };
    std::string free = plain;
    for (int number = 2; taken(free); ++number) free = plain + "_" + std::to_string(number);
    result.push_back(free);
  }
  return result;
}

std::vector<std::string> plain_names(const std::vector<FieldMesh>& blocks) {
  std::vector<std::string> names;
  for (const FieldMesh& block : blocks) names.push_back(block.name);
  return plain_names(names);
}

std::vector<double> coordinates(const FieldMesh& block) {
  std::vector<double> result;
  result.reserve(3 * block.points.size());
  for (const Vec3& point : block.points) result.insert(result.end(), {point.x(), point.y(), point.z()});
  return result;
}

std::vector<int> vtk_nodes(const CellBlock& block) {
  constexpr std::array<std::size_t, 15> upside_down{3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8, 12, 13, 14};
  std::vector<int> nodes = block.nodes;
  if (block.cell != Cell::wedge6 && block.cell != Cell::wedge15) return nodes;
  const auto width = static_cast<std::size_t>(info(block.cell).nodes);
  for (std::size_t cell = 0; cell < nodes.size(); cell += width)
    for (std::size_t i = 0; i < width; ++i) nodes[cell + i] = block.nodes[cell + upside_down[i]];
  return nodes;
}

std::vector<float> as_float32(std::span<const double> values) {
  std::vector<float> result(values.size());
  std::transform(values.begin(), values.end(), result.begin(), [](double value) {
    assert(std::isfinite(value) && std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()));
    return static_cast<float>(value);
  });
  return result;
}

std::span<const double> as_float64(std::span<const double> values) {
  assert(std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }));
  return values;
}

std::string in_order_of_time(std::vector<FieldEntry> entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const FieldEntry& a, const FieldEntry& b) { return a.time < b.time; });
  std::string text;
  for (const FieldEntry& entry : entries) text += entry.text;
  return text;
}

}  // namespace uplift
