#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "unit/base/declaration_sample.h"
#include "uplift/base/units.h"
#include "uplift/case/schema/sections.h"

// The declarations themselves, that of the whole case file with all its parts among them: what the type system does not check.
namespace uplift::declarations_test {
namespace {

class Inspector {
 public:
  std::vector<std::string> faults;
  int fields = 0;

  void section(const std::string& path, const Section& inspected) {
    if (inspected.meaning.empty()) fault(path, "a table without meaning");
    all(path, inspected.fields);
  }

 private:
  void fault(const std::string& path, const std::string& what) { faults.push_back(path + ": " + what); }

  void all(const std::string& path, const std::vector<Field>& list) {
    std::set<std::string_view> names;
    for (const Field& field : list) {
      const std::string inner = path + "." + std::string(field.name);
      if (!names.insert(field.name).second) fault(inner, "declared twice");
      one(inner, field);
    }
  }

  void one(const std::string& path, const Field& field) {
    ++fields;
    if (field.name.empty() || field.meaning.empty()) fault(path, "no name or no meaning");
    if (field.kind == Kind::number || field.kind == Kind::numbers) {
      if (!std::isfinite(udunits_factor(field.unit, field.unit)))
        fault(path, "unit that UDUNITS does not know: " + std::string(field.unit));
      if (field.unit != "1" && dimension_name(field.unit) == "a number")
        fault(path, "unit without a name in messages: " + std::string(field.unit));
    }
    if (field.least > field.most) fault(path, "empty range");
    if (const auto& standard = field.standard_number) {
      const bool inside = *standard >= field.least && *standard <= field.most && !(field.least_excluded && *standard == field.least) &&
                          !(field.most_excluded && *standard == field.most);
      if (!inside) fault(path, "default outside its range");
      if (field.kind == Kind::integer && *standard != std::floor(*standard)) fault(path, "default that is no integer");
    }
    const auto has_standard = [&field](const auto& words) {
      return !field.standard_text || std::find(words.begin(), words.end(), *field.standard_text) != words.end();
    };
    if (field.kind == Kind::choice && !has_standard(field.choices)) fault(path, "default that is no choice");
    if (field.kind == Kind::number && !has_standard(field.words)) fault(path, "default that is no word");
    if (field.kind == Kind::part) parts(path, field);
    if (field.section) section(path, *field.section);
  }

  void parts(const std::string& path, const Field& field) {
    bool standard = !field.standard_text;
    std::set<std::string_view> names;
    if (field.parts().empty()) fault(path, "an empty catalog");
    for (const PartInfo* info : field.parts()) {
      const std::string inner = path + "." + std::string(info->name);
      if (!names.insert(info->name).second) fault(inner, "two parts of this name");
      if (info->summary.empty()) fault(inner, "no summary");
      all(inner, info->params);
      for (const Field& parameter : info->params)
        if (parameter.name == "type") fault(inner, "a parameter called type");
      if (field.standard_text && info->name == *field.standard_text) {
        standard = true;
        for (const Field& parameter : info->params)
          if (parameter.required) fault(inner, "a default part that needs parameters");
      }
    }
    if (!standard) fault(path, "default that is no part");
  }
};

TEST(Declarations, TheCaseFileIsSound) {
  Inspector inspector;
  inspector.section("case", case_section());
  EXPECT_GT(inspector.fields, 100);
  for (const std::string& fault : inspector.faults) ADD_FAILURE() << fault;
}

TEST(Declarations, TheInspectorFindsFaults) {
  Inspector sample;
  sample.section("sample", sample_section());
  EXPECT_TRUE(sample.faults.empty());
  const Section bad{"bad",
                    "bad",
                    {number("a", "Pa", "x").positive().standard(0.0), number("a", "wibble", "x"), choice("c", {"d"}, "x").standard("e"),
                     integer("i", "x").standard(0.5), part("p", sample_methods, "x").standard("penalty"), number("m", "1", "")}};
  Inspector inspector;
  inspector.section("bad", bad);
  EXPECT_EQ(inspector.faults,
            (std::vector<std::string>{"bad.a: default outside its range", "bad.a: declared twice",
                                      "bad.a: unit that UDUNITS does not know: wibble", "bad.a: unit without a name in messages: wibble",
                                      "bad.c: default that is no choice", "bad.i: default that is no integer",
                                      "bad.p.penalty: a default part that needs parameters", "bad.m: no name or no meaning"}));
}

}  // namespace
}  // namespace uplift::declarations_test
