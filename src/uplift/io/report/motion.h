#pragma once
#include <optional>
#include <string>
#include <vector>

#include "uplift/io/results/summary.h"
#include "uplift/motion/generate.h"
#include "uplift/motion/spectrum.h"

// The report of `uplift motion`: motions without a model, on the page of the other reports.
namespace uplift {

/// A motion as it was read or generated, and as it is after the processing.
struct ShownMotion {
  Motion first, now;               // the same without processing
  std::optional<SpectrumFit> fit;  // of a generated motion, as it is now
};

struct MotionReport {
  Provenance from;
  std::vector<ShownMotion> motions;  // one at least
  std::vector<double> dampings;      // of the response spectra; one at least
  std::vector<double> frequencies;   // of the response spectra [Hz], ascending; two at least
  // of two motions that go together, with the first damping (PSA), and their names; see with_rotated()
  std::optional<RotatedSpectra> rotated = {};
  std::string rotated_names = {};
};
/// The same with the spectra over all directions of two motions with equal steps and lengths: of the only two there are, or of the only two
/// with an azimuth when these are at right angles.
MotionReport with_rotated(MotionReport report);

/// Correlation coefficient of two motions; none when their steps or lengths differ.
std::optional<double> correlation_of(const Motion& first, const Motion& second);

/// The data of the page, see report_page().
std::string motion_report_json(const MotionReport& report);
/// spectra.csv: frequencies and, of every motion and damping, PSA, SA, SV and SD; RotD50 and RotD100 where they are.
std::string motion_spectra_csv(const MotionReport& report);
/// summary.json: provenance, `motions` (as in the summary of a run), `intensities`, `fits` and `correlations`.
std::string motion_summary_json(const MotionReport& report);
/// Its JSON Schema.
std::string motion_summary_schema();

}  // namespace uplift
