#include "uplift/laws/external.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

// An interface law whose formulas are outside this library: a function of the program that uses it (C, C++ or Python).
namespace uplift {
namespace {

class ExternalLaw final : public InterfaceLaw {
 public:
  ExternalLaw(ExternalLawInfo info, ExternalFunction function) : info_(std::move(info)), function_(std::move(function)) {}

  int num_history(int) const override { return info_.memory; }

  void respond(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const override {
    Answer end(*this, batch, from, to, old);
    end.give(response.traction, response.slope);
    if (response.now != nullptr) std::ranges::copy(end.memory, response.now);
  }

  void mean(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const override {
    const std::size_t n = static_cast<std::size_t>(batch.points), rows = n * static_cast<std::size_t>(batch.components);
    std::vector<double> middle(rows);
    for (std::size_t i = 0; i < rows; ++i) middle[i] = 0.5 * (from[i] + to[i]);
    const Answer begin(*this, batch, from, from, old), half(*this, batch, from, middle.data(), old), end(*this, batch, from, to, old);
    for (std::size_t i = 0; i < n; ++i) average(batch, i, from, to, begin, half, end, response);
    if (response.now != nullptr) std::ranges::copy(end.memory, response.now);
    if (response.end != nullptr) std::ranges::copy(end.traction, response.end);
    if (response.next != nullptr) std::ranges::transform(end.slope, response.next, [](double slope) { return 0.5 * slope; });
  }

  void energy(const Batch& batch, const double* opening, const double* history, double* stored, double* dissipated) const override {
    const Answer at(*this, batch, opening, opening, history);
    if (stored != nullptr) std::ranges::copy(at.stored, stored);
    if (dissipated != nullptr) std::ranges::copy(at.dissipated, dissipated);
  }

  void closed_stiffness(int components, double* stiffness) const override {
    std::fill_n(stiffness, components - 1, info_.shear);
    stiffness[components - 1] = info_.stiffness;
  }

 private:
  /// What the function makes of one step.
  struct Answer {
    std::vector<double> traction, slope, memory, stored, dissipated;
    Answer(const ExternalLaw& law, const Batch& batch, const double* from, const double* to, const double* old) {
      const auto n = static_cast<std::size_t>(batch.points), c = static_cast<std::size_t>(batch.components);
      traction.resize(c * n), slope.resize(c * c * n), stored.resize(n), dissipated.resize(n);
      memory.assign(old, old + static_cast<std::size_t>(law.info_.memory) * n);
      if (!law.ended_ && !law.function_({batch.points, batch.components, batch.step, from, to, old, traction.data(), slope.data(),
                                         memory.data(), stored.data(), dissipated.data()}))
        law.ended_ = true;
      if (law.ended_)
        std::ranges::fill(traction, std::numeric_limits<double>::quiet_NaN());  // neither this step nor a shorter one converges
    }
    double energy(std::size_t i) const { return stored[i] + dissipated[i]; }
    void give(double* to_traction, double* to_slope) const {
      std::ranges::copy(traction, to_traction);
      if (to_slope != nullptr) std::ranges::copy(slope, to_slope);
    }
  };

  /// Discrete gradient of one point and its derivative with respect to the end of the path.
  static void average(const Batch& batch, std::size_t i, const double* from, const double* to, const Answer& begin, const Answer& half,
                      const Answer& end, const LawResponse& response) {
    constexpr int most = 3;
    const int c = batch.components;
    const auto n = static_cast<std::size_t>(batch.points);
    const auto row = [&](int r) { return static_cast<std::size_t>(r) * n + i; };
    const auto entry = [&](int r, int s) { return static_cast<std::size_t>(r * c + s) * n + i; };
    double d[most], square = 0, work = 0;
    for (int r = 0; r < c; ++r) {
      d[r] = to[row(r)] - from[row(r)];
      square += d[r] * d[r];
      work += half.traction[row(r)] * d[r];
    }
    // what the work at the midpoint lacks; where that is round-off of the energies the midpoint is exact, as on every straight path
    const double lacking = end.energy(i) - begin.energy(i) - work;
    const double round_off =
        32 * std::numeric_limits<double>::epsilon() * (std::abs(end.energy(i)) + std::abs(begin.energy(i)) + std::abs(work));
    const bool bends = std::abs(lacking) > round_off;
    const double defect = bends ? lacking / square : 0;
    double by_end[most] = {};  // d defect / d to
    if (bends)
      for (int s = 0; s < c; ++s) {
        double midpoint = half.traction[row(s)];
        for (int r = 0; r < c; ++r) midpoint += 0.5 * half.slope[entry(r, s)] * d[r];
        by_end[s] = (end.traction[row(s)] - midpoint - 2 * defect * d[s]) / square;
      }
    for (int r = 0; r < c; ++r) {
      response.traction[row(r)] = half.traction[row(r)] + defect * d[r];
      if (response.slope == nullptr) continue;
      for (int s = 0; s < c; ++s) response.slope[entry(r, s)] = 0.5 * half.slope[entry(r, s)] + d[r] * by_end[s] + (r == s ? defect : 0);
    }
  }

  ExternalLawInfo info_;
  ExternalFunction function_;
  mutable std::atomic<bool> ended_ = false;  // by the function: it is not called again in this run
};

/// Stands for the law until the caller's function is connected: elastic, as stiff as the closed joint.
bool elastic(const ExternalLawInfo& info, const ExternalStep& call) {
  const int n = call.points, c = call.components;
  std::fill_n(call.slope, c * c * n, 0.0);
  std::fill_n(call.stored, n, 0.0);
  std::fill_n(call.dissipated, n, 0.0);
  for (int r = 0; r < c; ++r)
    for (int i = 0; i < n; ++i) {
      const double stiffness = r == c - 1 ? info.stiffness : info.shear, opening = call.to[r * n + i];
      call.traction[r * n + i] = stiffness * opening;
      call.slope[(r * c + r) * n + i] = stiffness;
      call.stored[i] += 0.5 * stiffness * opening * opening;
    }
  return true;
}

}  // namespace

bool is_external(const Values& behaviour) {
  return behaviour.type() == "external";
}

ExternalLawInfo external_info(const Values& values) {
  return {values.text("name"), static_cast<int>(values.integer("memory")), values.number("K_n"), values.number("K_t")};
}

std::unique_ptr<const InterfaceLaw> external_law(const ExternalLawInfo& info, ExternalFunction function) {
  return std::make_unique<ExternalLaw>(info, std::move(function));
}

const Entry<InterfaceLaw>& entry_law_external() {
  static const Entry<InterfaceLaw> entry{
      {.name = "external",
       .summary = "law of the program that uses the library: a function in C, C++ or Python; not available to the command line",
       .equations = "t = f(d, memory); path average: discrete gradient of the stored and dissipated energy",
       .source = "Gonzalez 1996, Time integration and discrete Hamiltonian systems, J. Nonlinear Sci. 6, 449-467",
       .params =
           {text("name", "name under which the function is connected"),
            number("K_n", "Pa/m", "normal stiffness of the closed joint: for the bonded run, the static stages and suggestions").positive(),
            number("K_t", "Pa/m", "shear stiffness of the closed joint").nonnegative().standard(0.0),
            integer("memory", "memory variables of a point").between(0, 1000).standard(0)}},
      [](const Values& values) -> std::unique_ptr<const InterfaceLaw> {
        const ExternalLawInfo info = external_info(values);
        return external_law(info, [info](const ExternalStep& call) { return elastic(info, call); });
      }};
  return entry;
}

}  // namespace uplift
