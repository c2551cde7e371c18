#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "unit/base/declaration_sample.h"
#include "uplift/base/declare.h"
#include "uplift/io/text/toml.h"

namespace uplift::check_test {
namespace {

Values read(std::string_view text) {
  return check(read_toml_text(text, "case.toml"), sample_section());
}

std::string error_of(std::string_view text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// The smallest complete text: title and one beam.
const std::string least = "title = \"t\"\nbeam = [{nodes = [\"a\", \"b\"], E = 1}]\n";

TEST(Check, ReadsEveryKind) {
  const Values values = read(R"(
title = "all kinds"
count = 3
on = true
rule = "gauss"
gravity = [0, "-9.81 m/s2"]
keys = ["a", "b"]
method = { type = "penalty", stiffness = "2 MPa/m" }

[nodes]
top = ["0 m", "50 cm"]
"base left" = [0, 0.0]

[cases.first]
factor = "5 %"

[cases.second]
factor = 2

[limits]
rotation = "180 deg"

[[beam]]
nodes = ["a", "b"]
E = "20000 MPa"

[[beam]]
nodes = ["b", "c"]
E = 2.5e10
stiffness = "rigid"
)");
  EXPECT_EQ(values.text("title"), "all kinds");
  EXPECT_EQ(values.integer("count"), 3);
  EXPECT_TRUE(values.flag("on"));
  EXPECT_EQ(values.text("rule"), "gauss");
  EXPECT_EQ(values.numbers("gravity"), (std::vector<double>{0, -9.81}));
  EXPECT_EQ(values.texts("keys"), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(values.part("method").type(), "penalty");
  EXPECT_EQ(values.part("method").number("stiffness"), 2e6);
  EXPECT_EQ(values.part("method").integer("rounds"), 10);  // a default inside a part
  ASSERT_EQ(values.tables("nodes").size(), 2u);
  EXPECT_EQ(values.tables("nodes")[0].key(), "top");  // the order of the file
  EXPECT_EQ(values.tables("nodes")[0].numbers("value"), (std::vector<double>{0, 0.5}));
  EXPECT_EQ(values.tables("nodes")[1].key(), "base left");
  EXPECT_EQ(values.tables("cases")[0].number("factor"), 0.05);
  EXPECT_EQ(values.tables("cases")[1].key(), "second");
  EXPECT_DOUBLE_EQ(values.table("limits").number("rotation"), std::acos(-1.0));
  ASSERT_EQ(values.tables("beam").size(), 2u);
  EXPECT_EQ(values.tables("beam")[0].number("E"), 2e10);
  EXPECT_FALSE(values.tables("beam")[0].is_word("stiffness"));
  EXPECT_TRUE(values.tables("beam")[1].is_word("stiffness"));
  EXPECT_EQ(values.tables("beam")[1].text("stiffness"), "rigid");
}

TEST(Check, FillsInDefaults) {
  const Values values = read(least);
  EXPECT_EQ(values.integer("count"), 7);
  EXPECT_FALSE(values.flag("on"));
  EXPECT_EQ(values.text("rule"), "nodal");
  EXPECT_EQ(values.part("method").type(), "lagrange");
  EXPECT_EQ(values.table("limits").number("rotation"), 0.15);  // an absent table takes the defaults of its keys
  EXPECT_EQ(values.tables("beam")[0].number("stiffness"), 5);
  for (const char* key : {"count", "on", "rule", "method", "limits"}) {
    EXPECT_TRUE(values.has(key)) << key;
    EXPECT_FALSE(values.given(key)) << key;
  }
  for (const char* key : {"gravity", "keys", "nodes", "cases", "damping"}) {
    EXPECT_FALSE(values.has(key)) << key;
    EXPECT_FALSE(values.given(key)) << key;
  }
  EXPECT_TRUE(values.numbers("gravity").empty());
  EXPECT_TRUE(values.texts("keys").empty());
  EXPECT_TRUE(values.tables("nodes").empty());
  EXPECT_TRUE(values.given("title"));
}

TEST(Check, KeepsPlacesAndPaths) {
  const Values values = read("title = \"t\"\n\n[[beam]]\nnodes = [\"a\", \"b\"]\n\nE = 1\n[nodes]\ntop = [0, 1]\n");
  EXPECT_EQ(values.where("title").line, 1);
  EXPECT_EQ(values.where("count").line, 0);  // absent: the table, here the whole file
  EXPECT_EQ(values.where().file, "case.toml");
  EXPECT_EQ(values.path(), "");
  EXPECT_EQ(values.path("count"), "count");
  const Values& beam = values.tables("beam")[0];
  EXPECT_EQ(beam.where().line, 3);
  EXPECT_EQ(beam.where("E").line, 6);
  EXPECT_EQ(beam.where("stiffness").line, 3);
  EXPECT_EQ(beam.path("E"), "beam[0].E");
  EXPECT_EQ(values.tables("nodes")[0].where().line, 8);
  EXPECT_EQ(values.tables("nodes")[0].path(), "nodes.top");
}

TEST(Check, APartMayBeABareName) {
  EXPECT_EQ(read("method = \"lagrange\"\n" + least).part("method").type(), "lagrange");
  EXPECT_EQ(error_of("method = \"penalty\"\n" + least),
            "case.toml:1: method.stiffness: expected a pressure per length > 0 Pa/m, found nothing");
}

TEST(Check, UnknownKeys) {
  EXPECT_EQ(error_of("titel = \"t\"\n"), "case.toml:1: titel: expected a key of sample, found \"titel\" (did you mean \"title\"?)");
  EXPECT_EQ(error_of("title = \"t\"\n[limits]\ntemperature = 3\n"),
            "case.toml:3: limits.temperature: expected a key of limits: rotation or tolerance, found \"temperature\"");
  EXPECT_EQ(error_of("method = {type = \"penalty\", stifness = 1}\n"),
            "case.toml:1: method.stifness: expected a key of penalty, found \"stifness\" (did you mean \"stiffness\"?)");
  EXPECT_EQ(error_of("method = {type = \"lagrange\", rounds = 1}\n"),
            "case.toml:1: method.rounds: expected no key, as lagrange has no parameters, found \"rounds\"");
  // keys that stand in another table
  EXPECT_EQ(error_of("title = \"t\"\n[limits]\nmethod = \"lagrange\"\n"),
            "case.toml:3: limits.method: expected a key of limits: rotation or tolerance, found \"method\", a key of sample");
  EXPECT_EQ(error_of("method = {type = \"lagrange\", tolerance = 1}\n"),
            "case.toml:1: method.tolerance: expected no key, as lagrange has no parameters, found \"tolerance\", a key of limits");
}

TEST(Check, MissingKeys) {
  EXPECT_EQ(error_of(""), "case.toml: title: expected a text, found nothing");
  EXPECT_EQ(error_of("title = \"t\"\n\n[[beam]]\nnodes = [\"a\", \"b\"]\n"),
            "case.toml:3: beam[0].E: expected a pressure > 0 Pa, found nothing");
  EXPECT_EQ(error_of("title = \"t\"\n[cases.a]\n"), "case.toml:2: cases.a.factor: expected a number, found nothing");
}

TEST(Check, UnitsAndDimensions) {
  EXPECT_EQ(error_of("title = \"t\"\n[limits]\ntolerance = \"3 Pa\"\n"),
            "case.toml:3: limits.tolerance: expected a length [m], found \"3 Pa\" (a pressure)");
  EXPECT_EQ(error_of("title = \"t\"\n[[beam]]\nnodes=[]\nE = \"3 m\"\n"),
            "case.toml:4: beam[0].E: expected a pressure > 0 Pa, found \"3 m\" (a length)");
  EXPECT_EQ(error_of("title = \"t\"\n[[beam]]\nE = \"3 MPaa\"\n"),
            "case.toml:3: beam[0].E: expected a pressure > 0 Pa, found \"3 MPaa\" (unknown unit \"MPaa\") (did you mean \"MPa\"?)");
  EXPECT_EQ(error_of("gravity = [0, \"1 g\"]\n"),
            "case.toml:1: gravity[1]: expected an acceleration [m/s2], found \"1 g\" (g is the gram; standard gravity is g_n)");
  EXPECT_EQ(error_of("[[beam]]\nE = 1\nstiffness = \"rigit\"\n"),
            "case.toml:3: beam[0].stiffness: expected a number from 0 to 10 or \"rigid\", found \"rigit\" (did you mean \"rigid\"?)");
}

TEST(Check, Bounds) {
  EXPECT_EQ(error_of("[[beam]]\nE = 0\n"), "case.toml:2: beam[0].E: expected a pressure > 0 Pa, found 0 Pa");
  EXPECT_EQ(error_of("[[beam]]\nE = \"-5 MPa\"\n"), "case.toml:2: beam[0].E: expected a pressure > 0 Pa, found \"-5 MPa\" (-5000000 Pa)");
  EXPECT_EQ(error_of("[[beam]]\nstiffness = 10.5\n"),
            "case.toml:2: beam[0].stiffness: expected a number from 0 to 10 or \"rigid\", found 10.5");
  EXPECT_EQ(error_of("count = 0\n"), "case.toml:1: count: expected an integer from 1 to 10, found 0");
  EXPECT_EQ(error_of("count = 11\n"), "case.toml:1: count: expected an integer from 1 to 10, found 11");
  EXPECT_EQ(error_of("[limits]\nrotation = -1\n"), "case.toml:2: limits.rotation: expected an angle >= 0 rad, found -1 rad");
  EXPECT_EQ(read("count = 1\n" + least).integer("count"), 1);
  EXPECT_EQ(read("count = 10\n" + least).integer("count"), 10);
  EXPECT_EQ(error_of("[damping]\nslope = 0\n"), "case.toml:2: damping.slope: expected a number < 0, found 0");
}

TEST(Check, NotANumberAndInfinityAreRefusedEverywhere) {
  EXPECT_EQ(error_of("[[beam]]\nE = nan\n"), "case.toml:2: beam[0].E: expected a pressure > 0 Pa, found nan Pa");
  EXPECT_EQ(error_of("[limits]\ntolerance = inf\n"), "case.toml:2: limits.tolerance: expected a length [m], found inf m");
  EXPECT_EQ(error_of("gravity = [-inf, 0]\n"), "case.toml:1: gravity[0]: expected an acceleration [m/s2], found -inf m/s2");
  EXPECT_EQ(error_of("count = nan\n"), "case.toml:1: count: expected an integer from 1 to 10, found nan");
}

TEST(Check, Integers) {
  EXPECT_EQ(read("count = 4.0\n" + least).integer("count"), 4);
  EXPECT_EQ(error_of("count = 3.5\n"), "case.toml:1: count: expected an integer from 1 to 10, found 3.5");
  EXPECT_EQ(error_of("count = \"3\"\n"), "case.toml:1: count: expected an integer from 1 to 10, found the text \"3\"");
  EXPECT_EQ(error_of("frames = 3000000000\n"), "case.toml:1: frames: expected an integer from -2147483648 to 2147483647, found 3000000000");
  EXPECT_EQ(error_of("frames = 1e300\n"), "case.toml:1: frames: expected an integer from -2147483648 to 2147483647, found 1e+300");
  EXPECT_EQ(read("frames = -2147483648\n" + least).integer("frames"), std::numeric_limits<int>::min());
}

TEST(Check, ChoicesAndParts) {
  EXPECT_EQ(error_of("rule = \"nodel\"\n"),
            "case.toml:1: rule: expected \"nodal\", \"midpoint\" or \"gauss\", found \"nodel\" (did you mean \"nodal\"?)");
  EXPECT_EQ(error_of("rule = \"simpson\"\n"), "case.toml:1: rule: expected \"nodal\", \"midpoint\" or \"gauss\", found \"simpson\"");
  EXPECT_EQ(error_of("method = \"lagrang\"\n"),
            "case.toml:1: method: expected \"lagrange\" or \"penalty\", found \"lagrang\" (did you mean \"lagrange\"?)");
  EXPECT_EQ(error_of("[method]\ntype = \"penality\"\n"),
            "case.toml:2: method.type: expected \"lagrange\" or \"penalty\", found \"penality\" (did you mean \"penalty\"?)");
  EXPECT_EQ(error_of("[method]\nstiffness = 3\n"), "case.toml:1: method.type: expected \"lagrange\" or \"penalty\", found nothing");
  EXPECT_EQ(error_of("[method]\ntype = 3\n"), "case.toml:2: method.type: expected \"lagrange\" or \"penalty\", found 3");
  EXPECT_EQ(error_of("method = 3\n"), "case.toml:1: method: expected \"lagrange\" or \"penalty\", found 3");
}

TEST(Check, TablesThatAreNone) {
  EXPECT_EQ(error_of("[beam]\nE = 1\n"), "case.toml:1: beam: expected tables [[beam]], found a table");
  EXPECT_EQ(error_of("[[limits]]\nrotation = 1\n"), "case.toml:1: limits: expected a table [limits], found a list of tables");
  EXPECT_EQ(error_of("beam = [1]\n"), "case.toml:1: beam[0]: expected a table, found 1");
  EXPECT_EQ(error_of("nodes = 3\n"), "case.toml:1: nodes: expected a table [nodes] of names, found 3");
  EXPECT_EQ(error_of("[cases]\na = 3\n"), "case.toml:2: cases.a: expected a table, found 3");
  EXPECT_EQ(error_of("nodes = {a = 3}\n"), "case.toml:1: nodes.a: expected a list of 2 numbers [m], found 3");
  EXPECT_EQ(error_of("nodes = {a = [1]}\n"), "case.toml:1: nodes.a: expected a list of 2 numbers [m], found 1 number");
  EXPECT_EQ(error_of("gravity = []\n"), "case.toml:1: gravity: expected a list of 2 numbers [m/s2], found an empty list");
  EXPECT_EQ(error_of("gravity = [1, [2]]\n"), "case.toml:1: gravity[1]: expected an acceleration [m/s2], found a list");
  EXPECT_EQ(error_of("keys = \"a\"\n"), "case.toml:1: keys: expected a list of texts, found the text \"a\"");
  EXPECT_EQ(error_of("keys = [\"a\", 2]\n"), "case.toml:1: keys[1]: expected a text, found 2");
  EXPECT_EQ(read("beam = []\ntitle = \"t\"\n").tables("beam").size(), 0u);
  EXPECT_EQ(read("nodes = {a = {value = [1, 2]}}\n" + least).tables("nodes")[0].numbers("value"), (std::vector<double>{1, 2}));
}

// Every key given every kind of value: accepted or an InputError with this line and the path of the key; nothing else.
TEST(Check, WrongTypesEverywhere) {
  const char* values[] = {
      "true",        "3",          "-3",     "2.5",     "nan",  "1e300", "9223372036854775807", "\"\"", "\"text\"", "\"3 m\"",
      "[]",          "[1]",        "[1, 2]", "[\"a\"]", "[[]]", "[{}]",  "[{a = 1}]",           "{}",   "{a = 1}",  "{type = \"lagrange\"}",
      "{type = []}", "{value = 1}"};
  for (const Field& field : sample_section().fields)
    for (const char* value : values) {
      const std::string text = "\n" + std::string(field.name) + " = " + value + "\n";
      try {
        read(text);
      } catch (const InputError& error) {
        EXPECT_TRUE(error.path().starts_with(field.name) || error.path() == "title") << text << error.what();
        EXPECT_EQ(error.where().file, "case.toml");
        EXPECT_TRUE(error.where().line == 2 || error.path() == "title") << text << error.what();
      }
    }
}

TEST(Check, AskingForAnUndeclaredKeyOrAWrongKindIsABug) {
  const Values values = read(least);
#ifdef NDEBUG
  EXPECT_THROW(values.number("nonsense"), std::bad_variant_access);
#else
  EXPECT_DEATH(values.number("nonsense"), "not declared");
#endif
  EXPECT_THROW(values.number("title"), std::bad_variant_access);
  EXPECT_THROW(values.text("count"), std::bad_variant_access);
}

// A tree made by hand (from another format, or for an override) is checked the same way.
TEST(Check, RawWithoutAFile) {
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{std::string("penalty"), {}, "type"});
  table->entries.emplace_back("stiffness", Raw{std::int64_t{-1}, {}, "stiffness"});
  const Raw raw{table, {}, ""};
  try {
    check_part(raw, sample_methods());
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "stiffness: expected a pressure per length > 0 Pa/m, found -1 Pa/m");
  }
  EXPECT_THROW(check(Raw{}, sample_section()), InputError);
}

TEST(Declare, SaysInWordsWhatAFieldTakes) {
  EXPECT_EQ(wanted_text(number("a", "Pa", "")), "a pressure [Pa]");
  EXPECT_EQ(wanted_text(number("a", "kg s3", "")), "a number [kg s3]");
  EXPECT_EQ(wanted_text(number("a", "m", "").between(1, 2)), "a length from 1 to 2 m");
  EXPECT_EQ(wanted_text(number("a", "m", "").negative()), "a length < 0 m");
  EXPECT_EQ(wanted_text(number("a", "1", "").nonnegative().or_word("x").or_word("y")), "a number >= 0 or \"x\" or \"y\"");
  EXPECT_EQ(wanted_text(integer("a", "").positive()), "an integer > 0");
  EXPECT_EQ(wanted_text(flag("a", "")), "true or false");
  EXPECT_EQ(wanted_text(numbers("a", "N", "")), "a list of numbers [N]");
  EXPECT_EQ(wanted_text(numbers("a", "N", "", 1).positive()), "a list of 1 number, each > 0 N");
  EXPECT_EQ(wanted_text(part("a", sample_methods, "")), "\"lagrange\" or \"penalty\"");
  EXPECT_EQ(bounds_text(number("a", "m", "")), "");
  EXPECT_EQ(standard_text(number("a", "m", "").standard(0.1)), "0.1");
  EXPECT_EQ(standard_text(integer("a", "").standard(3)), "3");
  EXPECT_EQ(standard_text(flag("a", "").standard(true)), "true");
  EXPECT_EQ(standard_text(text("a", "").standard("x")), "\"x\"");
  EXPECT_EQ(standard_text(text("a", "").optional()), "");
}

TEST(Declare, ModifiersReplaceEachOther) {
  EXPECT_EQ(bounds_text(number("a", "m", "").positive().between(0, 1)), "from 0 to 1 m");
  EXPECT_EQ(bounds_text(number("a", "m", "").positive().nonnegative()), ">= 0 m");
}

}  // namespace
}  // namespace uplift::check_test
