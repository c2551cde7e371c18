#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "uplift/study/study_case.h"
#include "uplift/study/study_run.h"

namespace uplift {

/// One run that a study wants.
struct StudyPoint {
  std::size_t curve = 0;
  double intensity = 0, factor = 1;
  std::string id;
};

/// Results of runs by their identity; null: there is none yet.
using FindResult = std::function<const StudyResult*(const std::string& id)>;

/// All runs of one motion with one sample. What is run next depends on the plan and the results alone, not on their order.
class StudyCurve {
 public:
  StudyCurve(const StudyCase& study, std::size_t number, std::size_t sample, std::size_t motion);
  std::size_t sample() const { return sample_; }
  std::size_t motion() const { return motion_; }
  /// Takes the results that there are now, and says which runs are wanted next: one of a search, all of stripes and clouds.
  std::vector<StudyPoint> wanted(const FindResult& find);
  /// Runs in all, as far as that is known.
  std::size_t expected() const;
  /// Nothing is wanted any more.
  bool complete() const { return complete_; }
  struct Run {
    StudyPoint point;
    const StudyResult* result;
  };
  /// With their results, by intensity.
  const std::map<double, Run>& runs() const { return runs_; }
  /// Of a method that searches: one for each limit.
  const std::vector<CapacitySearch>& searches() const { return searches_; }

 private:
  StudyPoint point(double intensity) const;
  bool take(const StudyPoint& point, const FindResult& find);
  std::optional<double> next() const;
  const StudyCase& study_;
  std::size_t number_, sample_, motion_;
  std::vector<CapacitySearch> searches_;
  std::vector<StudyPoint> missing_;  // of a method that does not search: without results
  std::map<double, Run> runs_;
  bool complete_ = false;
};

/// All curves of a study: sample by sample.
std::vector<StudyCurve> study_curves(const StudyCase& study);

}  // namespace uplift
