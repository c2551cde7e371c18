#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

// A case of the verification manual. A test of this folder begins with VERIFIES, which states title, source and requirement, and makes its
// comparisons by the macros below, each of which names the quantity once. They fail as the EXPECT of the same name does. When the
// environment names a folder (UPLIFT_VERIFICATION_RECORD), every case leaves a file there, from which scripts/make_verification.py makes
// the page of the case: a changed tolerance changes the page. Of comparisons of the same quantity the page shows the one nearest to its
// tolerance, and their number.
namespace uplift::verification {

/// Text that must be there: an empty one does not compile.
struct Stated {
  const char* text;
  consteval Stated(const char* stated) : text(stated) {
    if (stated[0] == '\0') throw "a case of the manual states title, source and requirement";
  }
};

struct CaseDescription {
  Stated requirement, title, source;
};

enum class Comparison { near, less, greater, at_most, at_least, equal };

class ManualCase {
 public:
  explicit ManualCase(const CaseDescription& description) : description_(description) {}
  ManualCase(const ManualCase&) = delete;
  ManualCase& operator=(const ManualCase&) = delete;
  ~ManualCase();

  /// near: |measured - reference| <= tolerance; else `reference` is the limit.
  testing::AssertionResult compare(Comparison, const std::string& quantity, const char* unit, double measured, double reference,
                                   double tolerance = 0);

  /// Errors over sizes or steps, for a drawing of the page.
  void curve(const std::string& label, const std::vector<double>& size, const std::vector<double>& error) {
    curves_.push_back({label, size, error});
  }

 private:
  struct Curve {
    std::string label;
    std::vector<double> size, error;
  };
  struct Row {
    std::string quantity;
    const char* unit;
    Comparison comparison;
    double measured, reference, tolerance, distance;  // distance: above 0 the comparison fails
    int count;
  };
  CaseDescription description_;
  std::vector<Row> rows_;
  std::vector<Curve> curves_;
};

}  // namespace uplift::verification

#define VERIFIES(...) ::uplift::verification::ManualCase verified_case(::uplift::verification::CaseDescription __VA_ARGS__)
#define VERIFY_COMPARISON(which, quantity, unit, ...) \
  EXPECT_TRUE(verified_case.compare(::uplift::verification::Comparison::which, quantity, unit, __VA_ARGS__))
#define VERIFY_NEAR(quantity, unit, ...) VERIFY_COMPARISON(near, quantity, unit, __VA_ARGS__)
#define VERIFY_LT(quantity, unit, ...) VERIFY_COMPARISON(less, quantity, unit, __VA_ARGS__)
#define VERIFY_GT(quantity, unit, ...) VERIFY_COMPARISON(greater, quantity, unit, __VA_ARGS__)
#define VERIFY_LE(quantity, unit, ...) VERIFY_COMPARISON(at_most, quantity, unit, __VA_ARGS__)
#define VERIFY_GE(quantity, unit, ...) VERIFY_COMPARISON(at_least, quantity, unit, __VA_ARGS__)
#define VERIFY_EQ(quantity, unit, ...) VERIFY_COMPARISON(equal, quantity, unit, __VA_ARGS__)
