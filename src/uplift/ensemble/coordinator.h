#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "uplift/ensemble/store.h"
#include "uplift/ensemble/study.h"

namespace uplift {

/// A share of a study: curves number - 1, number - 1 + of, ...
struct Shard {
  std::size_t number = 1, of = 1;
  bool has(std::size_t curve) const { return curve % of == number - 1; }
};

/// How far a study is.
struct StudyStatus {
  std::size_t curves = 0, complete = 0;  // of the shard; complete: nothing more is wanted of them
  std::size_t runs = 0;                  // with a result
  std::size_t expected = 0;              // in all: of searches by the mean of the complete curves
  std::array<std::size_t, std::size(study_outcomes)> outcomes{};
  std::size_t computed = 0;            // by this command
  std::size_t in_progress = 0;         // runs that workers compute now
  double marched = 0;                  // how much of these is done, in runs
  double seconds = 0;                  // s of this command
  double rate() const;                 // runs a second of this command; 0: not known yet
  std::optional<double> left() const;  // s, by that rate
};
StudyStatus status_of(const std::vector<StudyCurve>& curves, const Shard& shard);

struct StudyRunControl {
  int workers = 1;
  Shard shard;
  std::function<bool()> stopped;                   // asked now and then: the command ends in order
  std::function<void(const StudyStatus&)> follow;  // told now and then
};

/// Computes what is missing. Every result that was told is on the disk. Throws OutputError when it cannot be written.
StudyStatus run_study(const Study& study, StudyStore& store, const StudyRunControl& control);

/// Brings all curves to the results that there are.
std::vector<StudyCurve> curves_with_results(const Study& study, const StudyStore& store);

}  // namespace uplift
