#include "uplift/io/text/toml.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>

#include "unit/base/declaration_sample.h"
#include "uplift/base/file.h"

namespace uplift::toml_test {
namespace {

const RawTable& table_of(const Raw& raw) {
  return *std::get<std::shared_ptr<RawTable>>(raw.data);
}

const Raw& at(const Raw& raw, std::string_view key) {
  const Raw* found = table_of(raw).find(key);
  if (!found) throw std::runtime_error("no key " + std::string(key));
  return *found;
}

std::string error_of(std::string_view text) {
  try {
    read_toml_text(text, "case.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Toml, ReadsEveryKindWithItsPlace) {
  const Raw raw = read_toml_text(
      "a = 1\nb = 1.5\nc = true\nd = \"text\"\n\ne = [\n  1,\n  \"x\",\n]\n[f]\ng = 2\n[[h]]\n[[h]]\ni.j = 0x10\n", "case.toml");
  EXPECT_EQ(raw.where.line, 0);
  EXPECT_EQ(raw.where.file, "case.toml");
  EXPECT_EQ(raw.path, "");
  EXPECT_EQ(std::get<std::int64_t>(at(raw, "a").data), 1);
  EXPECT_EQ(std::get<double>(at(raw, "b").data), 1.5);
  EXPECT_EQ(std::get<bool>(at(raw, "c").data), true);
  EXPECT_EQ(std::get<std::string>(at(raw, "d").data), "text");
  EXPECT_EQ(at(raw, "d").where.line, 4);
  const RawList& list = std::get<RawList>(at(raw, "e").data);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[1].where.line, 8);
  EXPECT_EQ(list[1].path, "e[1]");
  EXPECT_EQ(at(raw, "f").where.line, 10);
  EXPECT_EQ(at(at(raw, "f"), "g").path, "f.g");
  const RawList& tables = std::get<RawList>(at(raw, "h").data);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].where.line, 12);
  EXPECT_EQ(tables[1].where.line, 13);
  EXPECT_EQ(at(at(tables[1], "i"), "j").path, "h[1].i.j");
  EXPECT_EQ(std::get<std::int64_t>(at(at(tables[1], "i"), "j").data), 16);
}

TEST(Toml, KeepsTheOrderOfTheFile) {
  const Raw raw = read_toml_text("z = 1\na = 2\nm = {y = 1, b = 2, x = 3}\n[k]\n[c]\n", "case.toml");
  const auto keys = [](const Raw& table) {
    std::string out;
    for (const auto& [key, value] : table_of(table).entries) out += key;
    return out;
  };
  EXPECT_EQ(keys(raw), "zamkc");
  EXPECT_EQ(keys(at(raw, "m")), "ybx");
}

TEST(Toml, AnEmptyFileIsAnEmptyTable) {
  for (const char* text : {"", "\n\n", "# nothing\n", "\xef\xbb\xbf"}) EXPECT_TRUE(table_of(read_toml_text(text, "f")).entries.empty());
}

TEST(Toml, ErrorsHaveTheirLine) {
  EXPECT_EQ(error_of("a = 1\na = 2\n"),
            "case.toml:2: expected TOML, found an error while parsing key-value pair: cannot redefine existing integer 'a'");
  EXPECT_EQ(error_of("a = 1\n\nb =\n").substr(0, 31), "case.toml:3: expected TOML, fou");
  EXPECT_EQ(error_of("[a\n").substr(0, 21), "case.toml:1: expected");
  EXPECT_EQ(error_of("[a]\nb = 1\n[a]\n").substr(0, 26), "case.toml:3: expected TOML");
  EXPECT_EQ(error_of("a = [1, 2\n\n").substr(0, 10), "case.toml:");
  EXPECT_EQ(error_of("a = \"open\nb = 1\n").substr(0, 26), "case.toml:1: expected TOML");
  EXPECT_EQ(error_of("x = 1\ny = 12 m\n").substr(0, 26), "case.toml:2: expected TOML");
  EXPECT_EQ(error_of("x = 1\ny = 1,5\n").substr(0, 26), "case.toml:2: expected TOML");
}

TEST(Toml, NumbersAreExactOrRefused) {
  EXPECT_EQ(std::get<double>(at(read_toml_text("a = 0.1", "f"), "a").data), 0.1);
  EXPECT_EQ(std::get<double>(at(read_toml_text("a = 5e-324", "f"), "a").data), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(std::get<double>(at(read_toml_text("a = 1.7976931348623157e308", "f"), "a").data), std::numeric_limits<double>::max());
  EXPECT_TRUE(std::signbit(std::get<double>(at(read_toml_text("a = -0.0", "f"), "a").data)));
  EXPECT_EQ(std::get<double>(at(read_toml_text("a = 1_000.5", "f"), "a").data), 1000.5);
  EXPECT_EQ(error_of("\na = 99999999999999999999\n").substr(0, 26), "case.toml:2: expected TOML");
  EXPECT_EQ(error_of("\na = 1e999\n").substr(0, 26), "case.toml:2: expected TOML");
}

TEST(Toml, DatesAreNoInput) {
  for (const char* text : {"a = 1979-05-27", "a = 07:32:00", "a = 1979-05-27T07:32:00Z"})
    EXPECT_EQ(error_of(text), "case.toml:1: a: expected a number, a text, true or false, a list or a table, found a date or a time");
}

TEST(Toml, HostileTexts) {
  EXPECT_EQ(error_of("a = \"\xff\"\n"), "case.toml:1: expected UTF-8, found the byte 0xff");
  EXPECT_EQ(error_of(std::string("a = 1\n\xff\xfe"
                                 "b\0 \0",
                                 12)),
            "case.toml:2: expected UTF-8, found the byte 0xff");
  EXPECT_NE(error_of(std::string("a = 1\nb\0 = 2\n", 13)), "no error");
  EXPECT_NE(error_of("a = " + std::string(100000, '[')), "no error");
  EXPECT_NE(error_of("a = " + std::string(65, '[') + std::string(65, ']')), "no error");
  EXPECT_EQ(error_of("a = " + std::string(60, '[') + std::string(60, ']')), "no error");
  std::string tables;
  for (int i = 0; i < 100000; ++i) tables += "{a=";
  EXPECT_NE(error_of("a = " + tables), "no error");
  std::string dots = "a";
  for (int i = 0; i < 1000000; ++i) dots += ".a";
  EXPECT_EQ(error_of("\n" + dots + " = 1\n"), "case.toml:2: expected a key of at most 64 levels, found a deeper one");
  EXPECT_EQ(error_of("[" + dots + "]\n"), "case.toml:1: expected a key of at most 64 levels, found a deeper one");
  EXPECT_EQ(error_of("# " + std::string(1000, '.') + " 0.1, 0.2\na = \"" + std::string(1000, '.') + "\"\n"), "no error");
  std::string numbers = "a = [0.5";
  for (int i = 0; i < 1000; ++i) numbers += ", 0.5";
  EXPECT_EQ(error_of(numbers + "]\n"), "no error");
  EXPECT_EQ(error_of(std::string((std::size_t{16} << 20) + 1, '\n')), "case.toml: expected at most 16 MiB of TOML, found 16777217 bytes");
}

// toml++ 3.3 asserts here.
TEST(Toml, HeadersThatAreNone) {
  EXPECT_EQ(error_of("a = 1\n\n[[[b]]]\nc = 2\n"), "case.toml:3: expected TOML, found unbalanced brackets or invalid characters");
  for (const char* text : {"[[[1]]]", "[[=", "[=]", "[[[", "x = 1\n[ [a]]", "[#", "[[\n", "[\n]"})
    EXPECT_NE(error_of(text), "no error") << text;
  EXPECT_EQ(error_of("a = [\n[[1]]]\n"), "no error");
}

// toml++ 3.3 runs into undefined behaviour here; run with the sanitizer, this test sees it.
TEST(Toml, CharactersBeyondAscii) {
  const Raw raw = read_toml_text("\"f\u00fc\u00df\u20ac\" = 1 # \u00f6\na = '\u00f6'\nb = \"\"\"\n\u3042\"\"\"\n", "f");
  EXPECT_EQ(at(raw, "f\u00fc\u00df\u20ac").where.line, 1);
  EXPECT_EQ(std::get<std::string>(at(raw, "a").data), "\u00f6");
  EXPECT_EQ(std::get<std::string>(at(raw, "b").data), "\u3042");
  EXPECT_EQ(error_of("a = 1\nh\u00f6he = 2\n").substr(0, 26), "case.toml:2: expected TOML");
  EXPECT_EQ(error_of("\u00e9 = 1\n").substr(0, 26), "case.toml:1: expected TOML");
  EXPECT_EQ(error_of("a = \u00e9\n").substr(0, 26), "case.toml:1: expected TOML");
}

// Random damage to a good text: it is read, or an InputError says why; nothing else. The seed is fixed.
TEST(Toml, DamagedTexts) {
  const std::string good =
      "title = \"t\"\nrule = \"gauss\"\ngravity = [0, \"-9.81 m/s2\"]\n[nodes]\ntop = [\"0 m\", \"5 m\"]\n[method]\ntype = \"penalty\"\n"
      "stiffness = \"2 MPa/m\"\n[[beam]]\nnodes = [\"a\", \"b\"]\nE = \"20000 MPa\"\n";
  const std::string alphabet = "\"'[]{}=.,#\n 0123456789abeEmPain-+_\\\xff\xc3\x01/^%";
  std::mt19937 random(12345);
  const auto below = [&random](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  int read = 0, refused = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string text = good;
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
      const std::size_t place = below(text.size());
      switch (below(3)) {
        case 0:
          text[place] = alphabet[below(alphabet.size())];
          break;
        case 1:
          text.insert(place, 1, alphabet[below(alphabet.size())]);
          break;
        default:
          text.erase(place, 1 + below(5));
      }
    }
    try {
      check(read_toml_text(text, "case.toml"), sample_section());
      ++read;
    } catch (const InputError& error) {
      EXPECT_FALSE(std::string(error.what()).empty());
      ++refused;
    }
  }
  EXPECT_GT(read, 50);
  EXPECT_GT(refused, 1000);
}

TEST(Toml, ReadsAFile) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / ("uplift-toml-" + std::to_string(::getpid()) + ".toml");
  write_file_atomically(path, "a = 1\nb = \n");
  try {
    read_toml_file(path.string());
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().file, path.string());
    EXPECT_EQ(error.where().line, 2);
  }
  std::filesystem::remove(path);
  EXPECT_THROW(read_toml_file(path.string()), InputError);
}

}  // namespace
}  // namespace uplift::toml_test
