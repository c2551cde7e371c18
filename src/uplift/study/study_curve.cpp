#include "uplift/study/study_curve.h"

#include <algorithm>

namespace uplift {

StudyCurve::StudyCurve(const StudyCase& study, std::size_t number, std::size_t sample, std::size_t motion)
    : study_(study), number_(number), sample_(sample), motion_(motion) {
  const StudyMethod& method = study.plan.method;
  if (!method.searches()) {
    const double unit = method.type == StudyMethod::Type::cloud ? study.motions[motion].intensity : 1;
    for (const double level : method.levels) missing_.push_back(point(level * unit));
    return;
  }
  SearchPlan plan = method.search;
  plan.most *= static_cast<int>(study.plan.limits.size());  // every search is told the runs of all
  searches_.assign(study.plan.limits.size(), CapacitySearch(plan));
}

StudyPoint StudyCurve::point(double intensity) const {
  const double factor = intensity / study_.motions[motion_].intensity;
  return {number_, intensity, factor, run_identity(study_, sample_, motion_, factor)};
}

bool StudyCurve::take(const StudyPoint& point, const FindResult& find) {
  const StudyResult* result = find(point.id);
  if (result == nullptr) return false;
  runs_.insert_or_assign(point.intensity, Run{point, result});
  for (std::size_t k = 0; k < searches_.size(); ++k) searches_[k].tell(point.intensity, outcome_of(study_.plan.limits[k], *result));
  return true;
}

/// One limit after the other; every run counts for all of them.
std::optional<double> StudyCurve::next() const {
  for (const CapacitySearch& search : searches_)
    if (const std::optional<double> intensity = search.next()) return intensity;
  return std::nullopt;
}

std::vector<StudyPoint> StudyCurve::wanted(const FindResult& find) {
  std::vector<StudyPoint> missing;
  const StudyMethod& method = study_.plan.method;
  if (method.searches()) {
    std::optional<double> intensity;
    while ((intensity = next())) {
      const StudyPoint now = point(*intensity);
      if (take(now, find)) continue;
      missing.push_back(now);
      break;
    }
  } else {
    std::erase_if(missing_, [&](const StudyPoint& now) { return take(now, find); });
    missing = missing_;
  }
  complete_ = missing.empty();
  return missing;
}

std::size_t StudyCurve::expected() const {
  constexpr std::size_t of_search = 8;
  if (complete_) return runs_.size();
  return searches_.empty() ? study_.plan.method.levels.size() : std::max(of_search, runs_.size() + 1);
}

std::vector<StudyCurve> study_curves(const StudyCase& study) {
  std::vector<StudyCurve> curves;
  const std::size_t samples = study.samples.size(), motions = study.motions.size();
  if (study.plan.crossed) {
    for (std::size_t s = 0; s < samples; ++s)
      for (std::size_t m = 0; m < motions; ++m) curves.emplace_back(study, curves.size(), s, m);
  } else {
    for (std::size_t i = 0; i < std::max(samples, motions); ++i) curves.emplace_back(study, i, i % samples, i % motions);
  }
  return curves;
}

}  // namespace uplift
