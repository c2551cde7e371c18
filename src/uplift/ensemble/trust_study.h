#pragma once
#include <functional>
#include <string>

#include "uplift/ensemble/store.h"
#include "uplift/study/trust.h"

namespace uplift {

struct TrustStudyControl {
  int workers = 1;
  std::function<bool()> stopped;                                  // asked now and then: the command ends in order
  std::function<void(std::size_t done, std::size_t all)> follow;  // told now and then
};

/// Computes the repetitions of `uplift trust` as those of a study: in forked workers, with parts in a folder. What has a result in `store`
/// is not computed again, unless its process ended or lacked memory. Of a repetition that failed the folder keeps the case and, where the
/// failure has one, the interface problem. Throws OutputError, and what a sample throws.
TrustResults compute_trust_study(const TrustSamples& samples, const std::string& folder, StudyStore& store,
                                 const TrustStudyControl& control);

}  // namespace uplift
