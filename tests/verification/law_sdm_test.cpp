#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "data_support.h"
#include "unit/laws/laws_support.h"
#include "verification/manual.h"

// The SDM interface law, docs/theory, eqs (2) to (8). Reference values are computed here by bisection and quadrature in
// extended precision, beside published figures.
namespace uplift::law_sdm_test {
using namespace law_test;
namespace {

constexpr double K = 1e9, F_u = 1e5, G_f = 100, F_c = -5e5;

std::shared_ptr<const InterfaceLaw> sdm(double closure = F_c) {
  return make_law("sdm", {{"K_n", K}, {"F_u", F_u}, {"G_f", G_f}, {"F_c", closure}});
}

/// Jump at monotonic opening d: the root of K (d - j) = F_u exp(-F_u j/G_f), by bisection.
long double jump_at(long double d) {
  if (K * d <= F_u) return 0;
  long double low = 0, high = d;
  for (int i = 0; i < 200; ++i) {
    const long double j = (low + high) / 2;
    (K * (d - j) > F_u * std::exp(-F_u * j / static_cast<long double>(G_f)) ? low : high) = j;
  }
  return (low + high) / 2;
}
long double envelope(long double d) {
  return K * (d - jump_at(d));
}

double respond(const std::shared_ptr<const InterfaceLaw>& law, double to, double jump) {
  Probe one(law, 1);
  one.memory = {jump};
  return one.respond({0}, {to})[0];
}

TEST(SdmVerification, EnvelopeMatchesTheRootFoundByBisection) {
  VERIFIES(
      {"SDM law", "Softening branch", "docs/theory, eqs (2), (3) and (6), root by bisection in extended precision; published figures"});
  const std::vector<std::pair<double, double>> document{
      {5e-4, 64707.539543672}, {1e-3, 38221.2417467994}, {2e-3, 13720.494730453}, {3e-3, 5003.68112781450}};
  for (const auto& [d, t] : document) {
    VERIFY_NEAR("traction at published openings, root by bisection", "Pa", respond(sdm(), d, 0), static_cast<double>(envelope(d)),
                1e-12 * t);
    VERIFY_NEAR("traction at published openings, published figures", "Pa", respond(sdm(), d, 0), t, 1e-11 * t)
        << "published figure, given to 15 digits";
  }
  for (double d = 1.01e-4; d < 0.02; d *= 1.07)
    VERIFY_NEAR("traction along the softening branch", "Pa", respond(sdm(), d, 0), static_cast<double>(envelope(d)), 1e-12 * F_u) << d;
}

TEST(SdmVerification, NothingOverflowsAtHugeOpenings) {
  VERIFIES({"SDM law", "Huge openings", "docs/theory, eq (8): the work to full separation is G_f"});
  for (const double d : {1.0, 1e3, 1e10, 1e100}) {
    Probe one(sdm(), 1);
    VERIFY_NEAR("traction", "Pa", one.respond({0}, {d})[0], 0, 1e-300);
    VERIFY_EQ("memory", "m", one.now[0], d);
    EXPECT_TRUE(std::isfinite(one.slope[0]));
    VERIFY_NEAR("work", "J/m2", one.mean({0}, {d})[0] * d, G_f, 1e-12 * G_f);
  }
}

TEST(SdmVerification, ClosureBranch) {
  VERIFIES({"SDM law", "Closing branch", "docs/theory, eq (5); published figures"});
  const double j = 2e-3;
  const std::vector<std::pair<double, double>> document{{1e-3, -200000}, {0, -400000}, {-5e-4, -500000}, {-8e-4, -800000}};
  for (const auto& [d, t] : document) VERIFY_NEAR("traction", "Pa", respond(sdm(), d, j), t, 1e-12 * std::abs(t)) << d;
}

TEST(SdmVerification, SlopesAtOnsetAndInTheClosure) {
  VERIFIES({"SDM law", "Slopes at the onset of softening and in closing", "docs/theory, eqs (5) and (6)"});
  Probe one(sdm(), 1);
  one.respond({0}, {1e-4 * (1 + 1e-12)});
  VERIFY_NEAR("slope at the onset", "Pa/m", one.slope[0], -K * F_u * F_u / G_f / (K - F_u * F_u / G_f), 1e-9 * K);  // -1.111e8
  VERIFY_NEAR("slope at the onset, published figure", "Pa/m", one.slope[0], -1.11111111e8, 1e0);
  one.memory = {2e-3};
  one.respond({0}, {0});
  VERIFY_NEAR("slope in closing", "Pa/m", one.slope[0], 2e8, 1e-4);
}

TEST(SdmVerification, DissipationOfAJump) {
  VERIFIES({"SDM law", "Dissipated energy", "docs/theory, eq (8); published figures"});
  Probe one(sdm(), 1);
  for (const auto& [j, energy] :
       std::vector<std::pair<double, double>>{{5e-4, 39.346934028737}, {1e-3, 63.212055882856}, {3e-3, 95.021293163214}}) {
    VERIFY_NEAR("dissipated energy, published figures", "J/m2", one.dissipated({0}, {j}), energy, 1e-12 * 100);
    VERIFY_NEAR("dissipated energy, closed form", "J/m2", one.dissipated({0}, {j}), G_f * (1 - std::exp(-F_u * j / G_f)), 1e-13 * G_f);
  }
}

TEST(SdmVerification, TableOfTheory) {
  VERIFIES({"SDM law", "Opening, closing and reopening", "docs/theory, eqs (2) to (6), evaluated independently"});
  struct Row {
    double d, t, j;
  };
  const std::vector<Row> rows{{5e-5, 5e4, 0},
                              {1e-3, 3.8221241747e4, 9.6177875825e-4},
                              {9.5e-4, -2.3994730288e2, 9.6177875825e-4},
                              {5e-4, -9.4069820593e3, 9.6177875825e-4},
                              {-1e-5, -1.9796288117e4, 9.6177875825e-4},
                              {-1e-4, -1e5, 9.6177875825e-4},
                              {2e-3, 1.3720494730e4, 1.9862795053e-3}};
  Probe one(sdm(-2e4), 1);
  double from = 0;
  for (const Row& row : rows) {
    VERIFY_NEAR("traction", "Pa", one.respond({from}, {row.d})[0], row.t, 1e-10 * std::abs(row.t));
    one.accept();
    VERIFY_NEAR("displacement jump", "m", one.memory[0], row.j, 1e-10 * row.j);
    from = row.d;
  }
}

struct CsvRow {
  double d, t, j, dissipated;
};

std::vector<CsvRow> cyclic_path() {
  std::ifstream file(support::data_file("reference/sdm_cyclic_path.csv"));
  std::vector<CsvRow> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    CsvRow row{};
    if (words >> row.d >> row.t >> row.j >> row.dissipated) rows.push_back(row);
  }
  return rows;
}

TEST(SdmVerification, CyclicPathOfTheReferenceInAnyNumberOfSubsteps) {
  VERIFIES({"SDM law", "Cyclic path in any number of substeps", "tests/data/reference/sdm_cyclic_path.csv"});
  const auto rows = cyclic_path();
  ASSERT_EQ(rows.size(), 23u);
  for (const int substeps : {1, 1000}) {
    Probe one(sdm(), 1), averaged(sdm(), 1);
    double from = 0;
    for (const CsvRow& row : rows) {
      double traction = 0, last = from;
      for (int s = 1; s <= substeps; ++s) {
        const double to = s == substeps ? row.d : from + (row.d - from) * s / substeps;
        traction = one.respond({last}, {to})[0];
        one.accept();
        averaged.mean({last}, {to});
        averaged.accept();
        last = to;
      }
      const double size = std::max(std::abs(row.t), F_u);
      VERIFY_NEAR("traction at the end of a leg", "Pa", traction, row.t, 1e-12 * size) << row.d << " in " << substeps;
      VERIFY_NEAR("traction at the end of a leg, path-averaged steps", "Pa", averaged.end[0], row.t, 1e-12 * size)
          << row.d << " in " << substeps;
      VERIFY_NEAR("displacement jump", "m", one.memory[0], row.j, 1e-12 * std::max(row.j, 1e-4));
      VERIFY_NEAR("displacement jump, path-averaged steps", "m", averaged.memory[0], row.j, 1e-12 * std::max(row.j, 1e-4));
      VERIFY_NEAR("dissipated energy", "J/m2", one.dissipated({row.d}, one.memory), row.dissipated, 1e-12 * G_f);
      from = row.d;
    }
  }
}

TEST(SdmVerification, SubstepsDoNotChangeTheWorkOfALeg) {
  VERIFIES(
      {"SDM law", "The work of a path does not depend on its substeps", "docs/theory, eq (11): the path average is the exact integral"});
  for (const auto& [from, to] : std::vector<std::pair<double, double>>{{0, 2e-3}, {-1e-3, 3e-3}, {5e-4, -2e-3}}) {
    Probe whole(sdm(), 1), parts(sdm(), 1);
    whole.memory = parts.memory = {from > 0 ? 7e-4 : 2e-4};
    const double once = whole.go({from}, {to});
    double sum = 0;
    for (int s = 0; s < 1000; ++s) sum += parts.go({from + (to - from) * s / 1000}, {s == 999 ? to : from + (to - from) * (s + 1) / 1000});
    VERIFY_NEAR("work in 1000 substeps (reference: in one)", "J/m2", sum, once, 1e-12 * G_f);
  }
}

TEST(SdmVerification, LoopsBelowTheEnvelopeDoNoWork) {
  VERIFIES({"SDM law", "Closed loops below the envelope do no work", "docs/theory, eq (7): at fixed jump the law has a potential"});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-2e-3, 1.0e-3);
  Probe one(sdm(), 1);
  one.memory = {1e-3};
  double from = 0, sum = 0, size = 0;
  for (int step = 0; step < 500; ++step) {
    const double to = step == 499 ? 0 : place(random);
    const double work = one.go({from}, {to});
    sum += work;
    size = std::max(size, std::abs(work));
    from = to;
  }
  VERIFY_EQ("memory", "m", one.memory[0], 1e-3);
  VERIFY_NEAR("work of a closed loop", "J/m2", sum, 0, 1e-12 * size);
}

