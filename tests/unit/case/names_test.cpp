#include "uplift/case/build/names.h"

#include <gtest/gtest.h>

#include "text_support.h"

namespace uplift::names_test {
namespace {

TEST(Names, NumberedNamesStandBetweenGivenOnesAndAreFoundByTheirNumbers) {
  Names nodes("node");
  EXPECT_EQ(nodes.add("top", Where{"case.toml", 3}, ""), 0);
  nodes.add_numbered(
      "mesh.", 4, [](int i) { return i < 2 ? i + 1 : i + 5; }, Where{"case.toml", 7}, "mesh");  // 1, 2, 7, 8
  nodes.also("corner", 3);
  EXPECT_EQ(nodes.add("bed", Where{"case.toml", 9}, ""), 5);
  EXPECT_EQ(nodes.size(), 6);
  for (const auto& [index, name] : {std::pair(0, "top"), {1, "mesh.1"}, {2, "mesh.2"}, {3, "mesh.7"}, {4, "mesh.8"}, {5, "bed"}}) {
    EXPECT_EQ(nodes[index], name);
    EXPECT_EQ(nodes.find(name, {}, ""), index);
  }
  EXPECT_EQ(nodes.find("corner", {}, ""), 3);
  for (const char* absent : {"mesh.3", "mesh.07", "mesh.", "mesh.7 ", "mesh.7.0", "mesh.99999999999", "mesh"})
    EXPECT_FALSE(nodes.has(absent)) << absent;
}

TEST(Names, NumberedNamesAreRefusedWhereTheyAreUsedTwice) {
  Names nodes("node");
  nodes.add("mesh.2", Where{"case.toml", 3}, "");
  const auto number = [](int i) { return i + 1; };
  EXPECT_NE(support::refusal_of([&] {
              nodes.add_numbered("mesh.", 3, number, Where{"case.toml", 7}, "mesh");
            }).find("\"mesh.2\", which line 3 uses already"),
            std::string::npos);
  Names others("node");
  others.add_numbered("mesh.", 3, number, Where{"case.toml", 7}, "mesh");
  EXPECT_NE(support::refusal_of([&] {
              others.add("mesh.3", Where{"case.toml", 9}, "");
            }).find("\"mesh.3\", which line 7 uses already"),
            std::string::npos);
  EXPECT_NE(support::refusal_of([&] { others.find("mesh.4", {}, ""); }).find("mesh."), std::string::npos);  // names the nearest one
}

}  // namespace
}  // namespace uplift::names_test
