#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "simple_meshes.h"
#include "uplift/io/fields/fields.h"

// Meshes and fields to write, and a reader of what was written that has none of the writers' code: a strict parser of plain XML, a decoder
// of base64.
namespace uplift::fields_support {

struct XmlElement {
  std::string name, text;
  std::map<std::string, std::string> attributes;
  std::vector<XmlElement> children;
  /// The child of this name and, when given, with this attribute "Name"; a test that asks for another one fails.
  const XmlElement& at(const std::string& child, const std::string& named = {}) const {
    for (const XmlElement& one : children)
      if (one.name == child && (named.empty() || one.attributes.at("Name") == named)) return one;
    throw std::runtime_error("no element " + child + " " + named + " in " + name);
  }
  void all(const std::string& wanted, std::vector<const XmlElement*>& found) const {
    for (const XmlElement& one : children) {
      if (one.name == wanted) found.push_back(&one);
      one.all(wanted, found);
    }
  }
};

/// Elements, attributes in double quotes, text, the five entities; throws std::runtime_error for anything else.
class XmlParser {
 public:
  static XmlElement parse(std::string_view text) {
    XmlParser parser(text);
    parser.expect("<?xml version=\"1.0\"?>");
    parser.space();
    XmlElement root = parser.element();
    parser.space();
    if (parser.at_ != text.size()) throw std::runtime_error("text after the root");
    return root;
  }

 private:
  explicit XmlParser(std::string_view text) : text_(text) {}
  bool next_is(std::string_view part) const { return text_.substr(at_, part.size()) == part; }
  void expect(std::string_view part) {
    if (!next_is(part)) throw std::runtime_error("expected " + std::string(part) + " at " + std::string(text_.substr(at_, 40)));
    at_ += part.size();
  }
  void space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }
  std::string name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_')) ++at_;
    if (at_ == begin) throw std::runtime_error("expected a name");
    return std::string(text_.substr(begin, at_ - begin));
  }
  std::string characters(char end) {
    static const std::map<std::string, char> entities{{"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
    std::string result;
    while (at_ < text_.size() && text_[at_] != end) {
      const char c = text_[at_++];
      if (c == '<' || (static_cast<unsigned char>(c) < ' ' && c != '\n')) throw std::runtime_error("a character that must be escaped");
      if (c != '&') {
        result += c;
        continue;
      }
      const std::size_t stop = text_.find(';', at_);
      result += entities.at(std::string(text_.substr(at_, stop - at_)));
      at_ = stop + 1;
    }
    return result;
  }
  XmlElement element() {
    XmlElement result;
    expect("<");
    result.name = name();
    for (space(); !next_is(">") && !next_is("/>"); space()) {
      const std::string key = name();
      expect("=\"");
      if (!result.attributes.emplace(key, characters('"')).second) throw std::runtime_error("attribute twice");
      expect("\"");
    }
    if (next_is("/>")) return at_ += 2, result;
    expect(">");
    for (result.text = characters('<'); !next_is("</"); result.text += characters('<')) result.children.push_back(element());
    expect("</" + result.name + ">");
    return result;
  }
  std::string_view text_;
  std::size_t at_ = 0;
};

inline std::string from_base64(std::string_view text) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::size_t value = digits.find(c);
    if (value == std::string::npos) throw std::runtime_error("not base64");
    bits = bits << 6 | static_cast<unsigned>(value);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  return bytes;
}

/// Numbers of a <DataArray> of VTU: type and number of tuples as it says, header of 8 bytes.
template <class Number>
std::vector<Number> numbers_of(const XmlElement& array) {
  const std::map<std::string, std::size_t> sizes{{"Float32", 4}, {"Float64", 8}, {"Int32", 4}, {"UInt8", 1}};
  EXPECT_EQ(sizes.at(array.attributes.at("type")), sizeof(Number));
  EXPECT_EQ(array.attributes.at("type")[0] == 'F', std::is_floating_point_v<Number>);
  EXPECT_EQ(array.attributes.at("format"), "binary");
  const std::string bytes = from_base64(array.text);
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data(), sizeof(length));
  EXPECT_EQ(bytes.size(), length + sizeof(length));
  std::vector<Number> result(length / sizeof(Number));
  std::memcpy(result.data(), bytes.data() + sizeof(length), length);
  EXPECT_EQ(result.size(), std::stoul(array.attributes.at("NumberOfComponents")) * std::stoul(array.attributes.at("NumberOfTuples")));
  return result;
}

inline const Where here{"test", 0};

using Files = std::map<std::string, std::string>;
inline WriteFile into(Files& files) {
  return [&files](const std::string& name, std::string_view bytes) {
    EXPECT_TRUE(files.emplace(name, bytes).second) << name << " is written twice";
  };
}

/// Values that no other place has: 1000 * (frame + 1) + place + component / 8, exact in 32 bits for these sizes.
inline std::vector<double> unique_values(FieldKind kind, std::size_t places, int frame) {
  std::vector<double> values;
  const auto width = static_cast<std::size_t>(kind);
  for (std::size_t i = 0; i < places; ++i)
    for (std::size_t c = 0; c < width; ++c) values.push_back(1000. * (frame + 1) + static_cast<double>(i) + static_cast<double>(c) / 8);
  return values;
}

inline FieldFrame frame_of(const std::vector<FieldMesh>& blocks, int number) {
  FieldFrame frame{0.1 * number, {}};
  for (const FieldMesh& block : blocks) {
    BlockFields fields;
    for (const auto& [name, kind] : {std::pair{"displacement", FieldKind::vector}, {"pressure", FieldKind::scalar}})
      fields.points.push_back({name, "m", kind, unique_values(kind, block.points.size(), number)});
    for (const auto& [name, kind] :
         {std::pair{"stress", FieldKind::tensor}, {"velocity", FieldKind::vector}, {"status", FieldKind::scalar}})
      fields.cells.push_back({name, "", kind, unique_values(kind, block.cell.size(), number)});
    frame.blocks.push_back(std::move(fields));
  }
  return frame;
}

/// Two unit cubes side by side, of 2 x 2 x 2 grid cells each: the first of `a`, the second of `b`, in groups with names that XML minds.
inline Mesh two_boxes(Cell a, Cell b) {
  const auto lines = uniform_lines(0, 1, 2);
  Mesh mesh = box(lines, lines, lines, a);
  mesh.groups = {{"<left> & \"rest\"", mesh.groups.at("volume")}};
  const Mesh second = box(lines, lines, lines, b);
  const int nodes = static_cast<int>(mesh.nodes.size());
  for (const Vec3& node : second.nodes) mesh.nodes.push_back(node + Vec3(1, 0, 0));
  Group right{3, {}, {}};
  CellBlock& to = mesh.block(b);
  const Group& from = second.groups.at("volume");
  for (const CellId id : from.cells) {
    right.cells.push_back({mesh.find_block(b), to.count()});
    for (const int node : second.cell(id)) to.nodes.push_back(node + nodes);
  }
  mesh.groups["right"] = right;
  return mesh;
}

inline FieldMesh both(const Mesh& mesh, const std::string& name = "all of it") {
  return field_mesh(mesh, name, {"<left> & \"rest\"", "right"}, here);
}

/// Of a VTU file.
inline const XmlElement& piece_of(const XmlElement& file) {
  return file.at("UnstructuredGrid").at("Piece");
}

}  // namespace uplift::fields_support