TEST(SdmVerification, SlopesAreDerivatives) {
  VERIFIES({"SDM law", "Slopes are derivatives", "Finite differences of fourth order"});
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-1e-3, 3e-3);
  int checked_points = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Probe one(sdm(), 1);
    one.memory = {trial % 3 == 0 ? 0 : 4e-4};
    const double from = std::min(place(random), one.memory[0]), to = place(random), h = 1e-8;
    // away from the kinks, where a difference quotient means nothing
    const double yield = one.memory[0] + F_u / K * std::exp(-F_u * one.memory[0] / G_f);
    if (std::min({std::abs(to - yield), std::abs(to - one.memory[0]), std::abs(to - F_c / K), std::abs(to - from)}) < 1e-6) continue;
    ++checked_points;
    const auto quotient = [&](auto question) {  // four-point formula
      const auto at = [&](double x) { return (one.*question)({from}, {x})[0]; };
      return (8 * (at(to + h) - at(to - h)) - (at(to + 2 * h) - at(to - 2 * h))) / (12 * h);
    };
    double difference = quotient(&Probe::respond);
    one.respond({from}, {to});
    VERIFY_NEAR("slope of the traction", "Pa/m", one.slope[0], difference, 1e-6 * K);
    difference = quotient(&Probe::mean);
    one.mean({from}, {to});
    VERIFY_NEAR("slope of the path average", "Pa/m", one.slope[0], difference, 1e-6 * K);
  }
  VERIFY_GT("number of random paths", "1", checked_points, 1500);
}

