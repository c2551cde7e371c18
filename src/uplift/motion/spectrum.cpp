#include "uplift/motion/spectrum.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "uplift/motion/oscillator.h"
#include "uplift/motion/parallel.h"

// Response spectra by the exact step of an oscillator under an acceleration that is straight between its points: N. C. Nigam, P. C.
// Jennings, Calculation of response spectra from strong-motion earthquake records, BSSA 59 (1969).
namespace uplift {

namespace {

constexpr int lanes = 32;
using Lane = double[lanes];

/// Oscillators that march together, with the same number of sub-steps. What is asked of them is y = on_p p + on_q q, and its change per
/// sub-step dy = rate_p p + rate_q q + rate_a a. Every loop over the lanes is one that the compiler turns into vector instructions.
struct Pack {
  alignas(64) Lane pp, pq, p0, p1, qp, qq, q0, q1;
  alignas(64) Lane on_p, on_q, rate_p, rate_q, rate_a;
  alignas(64) Lane p, q, peak;
  alignas(64) Lane y, dy, y1, dy1;  // at the beginning and at the end of a sub-step
  double unit[lanes];               // of y, in SI

  void set(int lane, double frequency, double damping, double sub_step, Spectrum::Kind kind);
  template <Peaks peaks>
  void march(std::span<const double> acceleration, int sub_steps);

 private:
  void advance(double from, double to);
  void look_at_end();
  bool may_peak(double to);
  void look_between();
};

void Pack::set(int lane, double frequency, double damping, double sub_step, Spectrum::Kind kind) {
  const OscillatorStep s = oscillator_step(frequency, damping, sub_step);
  pp[lane] = s.pp, pq[lane] = s.pq, p0[lane] = s.p0, p1[lane] = s.p1;
  qp[lane] = s.qp, qq[lane] = s.qq, q0[lane] = s.q0, q1[lane] = s.q1;
  const double omega = 2 * std::numbers::pi * frequency, tau = omega * sub_step, two = 2 * damping;
  const auto choose = [&](double yp, double yq, double dp, double dq, double da, double si) {
    on_p[lane] = yp, on_q[lane] = yq, rate_p[lane] = tau * dp, rate_q[lane] = tau * dq, rate_a[lane] = tau * da, unit[lane] = si;
  };
  // per sub-step p' = tau q, q' = -tau (p + 2 zeta q + a)
  switch (kind) {
    case Spectrum::Kind::psa:
      return choose(1, 0, 0, 1, 0, 1);
    case Spectrum::Kind::sd:
      return choose(1, 0, 0, 1, 0, 1 / (omega * omega));
    case Spectrum::Kind::sv:
      return choose(0, 1, -1, -two, -1, 1 / omega);
    case Spectrum::Kind::sa:  // x'' + a = -(p + 2 zeta q)
      return choose(1, two, -two, 1 - two * two, -two, 1);
  }
}

inline void Pack::advance(double from, double to) {
  for (int j = 0; j < lanes; ++j) {
    const double next = pp[j] * p[j] + (pq[j] * q[j] + (p0[j] * from + p1[j] * to));
    q[j] = qp[j] * p[j] + (qq[j] * q[j] + (q0[j] * from + q1[j] * to));
    p[j] = next;
  }
}

inline void Pack::look_at_end() {
  for (int j = 0; j < lanes; ++j) peak[j] = std::max(peak[j], std::abs(on_p[j] * p[j] + on_q[j] * q[j]));
}

/// Values and rates at the end of a sub-step; false when no lane can have a new peak there or within: a cubic through values y and rates d
/// is nowhere beyond max |y| + (4/27)(|d0| + |d1|).
inline bool Pack::may_peak(double to) {
  long long hits = 0;
  for (int j = 0; j < lanes; ++j) {
    y1[j] = on_p[j] * p[j] + on_q[j] * q[j];
    dy1[j] = rate_p[j] * p[j] + (rate_q[j] * q[j] + rate_a[j] * to);
    const double bound = std::max(std::abs(y[j]), std::abs(y1[j])) + 4.0 / 27 * (std::abs(dy[j]) + std::abs(dy1[j]));
    hits += bound > peak[j] ? 1 : 0;
  }
  return hits > 0;
}

/// Where the rate changes its sign within a sub-step, y has an extreme: near the place where a straight rate is zero, nearer after one step
/// of Newton on the slope of the cubic through both ends; the cubic is taken there. (An error of the place enters squared.)
inline void Pack::look_between() {
  for (int j = 0; j < lanes; ++j) {
    const double d0 = dy[j], d1 = dy1[j];
    const bool turns = d0 * d1 < 0;
    const double first = d0 / (turns ? d0 - d1 : 1), rise = 6 * (y1[j] - y[j]);
    const double slope = d0 * (1 - first) * (1 - 3 * first) + d1 * first * (3 * first - 2) + rise * first * (1 - first);
    const double bend = d0 * (6 * first - 4) + d1 * (6 * first - 2) + rise * (1 - 2 * first);
    const double nearer = first - slope / (bend == 0 ? 1 : bend);
    const double within = nearer < 0 ? 0 : nearer > 1 ? 1 : nearer;
    const double turn = turns ? within : 1, left = 1 - turn;
    const double top = ((1 + 2 * turn) * y[j] + turn * d0) * left * left + ((1 + 2 * left) * y1[j] - left * d1) * turn * turn;
    peak[j] = std::max(peak[j], std::max(std::abs(top), std::abs(y1[j])));
  }
}

template <Peaks peaks>
void Pack::march(std::span<const double> acceleration, int sub_steps) {
  for (int j = 0; j < lanes; ++j) p[j] = q[j] = y[j] = peak[j] = 0, dy[j] = rate_a[j] * acceleration[0];
  const double share = 1.0 / sub_steps;
  for (std::size_t i = 1; i < acceleration.size(); ++i) {
    const double start = acceleration[i - 1], change = acceleration[i] - start;
    double from = start;
    for (int sub = 1; sub <= sub_steps; ++sub) {
      const double to = sub == sub_steps ? acceleration[i] : start + change * (share * sub);
      advance(from, to);
      if constexpr (peaks == Peaks::between) {
        if (may_peak(to)) look_between();
        std::copy_n(y1, lanes, y);
        std::copy_n(dy1, lanes, dy);
      } else {
        look_at_end();
      }
      from = to;
    }
  }
}

/// One oscillator: where its result goes, and how many sub-steps it takes.
struct Item {
  std::size_t frequency, damping;
  int sub_steps;
};

/// Oscillators items[first] ... items[first + count - 1].
struct Job {
  std::size_t first, count;
};

std::vector<Item> items_of(const std::vector<double>& frequencies, std::size_t dampings, double step) {
  std::vector<Item> items;
  for (std::size_t f = 0; f < frequencies.size(); ++f)
    for (std::size_t d = 0; d < dampings; ++d) items.push_back({f, d, sub_steps(frequencies[f], step)});
  std::ranges::stable_sort(items, std::greater{}, &Item::sub_steps);  // the longest work first
  return items;
}

std::vector<Job> jobs_of(const std::vector<Item>& items) {
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const bool joins = i > 0 && items[i].sub_steps == items[i - 1].sub_steps && jobs.back().count < lanes;
    if (joins)
      ++jobs.back().count;
    else
      jobs.push_back({i, 1});
  }
  return jobs;
}

}  // namespace

