// What is done with a spectrum as a curve: frequencies, values between them, envelopes, broadening.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "uplift/motion/spectrum.h"

namespace uplift {

namespace {

/// The broadened curve: every point of the raw one is spread over [f (1 - share), f (1 + share)], so that at f it is the largest raw value
/// within [f/(1 + share), f/(1 - share)]: peaks become flat tops and sides move in parallel (in logarithms), as Regulatory Guide 1.122
/// (position C.1) draws it.
class Broadening {
 public:
  Broadening(const Spectrum& raw, double share) : raw_(raw), share_(share) {}

  /// Where it may have corners: the raw frequencies and their two images.
  std::vector<double> knots() const {
    std::vector<double> all = raw_.frequencies;
    for (const double f : raw_.frequencies)
      for (const double image : {f * (1 - share_), f * (1 + share_)})
        if (image > raw_.frequencies.front() && image < raw_.frequencies.back()) all.push_back(image);
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  double left(double f) const { return value_at(raw_, f / (1 + share_)); }
  double right(double f) const { return value_at(raw_, f / (1 - share_)); }
  /// Largest raw value at the points within the window of f; 0 when there is none, then one end is the largest.
  double inside(double f) const {
    const auto from = std::ranges::lower_bound(raw_.frequencies, f / (1 + share_));
    const auto to = std::ranges::upper_bound(raw_.frequencies, f / (1 - share_));
    double largest = 0;
    for (auto i = from; i != to; ++i) largest = std::max(largest, raw_.values[static_cast<std::size_t>(i - raw_.frequencies.begin())]);
    return largest;
  }
  double value(double f) const { return std::max({left(f), right(f), inside(f)}); }

  /// Between two neighbouring knots the two ends of the window and the largest point inside are straight lines in logarithms; where they
  /// cross is a corner too.
  void add_crossings(double from, double to, std::vector<double>& frequencies) const {
    const double middle = std::sqrt(from * to), flat = inside(middle);
    const std::pair<double, double> lines[] = {{left(from), left(to)}, {right(from), right(to)}, {flat, flat}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < i; ++j) {
        const auto [a0, a1] = lines[i];
        const auto [b0, b1] = lines[j];
        if (!(a0 > 0 && a1 > 0 && b0 > 0 && b1 > 0)) continue;
        const double d0 = std::log(a0 / b0), d1 = std::log(a1 / b1);
        if (d0 * d1 >= 0) continue;
        frequencies.push_back(from * std::pow(to / from, d0 / (d0 - d1)));
      }
  }

 private:
  const Spectrum& raw_;
  double share_;
};

/// Whether the middle one of three points lies on the line of the others, in logarithms, to round-off.
bool straight(const Spectrum& s, std::size_t a, std::size_t b, std::size_t c) {
  if (!(s.values[a] > 0 && s.values[c] > 0)) return s.values[a] == s.values[b] && s.values[b] == s.values[c];
  const double t = std::log(s.frequencies[b] / s.frequencies[a]) / std::log(s.frequencies[c] / s.frequencies[a]);
  return std::abs(s.values[b] - s.values[a] * std::pow(s.values[c] / s.values[a], t)) < 1e-12 * s.values[b];
}

}  // namespace

std::vector<double> rg_1_122_frequencies() {
  // range ends and steps of the table, in hundredths of a hertz
  constexpr int table[][2] = {{300, 10}, {360, 15}, {500, 20}, {800, 25}, {1500, 50}, {1800, 100}, {2200, 200}, {3400, 300}};
  int f = 20;
  std::vector<double> frequencies{f / 100.0};
  for (const auto& [end, step] : table)
    while (f < end) frequencies.push_back((f += step) / 100.0);
  return frequencies;
}

std::vector<double> log_spaced(double from, double to, int count) {
  assert(from > 0 && to > from && count >= 2);
  std::vector<double> frequencies;
  for (int i = 0; i < count; ++i) frequencies.push_back(from * std::pow(to / from, static_cast<double>(i) / (count - 1)));
  frequencies.back() = to;
  return frequencies;
}

double value_at(const Spectrum& s, double frequency) {
  assert(!s.values.empty() && s.values.size() == s.frequencies.size());
  const auto next = static_cast<std::size_t>(std::ranges::upper_bound(s.frequencies, frequency) - s.frequencies.begin());
  if (next == 0) return s.values.front();
  if (next == s.values.size()) return s.values.back();
  const double a = s.values[next - 1], b = s.values[next];
  const double t = std::log(frequency / s.frequencies[next - 1]) / std::log(s.frequencies[next] / s.frequencies[next - 1]);
  return a > 0 && b > 0 ? a * std::pow(b / a, t) : std::lerp(a, b, t);
}

Spectrum envelope(std::span<const Spectrum> spectra) {
  assert(!spectra.empty());
  Spectrum largest = spectra.front();
  for (const Spectrum& s : spectra) {
    assert(s.frequencies == largest.frequencies);
    for (std::size_t i = 0; i < s.values.size(); ++i) largest.values[i] = std::max(largest.values[i], s.values[i]);
  }
  return largest;
}

Spectrum broadened(const Spectrum& raw, double share) {
  assert(share >= 0 && share < 1);
  const Broadening curve(raw, share);
  const std::vector<double> knots = curve.knots();
  std::vector<double> frequencies = knots;
  for (std::size_t i = 1; i < knots.size(); ++i) curve.add_crossings(knots[i - 1], knots[i], frequencies);
  std::ranges::sort(frequencies);
  Spectrum all{raw.kind, raw.damping, std::move(frequencies), {}};
  for (const double f : all.frequencies) all.values.push_back(curve.value(f));

  Spectrum result{raw.kind, raw.damping, {}, {}};
  std::size_t last = 0;
  for (std::size_t i = 0; i < all.values.size(); ++i) {
    const bool own = std::ranges::binary_search(raw.frequencies, all.frequencies[i]);
    if (!own && straight(all, last, i, i + 1)) continue;  // the first and the last frequency are the raw curve's own
    result.frequencies.push_back(all.frequencies[i]);
    result.values.push_back(all.values[i]);
    last = i;
  }
  return result;
}

}  // namespace uplift