TEST(SdmVerification, PathAverageIsTheQuadratureOfTheLaw) {
  VERIFIES({"SDM law", "Path average", "Adaptive quadrature of the traction along the path, docs/theory, eq (11)"});
  std::mt19937 random(13);
  std::uniform_real_distribution<double> place(-1.5e-3, 3e-3);
  for (int trial = 0; trial < 200; ++trial) {
    Probe one(sdm(), 1);
    one.memory = {trial % 2 == 0 ? 0 : 4e-4};
    const double from = std::min(place(random), one.memory[0]), to = place(random);
    const double exact = integral([&](double x) { return one.respond({from}, {x})[0]; }, from, to, 1e-12 * K * 1e-6) / (to - from);
    const double size = std::max(std::abs(one.respond({from}, {to})[0]), F_u);
    VERIFY_NEAR("path average", "Pa", one.mean({from}, {to})[0], exact, 1e-10 * size) << from << " to " << to;
  }
}

TEST(SdmVerification, PathAverageOfTinyStepsLosesNoDigits) {
  VERIFIES({"SDM law", "Path average of tiny steps", "docs/theory, eqs (5), (6) and (11): limits of small steps"});
  // On the softening branch, in the closure, and across the kink at d = j: the average lies between the end values, the slope is half the
  // tangent.
  Probe one(sdm(), 1);
  for (const double start : {1.5e-4, 1e-3, 4e-3}) {
    for (double length = 1e-5; length > 1e-17; length /= 7) {
      Probe soft(sdm(), 1);
      soft.respond({0}, {start});
      soft.accept();
      const double to = start + length, t0 = static_cast<double>(envelope(start)), t1 = static_cast<double>(envelope(to));
      if (to == start) continue;
      soft.mean({start}, {to});
      VERIFY_LE("path average, upper bound", "Pa", soft.traction[0], t0 * (1 + 4e-13));
      VERIFY_GE("path average, lower bound", "Pa", soft.traction[0], t1 * (1 - 4e-13));
      const double a = F_u / G_f, tangent = -K * a * t1 / (K - a * t1);
      VERIFY_NEAR("slope on the softening branch", "Pa/m", soft.slope[0], 0.5 * tangent, std::abs(tangent) * (1e-5 + 2e3 * length))
          << start << " " << length;
    }
  }
  for (double length = 1e-5; length > 1e-21; length /= 7) {
    one.memory = {1e-3};
    one.mean({2e-4}, {2e-4 - length});
    VERIFY_NEAR("slope in closing", "Pa/m", one.slope[0], 0.5 * K / (1 + K * 1e-3 / -F_c), 1e-12 * K);
    one.mean({1e-3}, {1e-3 + length});
    VERIFY_NEAR("slope in reopening", "Pa/m", one.slope[0], 0.5 * K, 1e-12 * K);
  }
}

