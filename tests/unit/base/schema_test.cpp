#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "unit/base/declaration_sample.h"
#include "uplift/base/file.h"

namespace uplift::schema_test {
namespace {

using Json = nlohmann::json;

const Json& schema() {
  static const Json parsed = Json::parse(to_json_schema(sample_section()));
  return parsed;
}

TEST(Schema, SaysWhatTheDeclarationSays) {
  EXPECT_EQ(schema()["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema()["title"], "sample");
  EXPECT_EQ(schema()["additionalProperties"], false);
  EXPECT_EQ(schema()["required"], Json::array({"title"}));
  const Json& all = schema()["properties"];
  EXPECT_EQ(all.size(), sample_section().fields.size());
  EXPECT_EQ(all["count"],
            Json::parse(R"({"type": "integer", "minimum": 1, "maximum": 10, "default": 7, "description": "a count, from 1 to 10"})"));
  EXPECT_EQ(all["on"]["default"], false);
  EXPECT_EQ(all["rule"]["enum"], Json::array({"nodal", "midpoint", "gauss"}));
  EXPECT_EQ(all["rule"]["default"], "nodal");
  const Json& beam = all["beam"]["items"];
  EXPECT_EQ(beam["required"], Json::array({"E"}));
  EXPECT_EQ(beam["additionalProperties"], false);
  EXPECT_EQ(beam["properties"]["E"]["type"], Json::array({"number", "string"}));
  EXPECT_EQ(beam["properties"]["E"]["exclusiveMinimum"], 0);
  EXPECT_EQ(beam["properties"]["E"]["description"], "Young's modulus [Pa], > 0 Pa");
  EXPECT_EQ(all["damping"]["properties"]["slope"]["exclusiveMaximum"], 0);
  const Json& method = all["method"]["oneOf"];
  ASSERT_EQ(method.size(), 3u);
  EXPECT_EQ(method[0]["enum"], Json::array({"lagrange"}));  // penalty needs its stiffness
  EXPECT_EQ(method[2]["properties"]["type"]["const"], "penalty");
  EXPECT_EQ(method[2]["required"], Json::array({"type", "stiffness"}));
  EXPECT_EQ(all["gravity"]["minItems"], 2);
  EXPECT_EQ(all["gravity"]["maxItems"], 2);
}

TEST(Schema, IsTheSameEveryTime) {
  EXPECT_EQ(to_json_schema(sample_section()), to_json_schema(sample_section()));
}

// Claim: the schema is valid draft 2020-12 and accepts and refuses what the program does. Judge: python3-jsonschema.
TEST(Schema, AnIndependentValidatorAgrees) {
  ASSERT_EQ(std::system("python3 -c 'import jsonschema' > /dev/null 2>&1"), 0)
      << "python3-jsonschema is not installed: scripts/setup.sh test";
  const Json good = Json::array({
      Json::parse(R"({"title": "t"})"),
      Json::parse(
          R"({"title": "t", "gravity": [0, "-9.81 m/s2"], "nodes": {"a": ["0 m", 1], "b": {"value": [0, 1]}}, "method": "lagrange"})"),
      Json::parse(
          R"({"title": "t", "method": {"type": "penalty", "stiffness": "2 MPa/m"}, "beam": [{"E": 1, "stiffness": "rigid"}, {"E": "1 MPa"}]})"),
      Json::parse(R"({"title": "t", "limits": {}, "damping": {"slope": -1, "pair": [{"factor": 1}]}})"),
  });
  const Json bad = Json::array({
      Json::parse(R"({})"),
      Json::parse(R"({"title": 3})"),
      Json::parse(R"({"title": "t", "unknown": 1})"),
      Json::parse(R"({"title": "t", "count": 11})"),
      Json::parse(R"({"title": "t", "count": 2.5})"),
      Json::parse(R"({"title": "t", "rule": "simpson"})"),
      Json::parse(R"({"title": "t", "gravity": [0]})"),
      Json::parse(R"({"title": "t", "method": "penalty"})"),
      Json::parse(R"({"title": "t", "method": {"type": "penalty"}})"),
      Json::parse(R"({"title": "t", "method": {"type": "lagrange", "rounds": 1}})"),
      Json::parse(R"({"title": "t", "beam": [{"E": 0}]})"),
      Json::parse(R"({"title": "t", "beam": [{"E": "rigid"}]})"),
      Json::parse(R"({"title": "t", "beam": {"E": 1}})"),
      Json::parse(R"({"title": "t", "nodes": {"a": 3}})"),
  });
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("uplift-schema-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  write_file_atomically(folder / "all.json", Json{{"schema", schema()}, {"good", good}, {"bad", bad}}.dump());
  write_file_atomically(folder / "judge.py",
                        "import json, sys\n"
                        "from jsonschema import Draft202012Validator as Validator\n"
                        "a = json.load(open(sys.argv[1]))\n"
                        "Validator.check_schema(a['schema'])\n"
                        "v = Validator(a['schema'])\n"
                        "wrong = [c for c in a['good'] if not v.is_valid(c)] + [c for c in a['bad'] if v.is_valid(c)]\n"
                        "print(*wrong, sep='\\n')\n"
                        "sys.exit(len(wrong))\n");
  const std::string command = "python3 '" + (folder / "judge.py").string() + "' '" + (folder / "all.json").string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace uplift::schema_test
