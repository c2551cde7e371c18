#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "uplift/laws/law.h"

// What tests of interface laws share: laws from parameters, one interface with memory, quadrature.
namespace uplift::law_test {

using Parameter = std::pair<std::string, std::variant<double, std::string>>;

/// The checked parameters of a law or cone, as if read from line 7 of "case.toml".
inline Values checked(const std::string& type, const std::vector<Parameter>& parameters) {
  const Where where{"case.toml", 7};
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{type, where, "law.type"});
  for (const auto& [key, value] : parameters) {
    Raw raw{{}, where, "law." + key};
    if (const double* number = std::get_if<double>(&value))
      raw.data = *number;
    else
      raw.data = std::get<std::string>(value);
    table->entries.emplace_back(key, raw);
  }
  return check_part(Raw{table, where, "law"}, interface_behaviours());
}

inline std::shared_ptr<const InterfaceLaw> make_law(const std::string& type, const std::vector<Parameter>& parameters) {
  return make_part(law_catalog(), checked(type, parameters));
}

/// A law at the points of one interface, with its memory. Openings are given per row, as in a Batch.
class Probe {
 public:
  Probe(std::shared_ptr<const InterfaceLaw> law, int components, int points = 1, double step = 0)
      : batch{points, components, step}, law_(std::move(law)) {
    memory.assign(static_cast<std::size_t>(points * law_->num_history(components)), 0.0);
    const auto rows = static_cast<std::size_t>(points * components);
    traction.assign(rows, 0.0);
    end.assign(rows, 0.0);
    slope.assign(rows * static_cast<std::size_t>(components), 0.0);
    now = memory;
  }

  using Opening = std::vector<double>;

  /// Path average; memory is left alone, what it becomes is in `now`.
  const std::vector<double>& mean(const Opening& from, const Opening& to) {
    soil();
    law_->mean(batch, from.data(), to.data(), memory.data(), {traction.data(), slope.data(), now.data(), end.data()});
    return traction;
  }
  const std::vector<double>& respond(const Opening& from, const Opening& to) {
    soil();
    law_->respond(batch, from.data(), to.data(), memory.data(), {traction.data(), slope.data(), now.data(), nullptr});
    return traction;
  }
  void accept() { memory = now; }

  /// Path-averaged step that is kept; returns the work per area of all points [J/m2].
  double go(const Opening& from, const Opening& to) {
    mean(from, to);
    accept();
    return work(from, to);
  }
  double work(const Opening& from, const Opening& to) const {
    double sum = 0;
    for (std::size_t i = 0; i < from.size(); ++i) sum += traction[i] * (to[i] - from[i]);
    return sum;
  }

  double stored(const Opening& opening, const std::vector<double>& history) const { return energy(opening, history).first; }
  double dissipated(const Opening& opening, const std::vector<double>& history) const { return energy(opening, history).second; }
  /// Sum over the points of what is stored and of what was dissipated [J/m2].
  std::pair<double, double> energy(const Opening& opening, const std::vector<double>& history) const {
    const auto n = static_cast<std::size_t>(batch.points);
    std::vector<double> kept(n), lost(n);
    law_->energy(batch, opening.data(), history.data(), kept.data(), lost.data());
    double a = 0, b = 0;
    for (std::size_t i = 0; i < n; ++i) a += kept[i], b += lost[i];
    return {a, b};
  }
  double slope_at(int row, int column, int point = 0) const {
    return slope[static_cast<std::size_t>((row * batch.components + column) * batch.points + point)];
  }
  const InterfaceLaw& law() const { return *law_; }

  Batch batch;

 private:
  /// A law must write every entry.
  void soil() {
    std::fill(traction.begin(), traction.end(), 1e99);
    std::fill(slope.begin(), slope.end(), 1e99);
    std::fill(now.begin(), now.end(), 1e99);
    std::fill(end.begin(), end.end(), 1e99);
  }
  std::shared_ptr<const InterfaceLaw> law_;

 public:
  std::vector<double> memory, now, traction, slope, end;
};

/// Integral of f from a to b: adaptive Simpson, to `tolerance` on the whole.
inline double integral(const std::function<double(double)>& f, double a, double b, double tolerance, int depth = 50) {
  const std::function<double(double, double, double, double, double, double, double, int)> part =
      [&](double x0, double f0, double x2, double f2, double f1, double whole, double bound, int left) -> double {
    const double x1 = 0.5 * (x0 + x2), fa = f(0.5 * (x0 + x1)), fb = f(0.5 * (x1 + x2));
    const double first = (x1 - x0) / 6 * (f0 + 4 * fa + f1), second = (x2 - x1) / 6 * (f1 + 4 * fb + f2);
    const double change = first + second - whole;
    if (left == 0 || std::abs(change) <= 15 * bound) return first + second + change / 15;
    return part(x0, f0, x1, f1, fa, first, 0.5 * bound, left - 1) + part(x1, f1, x2, f2, fb, second, 0.5 * bound, left - 1);
  };
  // Eight pieces first, so that a kink cannot hide between the first samples.
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const double x0 = a + (b - a) * i / 8, x2 = a + (b - a) * (i + 1) / 8, f0 = f(x0), f1 = f(0.5 * (x0 + x2)), f2 = f(x2);
    sum += part(x0, f0, x2, f2, f1, (x2 - x0) / 6 * (f0 + 4 * f1 + f2), tolerance / 8, depth);
  }
  return sum;
}

}  // namespace uplift::law_test
