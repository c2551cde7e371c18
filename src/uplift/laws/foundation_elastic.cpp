#include <algorithm>
#include <array>

#include "uplift/laws/foundation.h"

// Bonded elastic foundation: p = K q in every row. Nothing opens, nothing yields.
namespace uplift {
namespace {

class ElasticFoundation final : public InterfaceLaw {
 public:
  explicit ElasticFoundation(const std::vector<double>& stiffness) { std::ranges::copy(stiffness, stiffness_.begin()); }
  int num_history(int) const override { return 0; }

  void respond(const Batch& batch, const double*, const double* to, const double*, const LawResponse& response) const override {
    answer(batch, 1, to, response);
  }
  void mean(const Batch& batch, const double* from, const double* to, const double*, const LawResponse& response) const override {
    std::array<double, most_components> middle{};
    for (int r = 0; r < batch.components; ++r) middle[static_cast<std::size_t>(r)] = 0.5 * (from[r] + to[r]);
    answer(batch, 0.5, middle.data(), response);
    if (batch.coefficient != nullptr) filter(batch, from, to, response);
    for (int r = 0; response.end != nullptr && r < batch.components; ++r) response.end[r] = stiffness_[static_cast<std::size_t>(r)] * to[r];
    if (response.next != nullptr) put_slope(batch, 0.5, response.next);
  }
  void energy(const Batch& batch, const double* opening, const double*, double* stored, double* dissipated) const override {
    if (dissipated != nullptr) *dissipated = 0;
    if (stored == nullptr) return;
    *stored = 0;
    for (int r = 0; r < batch.components; ++r) *stored += 0.5 * stiffness_[static_cast<std::size_t>(r)] * opening[r] * opening[r];
  }
  void closed_stiffness(int components, double* stiffness) const override { std::copy_n(stiffness_.begin(), components, stiffness); }
  void elastic(int components, const double* opening, const double*, double* elastic, double* slope) const override {
    std::copy_n(opening, components, elastic);
    put_slope({.points = 1, .components = components}, 1, slope);
  }
  LawScales scales() const override { return {.opens = false}; }

 private:
  void put_slope(const Batch& batch, double share, double* slope) const {
    std::fill_n(slope, batch.components * batch.components, 0.0);
    for (int r = 0; r < batch.components; ++r) slope[r * batch.components + r] = share * stiffness_[static_cast<std::size_t>(r)];
  }
  /// Adds the joint filter, C (increment - d_f) with C = b K.
  void filter(const Batch& batch, const double* from, const double* to, const LawResponse& response) const {
    for (int r = 0; r < batch.components; ++r) {
      const double coefficient = batch.gain * stiffness_[static_cast<std::size_t>(r)];
      response.plain[r] = response.traction[r];
      response.traction[r] += coefficient * (to[r] - from[r]) - batch.lag[r];
      if (response.slope != nullptr) response.slope[r * batch.components + r] += coefficient;
    }
  }
  void answer(const Batch& batch, double share, const double* at, const LawResponse& response) const {
    for (int r = 0; r < batch.components; ++r) response.traction[r] = stiffness_[static_cast<std::size_t>(r)] * at[r];
    if (response.slope != nullptr) put_slope(batch, share, response.slope);
  }
  std::array<double, most_components> stiffness_{};  // N/m, N m/rad, in the order of the rows
};

}  // namespace

const FoundationEntry& entry_foundation_elastic() {
  static const FoundationEntry entry{{.name = "elastic",
                                      .summary = "linear springs that hold tension: what a linear analysis assumes",
                                      .equations = "N = K_v w, H = K_h u, M = K_r theta",
                                      .source = "static stiffnesses of rigid foundations: Pais & Kausel, Soil Dynamics and Earthquake "
                                                "Engineering 7 (1988) 213-227; Gazetas (1991)",
                                      .params = foundation_stiffness_fields()},
                                     [](const Footprint& footprint, const Values& values) -> std::unique_ptr<const InterfaceLaw> {
                                       return std::make_unique<ElasticFoundation>(foundation_stiffness(footprint, values));
                                     }};
  return entry;
}

}  // namespace uplift
