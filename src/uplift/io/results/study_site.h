#pragma once
#include <string_view>

#include "uplift/io/results/result_writer.h"
#include "uplift/study/study_fit.h"

// What a study says of its site, in study.json.
namespace uplift {

inline constexpr std::string_view intensity_unit = "as stated in intensity.unit";

/// An interval as the object `key`, with its limits in `unit`.
void write_interval(ResultWriter& out, std::string_view key, const ConfidenceInterval& interval, std::string_view unit,
                    std::string_view meaning);

/// Design motion and hazard curve.
void write_site(ResultWriter& out, const StudySite& site);
/// Factors of safety.
void write_factors(ResultWriter& out, const StudySite& site);
/// Capacity with its scatters and the factors of safety.
void write_capacity(ResultWriter& out, const StudyLimitFit& fit);
/// ASCE/SEI 43: probabilities at the design motion and at 1.5 times it.
void write_performance(ResultWriter& out, const StudySite& site, const StudyLimitFit& fit);
/// The annual rate with which a limit is exceeded.
void write_risk(ResultWriter& out, const StudySite& site, const StudyLimitFit& fit);

}  // namespace uplift
