#pragma once
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "unit/laws/laws_support.h"

// Random numbers and random parts of a catalog: their parameters are drawn from their own declarations, so that a new part is tested before
// its author writes a test.
namespace uplift::random_parts {

/// An integer from a to b - 1, evenly distributed whatever rapidcheck's size is (it would begin with small ones), and not shrunk: a failure
/// prints the part and the seed, and a path of many numbers takes minutes to shrink.
inline int integer_in(int a, int b) {
  return *rc::gen::noShrink(rc::gen::resize(rc::kNominalSize, rc::gen::inRange(a, b)));
}
inline double unit() {
  return integer_in(0, 1000001) / 1e6;
}
inline double between(double a, double b) {
  return a + (b - a) * unit();
}
inline double magnitude(double a, double b) {
  return std::exp(between(std::log(a), std::log(b)));
}
inline bool one_in(int n) {
  return integer_in(0, n) == 0;
}

using law_test::Parameter;

/// Parameters within their bounds; `usual` gives the size of a quantity by its unit.
inline std::vector<Parameter> random_parameters(const PartInfo& part, double (*usual)(std::string_view unit)) {
  std::vector<Parameter> parameters;
  for (const Field& field : part.params) {
    if (!field.required && one_in(2)) continue;
    const std::string name(field.name);
    if (field.kind == Kind::choice)
      parameters.emplace_back(name,
                              std::string(field.choices[static_cast<std::size_t>(integer_in(0, static_cast<int>(field.choices.size())))]));
    if (field.kind != Kind::number) continue;
    const bool zero = field.least == 0 && !field.least_excluded && one_in(5);
    const double value = field.most <= 0 ? -usual(field.unit) : usual(field.unit);
    parameters.emplace_back(name, zero ? 0.0 : std::clamp(value, field.least, field.most));
  }
  return parameters;
}

/// What `make` makes of random parameters; sets that the part itself refuses are drawn again.
template <class Made>
Made random_part(const PartInfo& part, double (*usual)(std::string_view unit),
                 const std::function<Made(const std::vector<Parameter>&)>& make) {
  for (int trial = 0; trial < 1000; ++trial) {
    try {
      return make(random_parameters(part, usual));
    } catch (const InputError&) {
    }
  }
  throw std::runtime_error("no random parameters suit " + std::string(part.name));
}

inline std::string shown(const PartInfo& part, const std::vector<Parameter>& parameters) {
  std::string text(part.name);
  for (const auto& [key, value] : parameters)
    text +=
        " " + key + "=" + (std::holds_alternative<double>(value) ? std::to_string(std::get<double>(value)) : std::get<std::string>(value));
  return text;
}

}  // namespace uplift::random_parts