std::vector<Spectrum> response_spectra(std::span<const double> acceleration, double step, const std::vector<double>& frequencies,
                                       const std::vector<double>& dampings, Spectrum::Kind kind, int threads, Peaks peaks) {
  assert(step > 0 && std::ranges::all_of(frequencies, [](double f) { return f > 0; }));
  assert(std::ranges::all_of(dampings, [](double d) { return d >= 0 && d < 1; }));
  std::vector<Spectrum> spectra;
  for (const double damping : dampings) spectra.push_back({kind, damping, frequencies, std::vector<double>(frequencies.size())});
  if (acceleration.empty()) return spectra;

  const std::vector<Item> items = items_of(frequencies, dampings.size(), step);
  const std::vector<Job> jobs = jobs_of(items);
  in_parallel(static_cast<int>(jobs.size()), threads, [&](int number) {
    const Job& job = jobs[static_cast<std::size_t>(number)];
    const int subs = items[job.first].sub_steps;
    Pack pack;
    for (int j = 0; j < lanes; ++j) {  // lanes without an oscillator of their own repeat the last one
      const Item& item = items[job.first + std::min(static_cast<std::size_t>(j), job.count - 1)];
      pack.set(j, frequencies[item.frequency], dampings[item.damping], step / subs, kind);
    }
    peaks == Peaks::between ? pack.march<Peaks::between>(acceleration, subs) : pack.march<Peaks::at_points>(acceleration, subs);
    for (std::size_t j = 0; j < job.count; ++j) {
      const Item& item = items[job.first + j];
      spectra[item.damping].values[item.frequency] = pack.unit[j] * pack.peak[j];
    }
  });
  return spectra;
}

}  // namespace uplift
