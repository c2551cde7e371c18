#pragma once
#include <optional>
#include <span>
#include <vector>

// Fractiles of the curves of an incremental dynamic analysis: docs/theory/fragility.md.
namespace uplift {

/// The value below which a share (0 to 1) of ascending values lies, straight between them; values at the end may be infinite.
double percentile(std::span<const double> sorted, double share);

/// A run of one motion: its demand at an intensity, both >= 0.
struct IdaPoint {
  double im = 0, demand = 0;
  bool lost = false;  // the structure overturned or separated: every demand is reached, whatever was reached before
};

/// The intensity at which a curve first reaches a demand > 0, straight between its points and from the origin on; infinite where it never
/// does. `curve`: ascending in intensity.
double intensity_at_demand(std::span<const IdaPoint> curve, double demand);

/// For every demand the intensity at which 16, 50 and 84 % of the curves have reached it; nothing where so many never do.
struct IdaFractiles {
  std::vector<double> demands;
  std::vector<std::optional<double>> p16, p50, p84;
};
IdaFractiles ida_fractiles(std::span<const std::vector<IdaPoint>> curves, std::vector<double> demands);

}  // namespace uplift
