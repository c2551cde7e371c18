#pragma once
#include <span>

#include "uplift/statistics/fragility.h"
#include "uplift/statistics/refused.h"

// Errors of fits whose runs share motions and samples: (N14), (N15) of docs/theory/fragility.md.
namespace uplift {

/// A run of stripes or of a cloud, its outcome known.
struct SharedRun {
  double im = 0;                // > 0
  bool exceeded = false;        // of stripes
  double demand = 0;            // of a cloud, > 0
  bool censored = false;        // of a cloud: the demand is a lower bound
  long motion = 0, sample = 0;  // from 0 on
  bool at_most = false;         // of a cloud: the demand is an upper bound
};

/// Standard error of ln theta where the runs of one motion, and those of one sample, depend on each other.
struct SharedError {
  double se_log_theta = 0;
  double freedom = 1;  // degrees of freedom, after Satterthwaite
  /// Of theta, with the confidence `level`, 0 < level < 1.
  ConfidenceInterval theta_interval(double theta, double level) const;
};
/// Of the fit of stripes to these runs, and of that of a cloud for the limit `limit` of the demand. Refused where no motion and no
/// sample has several runs, and with less than two motions.
OrRefused<SharedError> shared_error_of_stripes(const Fragility& fit, std::span<const SharedRun> runs);
OrRefused<SharedError> shared_error_of_cloud(const CloudFit& fit, double limit, std::span<const SharedRun> runs);

}  // namespace uplift
