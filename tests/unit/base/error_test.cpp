#include "uplift/base/error.h"

#include <gtest/gtest.h>

#include "uplift/base/text.h"

namespace uplift::error_test {
namespace {

std::string text_of(const InputError& error) {
  return error.what();
}

TEST(InputError, SaysPlacePathWantedFoundAndNearest) {
  const InputError error({"case.toml", 12}, "beam[0].E", "a pressure [Pa]", "\"3 m\" (a length)", "MPa");
  EXPECT_EQ(text_of(error), "case.toml:12: beam[0].E: expected a pressure [Pa], found \"3 m\" (a length) (did you mean \"MPa\"?)");
  EXPECT_EQ(error.where().file, "case.toml");
  EXPECT_EQ(error.where().line, 12);
  EXPECT_EQ(error.path(), "beam[0].E");
}

TEST(InputError, LeavesOutEmptyPartsCleanly) {
  EXPECT_EQ(text_of({{"case.toml", 0}, "", "a file", "a folder"}), "case.toml: expected a file, found a folder");
  EXPECT_EQ(text_of({{"", 0}, "beam", "a table", "3"}), "beam: expected a table, found 3");
  EXPECT_EQ(text_of({{"", 0}, "", "a table", ""}), "expected a table");
  EXPECT_EQ(text_of({{"f", 3}, "a", "", "two tables"}), "f:3: a: found two tables");
  EXPECT_EQ(text_of({{"f", 3}, "a", "b", "", "c"}), "f:3: a: expected b (did you mean \"c\"?)");
  EXPECT_EQ(text_of({{"f", 3}, "a", "", "", "c"}), "f:3: a: did you mean \"c\"?");
  EXPECT_EQ(text_of({{"", 3}, "", "b", "c"}), "line 3: expected b, found c");
  EXPECT_EQ(text_of({{}, "", "", ""}), "bad input");
}

TEST(InputError, ShowsPathsInFull) {
  const std::string folder = "/" + std::string(400, 'd');
  const std::string text = text_of({{folder + "/case.toml", 7}, "mesh.file", "a file", "no file \"raft.mhs\"", folder + "/raft.msh"});
  EXPECT_EQ(text.find(folder + "/case.toml:7: mesh.file: "), 0U);
  EXPECT_NE(text.find("did you mean \"" + folder + "/raft.msh\"?"), std::string::npos) << text;
}

TEST(NearestName, FindsMisspellings) {
  const std::vector<std::string> names{"stiffness", "damping", "mass", "nodes", "K_n", "G_f", "augmented_lagrangian", "E", "I"};
  EXPECT_EQ(nearest_name("stifness", names), "stiffness");      // a letter lost
  EXPECT_EQ(nearest_name("dampping", names), "damping");        // a letter too many
  EXPECT_EQ(nearest_name("stepp", {"steps", "step"}), "step");  // the last letter typed twice
  EXPECT_EQ(nearest_name("msas", names), "mass");               // neighbours swapped: one edit
  EXPECT_EQ(nearest_name("node", names), "nodes");
  EXPECT_EQ(nearest_name("k_n", names), "K_n");  // case
  EXPECT_EQ(nearest_name("e", names), "E");
  EXPECT_EQ(nearest_name("augmented-lagrangian", names), "augmented_lagrangian");  // separator
  EXPECT_EQ(nearest_name("augment", names), "augmented_lagrangian");               // beginning
}

TEST(NearestName, KeepsQuietWhenNothingIsNear) {
  const std::vector<std::string> names{"stiffness", "mass", "E"};
  EXPECT_EQ(nearest_name("temperature", names), "");
  EXPECT_EQ(nearest_name("F", names), "");  // another letter is not a misspelling of a one-letter name
  EXPECT_EQ(nearest_name("moon", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("mass", {}), "");
  EXPECT_EQ(nearest_name(std::string(1000000, 'm'), names), "");
}

TEST(NearestName, PrefersTheNearestAndThenTheFirst) {
  EXPECT_EQ(nearest_name("nodes", {"notes", "node", "Nodes"}), "Nodes");
  EXPECT_EQ(nearest_name("ab1", {"ab2", "ab3"}), "ab2");
}

TEST(Text, QuotesForMessages) {
  EXPECT_EQ(in_quotes("a \"b\"\n"), "\"a \\\"b\\\"\\n\"");
  EXPECT_EQ(in_quotes(std::string(61, 'x')), "\"" + std::string(60, 'x') + "...\"");
  EXPECT_EQ(in_quotes(std::string(60, 'x')), "\"" + std::string(60, 'x') + "\"");
  EXPECT_EQ(in_quotes("\x01\x7f"), "\"\\u0001\\u007f\"");
  EXPECT_EQ(in_quotes("\xff"
                      "a"),
            "\"?a\"");
  EXPECT_EQ(in_quotes(std::string(59, 'x') + "\u00b2\u00b2"), "\"" + std::string(59, 'x') + "...\"");  // no half characters
}

TEST(Text, FindsInvalidUtf8) {
  EXPECT_FALSE(invalid_utf8("N\u00b7m \u20ac \U0001F600"));
  EXPECT_EQ(invalid_utf8("ab\xff"), 2u);
  EXPECT_EQ(invalid_utf8("\xc0\xaf"), 0u);          // overlong "/"
  EXPECT_EQ(invalid_utf8("a\xed\xa0\x80"), 1u);     // a surrogate
  EXPECT_EQ(invalid_utf8("a\xe2\x82"), 1u);         // cut off
  EXPECT_EQ(invalid_utf8("\xf4\x90\x80\x80"), 0u);  // beyond U+10FFFF
}

TEST(Text, Lists) {
  EXPECT_EQ(listed({}), "");
  EXPECT_EQ(listed({"a"}), "a");
  EXPECT_EQ(listed({"a", "b"}), "a or b");
  EXPECT_EQ(listed({"a", "b", "c"}), "a, b or c");
}

}  // namespace
}  // namespace uplift::error_test
