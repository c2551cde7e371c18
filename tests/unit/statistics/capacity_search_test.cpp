#include "uplift/statistics/capacity_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "uplift/statistics/random.h"

namespace uplift::capacity_search_test {
namespace {

using Structure = std::function<RunOutcome(double im)>;

Structure with_capacity(double capacity) {
  return [capacity](double im) { return im >= capacity ? RunOutcome::exceeded : RunOutcome::survived; };
}

/// Runs the search to its end.
CapacitySearch searched(const SearchPlan& plan, const Structure& structure) {
  CapacitySearch search(plan);
  while (const auto im = search.next()) {
    EXPECT_EQ(search.results().count(*im), 0) << "repeated";
    EXPECT_GE(*im, plan.smallest);
    EXPECT_LE(*im, plan.largest);
    search.tell(*im, structure(*im));
    if (search.results().size() > 100) {
      ADD_FAILURE() << "the search does not end";
      break;
    }
  }
  return search;
}

/// Within 2 % above the capacity in at most eight runs, when the start is wrong by less than 1.37^3.
TEST(CapacitySearch, EightRunsForTwoPercent) {
  for (double error = -0.94; error < 0.94; error += 0.001) {
    const double capacity = 0.8 * std::exp(error);
    const CapacitySearch search = searched({.start = 0.8, .smallest = 1e-3, .largest = 100}, with_capacity(capacity));
    const auto found = search.capacity(Unknown::left_out);
    ASSERT_TRUE(found && search.found());
    EXPECT_EQ(found->known, Known::exact);
    EXPECT_GE(found->im, capacity);
    EXPECT_LE(found->im, 1.02 * capacity);
    EXPECT_LE(search.results().size(), 8) << error;
    EXPECT_TRUE(search.resurrections().empty());
  }
}

/// A start from capacities of records before: their geometric mean.
double mean_of(const std::vector<RecordCapacity>& before) {
  double sum = 0;
  for (const RecordCapacity& c : before) sum += std::log(c.im);
  return std::exp(sum / static_cast<double>(before.size()));
}

/// An incremental dynamic analysis of 200 records with known lognormal capacities, each search starting from the records before it.
TEST(CapacitySearch, StudyOfKnownCapacities) {
  const CounterRandom random(4);
  std::vector<RecordCapacity> exact, found;
  std::size_t runs = 0, within_eight = 0;
  for (int record = 0; record < 200; ++record) {
    const double capacity = 0.3 * std::exp(0.4 * random.normal(record, 0));
    const double start = found.empty() ? 1 : mean_of(found);
    const CapacitySearch search = searched({.start = start, .smallest = 1e-3, .largest = 100}, with_capacity(capacity));
    exact.push_back({capacity});
    found.push_back(*search.capacity(Unknown::left_out));
    runs += search.results().size();
    within_eight += search.results().size() <= 8;
  }
  EXPECT_LE(static_cast<double>(runs) / 200, 7.5);
  EXPECT_GE(within_eight, 190);
  const auto of_exact = std::get<Fragility>(fit_capacities(exact)), of_found = std::get<Fragility>(fit_capacities(found));
  EXPECT_GE(of_found.theta(), of_exact.theta());
  EXPECT_LE(of_found.theta(), 1.02 * of_exact.theta());
  EXPECT_NEAR(of_found.beta(), of_exact.beta(), 0.01);
}

TEST(CapacitySearch, FarStartsArriveToo) {
  for (const double capacity : {2e-6, 1e-3, 0.5, 77.0, 9e5}) {
    const CapacitySearch search = searched({.start = 1, .smallest = 1e-6, .largest = 1e6}, with_capacity(capacity));
    EXPECT_NEAR(search.capacity(Unknown::left_out)->im / capacity, 1.01, 0.0101);
    EXPECT_LE(search.results().size(), 20);
  }
}

TEST(CapacitySearch, CensoredAtTheEndsOfTheRange) {
  const SearchPlan plan{.start = 1, .smallest = 0.1, .largest = 10};
  const CapacitySearch strong = searched(plan, with_capacity(11)), weak = searched(plan, with_capacity(0.05));
  EXPECT_TRUE(strong.found() && weak.found());
  EXPECT_EQ(strong.capacity(Unknown::left_out)->known, Known::at_least);
  EXPECT_EQ(strong.capacity(Unknown::left_out)->im, 10);
  EXPECT_EQ(weak.capacity(Unknown::left_out)->known, Known::at_most);
  EXPECT_EQ(weak.capacity(Unknown::left_out)->im, 0.1);
  EXPECT_FALSE(CapacitySearch(plan).capacity(Unknown::survived));
  EXPECT_FALSE(CapacitySearch(plan).found());
  const CapacitySearch only({.start = 2, .smallest = 2, .largest = 2});
  EXPECT_EQ(only.next(), 2);
}

TEST(CapacitySearch, FillsTheLargestGapsBelowTheCapacity) {
  const CapacitySearch search = searched({.start = 1, .smallest = 1e-3, .largest = 100, .fill = 20}, with_capacity(1.5));
  EXPECT_EQ(search.results().size(), 20);
  double before = 0, largest = 0;
  for (const auto& [im, outcome] : search.results()) {
    if (im <= search.capacity(Unknown::left_out)->im) largest = std::max(largest, im - before);
    before = im;
  }
  EXPECT_LE(largest, 1.0 / 8 + 1e-12);  // the first gap, from 0 to 1, has been halved three times everywhere
}

/// Told in any order, partly or in full, the same results give the same state.
TEST(CapacitySearch, TheOrderOfTheResultsDoesNotMatter) {
  std::mt19937 random(9);
  const Structure structure = [](double im) {
    return im > 0.55 && im < 0.62 ? RunOutcome::unknown : im > 0.4 && im < 0.5 ? RunOutcome::exceeded : with_capacity(0.9)(im);
  };
  const SearchPlan plan{.start = 1.7, .smallest = 0.01, .largest = 10, .fill = 25};
  const CapacitySearch straight = searched(plan, structure);
  std::vector<std::pair<double, RunOutcome>> results(straight.results().begin(), straight.results().end());
  for (int repetition = 0; repetition < 50; ++repetition) {
    std::shuffle(results.begin(), results.end(), random);
    CapacitySearch replayed(plan);
    for (std::size_t i = 0; i < results.size(); ++i) {
      replayed.tell(results[i].first, results[i].second);
      CapacitySearch again(plan);
      for (std::size_t j = i + 1; j-- > 0;) again.tell(results[j].first, results[j].second);
      EXPECT_EQ(replayed.next(), again.next());
    }
    EXPECT_EQ(replayed.results(), straight.results());
    EXPECT_EQ(replayed.next(), straight.next());
    EXPECT_EQ(replayed.resurrections(), straight.resurrections());
  }
}

TEST(CapacitySearch, ResurrectionsAreReported) {
  const Structure structure = [](double im) { return im > 0.5 && im < 0.9 ? RunOutcome::exceeded : with_capacity(1.2)(im); };
  const CapacitySearch search = searched({.start = 1, .smallest = 0.01, .largest = 10, .fill = 16}, structure);
  EXPECT_NEAR(search.capacity(Unknown::left_out)->im, 0.505, 0.006);  // the first exceedance
  EXPECT_TRUE(search.found());
  ASSERT_FALSE(search.resurrections().empty());
  for (const double im : search.resurrections()) EXPECT_EQ(structure(im), RunOutcome::survived);
}

/// Runs that end without an outcome never end the search in a loop; the two ends enclose the capacity.
TEST(CapacitySearch, GoesAroundRunsWithoutOutcome) {
  for (double low = 0.1; low < 2; low *= 1.03)
    for (const double width : {1.005, 1.1, 1.5, 4.0}) {
      const Structure structure = [=](double im) { return im > low && im < width * low ? RunOutcome::unknown : with_capacity(0.7)(im); };
      const CapacitySearch search = searched({.start = 0.6, .smallest = 0.01, .largest = 10}, structure);
      const auto survived = search.capacity(Unknown::survived), exceeded = search.capacity(Unknown::exceeded);
      ASSERT_TRUE(survived && exceeded);
      EXPECT_LE(exceeded->im, 0.7 * 1.02);
      EXPECT_GE(survived->im, 0.7);
      EXPECT_LE(exceeded->im, survived->im);
      EXPECT_LE(search.results().size(), 30);
    }
  const CapacitySearch nothing = searched({.start = 1, .smallest = 0.01, .largest = 10}, [](double) { return RunOutcome::unknown; });
  EXPECT_FALSE(nothing.found());
  EXPECT_FALSE(nothing.capacity(Unknown::left_out));
  EXPECT_EQ(nothing.capacity(Unknown::survived)->known, Known::at_least);
  EXPECT_EQ(nothing.capacity(Unknown::exceeded)->known, Known::at_most);
}

TEST(CapacitySearch, KnownOutcomesReplaceUnknownOnes) {
  for (const bool unknown_first : {true, false}) {
    CapacitySearch search({.start = 1, .smallest = 0.1, .largest = 10});
    search.tell(1, unknown_first ? RunOutcome::unknown : RunOutcome::survived);
    search.tell(1, unknown_first ? RunOutcome::survived : RunOutcome::unknown);
    EXPECT_EQ(search.results().at(1), RunOutcome::survived);
    search.tell(1, RunOutcome::exceeded);
    search.tell(1, RunOutcome::survived);
    EXPECT_EQ(search.results().at(1), RunOutcome::exceeded);
  }
}

}  // namespace
}  // namespace uplift::capacity_search_test