TEST(SdmVerification, LedgerClosesOverTenThousandSteps) {
  VERIFIES({"SDM law", "Energy balance over ten thousand steps", "docs/theory, eqs (7), (8) and (12)"});
  // Rocking with growing amplitude and noise: closure, re-opening and softening many times, steps from 1e-12 to 1e-3 m.
  std::mt19937 random(17);
  std::uniform_real_distribution<double> noise(-1, 1);
  for (const double closure : {-2e4, -5e5, -1.0}) {
    Probe one(sdm(closure), 1);
    double from = 0, work = 0;
    for (int step = 1; step <= 10000; ++step) {
      const double amplitude = 4e-3 * step / 10000;
      const double to = step % 10 == 3 ? from + 1e-12 * noise(random) : amplitude * std::sin(0.37 * step) + 1e-4 * noise(random);
      work += one.go({from}, {to});
      from = to;
    }
    const auto [stored, dissipated] = one.energy({from}, one.memory);
    VERIFY_GT("dissipated energy (the path softens)", "J/m2", dissipated, 90);
    VERIFY_NEAR("work (reference: stored and dissipated energy)", "J/m2", work, stored + dissipated, 1e-10 * G_f) << "F_c = " << closure;
  }
}

TEST(SdmVerification, WorkToFullSeparationIsTheCrackingEnergy) {
  VERIFIES({"SDM law", "Work to full separation", "docs/theory, eq (8): G_f"});
  for (const double strength : {1.0, 1e4, 3e5}) {
    const auto law = make_law("sdm", {{"K_n", K}, {"F_u", strength}, {"G_f", G_f}, {"F_c", F_c}});
    Probe one(law, 1);
    VERIFY_NEAR("work", "J/m2", one.go({0}, {1e3 * G_f / strength}), G_f, 1e-12 * G_f);
  }
}

}  // namespace
}  // namespace uplift::law_sdm_test
