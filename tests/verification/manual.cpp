#include "manual.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

namespace uplift::verification {
namespace {

constexpr const char* names[] = {"near", "less", "greater", "at_most", "at_least", "equal"};

bool holds(Comparison comparison, double measured, double reference, double tolerance) {
  switch (comparison) {
    case Comparison::near:
      return std::abs(measured - reference) <= tolerance;
    case Comparison::less:
      return measured < reference;
    case Comparison::greater:
      return measured > reference;
    case Comparison::at_most:
      return measured <= reference;
    case Comparison::at_least:
      return measured >= reference;
    case Comparison::equal:
      return measured == reference;
  }
  return false;
}

/// How far a comparison is beyond its tolerance (below 0: within), as a share of the tolerance or of the limit; what fails comes first.
double beyond(Comparison comparison, double measured, double reference, double tolerance) {
  if (!holds(comparison, measured, reference, tolerance)) return INFINITY;
  if (comparison == Comparison::near) return tolerance > 0 ? std::abs(measured - reference) / tolerance - 1 : 0;
  const double scale = std::max(std::abs(reference), 1e-300);
  if (comparison == Comparison::less || comparison == Comparison::at_most) return (measured - reference) / scale;
  return (reference - measured) / scale;
}

nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

}  // namespace

testing::AssertionResult ManualCase::compare(Comparison comparison, const std::string& quantity, const char* unit, double measured,
                                             double reference, double tolerance) {
  const double distance = beyond(comparison, measured, reference, tolerance);
  const auto same =
      std::find_if(rows_.begin(), rows_.end(), [&](const Row& row) { return row.quantity == quantity && row.comparison == comparison; });
  if (same == rows_.end())
    rows_.push_back({quantity, unit, comparison, measured, reference, tolerance, distance, 1});
  else if (++same->count; distance > same->distance)
    *same = {quantity, unit, comparison, measured, reference, tolerance, distance, same->count};
  if (holds(comparison, measured, reference, tolerance)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << quantity << " [" << unit << "]: measured " << testing::PrintToString(measured) << ", expected "
                                     << names[static_cast<int>(comparison)] << " " << testing::PrintToString(reference) << " (tolerance "
                                     << tolerance << ")";
}

ManualCase::~ManualCase() {
  const char* folder = std::getenv("UPLIFT_VERIFICATION_RECORD");
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  if (folder == nullptr || test == nullptr) return;
  nlohmann::json record{{"suite", test->test_suite_name()},
                        {"name", test->name()},
                        {"requirement", description_.requirement.text},
                        {"title", description_.title.text},
                        {"source", description_.source.text},
                        {"passed", !testing::Test::HasFailure()},
                        {"rows", nlohmann::json::array()}};
  for (const Row& row : rows_)
    record["rows"].push_back({{"quantity", row.quantity},
                              {"unit", row.unit},
                              {"comparison", names[static_cast<int>(row.comparison)]},
                              {"measured", number(row.measured)},
                              {"reference", number(row.reference)},
                              {"tolerance", row.tolerance},
                              {"count", row.count}});
  for (const Curve& curve : curves_) record["curves"].push_back({{"label", curve.label}, {"size", curve.size}, {"error", curve.error}});
  std::string file = std::string(test->test_suite_name()) + "." + test->name();
  std::replace(file.begin(), file.end(), '/', '.');
  std::ofstream(std::string(folder) + "/" + file + ".json") << record.dump(1) << "\n";
}

}  // namespace uplift::verification
