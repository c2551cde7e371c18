#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>

#include "unit/base/declaration_sample.h"
#include "uplift/io/text/toml.h"

namespace uplift::to_toml_test {
namespace {

Values read(const std::string& text) {
  return check(read_toml_text(text, "resolved.toml"), sample_section());
}

/// The same values bit for bit, wherever they stand.
void expect_same(const Values& a, const Values& b) {
  EXPECT_EQ(a.type(), b.type());
  EXPECT_EQ(a.key(), b.key());
  ASSERT_EQ(a.items().size(), b.items().size());
  for (const auto& [key, item] : a.items()) {
    const Values::Item& other = b.items().at(key);
    ASSERT_EQ(item.data.index(), other.data.index()) << key;
    if (const auto* number = std::get_if<double>(&item.data)) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(*number), std::bit_cast<std::uint64_t>(std::get<double>(other.data))) << key;
    } else if (const auto* list = std::get_if<std::vector<double>>(&item.data)) {
      const auto& second = std::get<std::vector<double>>(other.data);
      ASSERT_EQ(list->size(), second.size());
      for (std::size_t i = 0; i < list->size(); ++i)
        EXPECT_EQ(std::bit_cast<std::uint64_t>((*list)[i]), std::bit_cast<std::uint64_t>(second[i])) << key;
    } else if (const auto* inner = std::get_if<std::vector<Values>>(&item.data)) {
      const auto& second = std::get<std::vector<Values>>(other.data);
      ASSERT_EQ(inner->size(), second.size()) << key;
      for (std::size_t i = 0; i < inner->size(); ++i) expect_same((*inner)[i], second[i]);
    } else if (const auto* texts = std::get_if<std::vector<std::string>>(&item.data)) {
      EXPECT_EQ(*texts, std::get<std::vector<std::string>>(other.data)) << key;
    } else if (const auto* text = std::get_if<std::string>(&item.data)) {
      EXPECT_EQ(*text, std::get<std::string>(other.data)) << key;
    } else if (const auto* whole = std::get_if<std::int64_t>(&item.data)) {
      EXPECT_EQ(*whole, std::get<std::int64_t>(other.data)) << key;
    } else if (const auto* flag = std::get_if<bool>(&item.data)) {
      EXPECT_EQ(*flag, std::get<bool>(other.data)) << key;
    }
  }
}

TEST(ToToml, WritesSiNumbersWithUnitsAndDefaults) {
  const Values values = read(R"(title = "a \"quoted\" title"
gravity = [0, "-9.81 m/s2"]
method = {type = "penalty", stiffness = "2 MPa/m"}
nodes = {top = ["0 m", "5 m"], "base left" = [0, 0]}
cases = {a = {factor = "5 %"}}
[[beam]]
nodes = ["a", "b"]
E = "20000 MPa"
[[beam]]
E = 1e20
stiffness = "rigid"
law = "lagrange"
)");
  EXPECT_EQ(to_toml(values), R"(title = "a \"quoted\" title"
count = 7
on = false
rule = "nodal"
gravity = [0.0, -9.81]  # m/s2

[method]
type = "penalty"
stiffness = 2000000.0  # Pa/m
rounds = 10

[nodes]
top = [0.0, 5.0]  # m
"base left" = [0.0, 0.0]  # m

[cases]

[cases.a]
factor = 0.05

[limits]
rotation = 0.15  # rad

[[beam]]
nodes = ["a", "b"]
E = 20000000000.0  # Pa
stiffness = 5.0

[[beam]]
E = 1e+20  # Pa
stiffness = "rigid"
law = "lagrange"
)");
  expect_same(values, read(to_toml(values)));
}

TEST(ToToml, AwkwardContents) {
  const Values values = read(
      "title = \"tab\\t \\\\ \\\" \\u0001 \\u007f \\u00e9 # no comment\\nline\"\nkeys = []\nbeam = []\n"
      "nodes = {\"\" = [-0.0, 5e-324], \"a.b\" = [1, 2], \"\\\"\" = [9.9999999999999982e9, 3]}\n[damping]\nslope = -1\npair = [{factor = "
      "1}, {factor = 2}]\n");
  expect_same(values, read(to_toml(values)));
  EXPECT_TRUE(std::signbit(values.tables("nodes")[0].numbers("value")[0]));
}

RC_GTEST_PROP(ToToml, EveryDoubleReturnsBitForBit, ()) {
  const double value = std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>());
  RC_PRE(std::abs(value) <= 1e30);  // the largest number that the check accepts
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("title", Raw{std::string("t"), {}, "title"});
  table->entries.emplace_back("gravity", Raw{RawList{Raw{value, {}, ""}, Raw{-value, {}, ""}}, {}, "gravity"});
  const Values first = check(Raw{table, {}, ""}, sample_section());
  const Values second = read(to_toml(first));
  RC_ASSERT(std::bit_cast<std::uint64_t>(second.numbers("gravity")[0]) == std::bit_cast<std::uint64_t>(value));
  RC_ASSERT(std::bit_cast<std::uint64_t>(second.numbers("gravity")[1]) == std::bit_cast<std::uint64_t>(-value));
}

RC_GTEST_PROP(ToToml, EveryTextReturns, ()) {
  const auto characters = *rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127));
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("title", Raw{characters, {}, "title"});
  auto nodes = std::make_shared<RawTable>();
  nodes->entries.emplace_back(characters, Raw{RawList{Raw{1.0, {}, ""}, Raw{2.0, {}, ""}}, {}, ""});
  table->entries.emplace_back("nodes", Raw{nodes, {}, "nodes"});
  const Values second = read(to_toml(check(Raw{table, {}, ""}, sample_section())));
  RC_ASSERT(second.text("title") == characters);
  RC_ASSERT(second.tables("nodes")[0].key() == characters);
}

TEST(ToToml, APartAlone) {
  const Raw raw = read_toml_text("type = \"penalty\"\nstiffness = 3\n", "f");
  EXPECT_EQ(to_toml(check_part(raw, sample_methods())), "type = \"penalty\"\nstiffness = 3.0  # Pa/m\nrounds = 10\n");
}

}  // namespace
}  // namespace uplift::to_toml_test
