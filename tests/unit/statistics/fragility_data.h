#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "uplift/statistics/fragility.h"

// Published and other data sets with known fits, and helpers of the tests of fragility.
namespace uplift {

inline std::vector<Stripe> stripes(const std::vector<double>& im, const std::vector<long>& runs, const std::vector<long>& exceeded,
                                   const std::vector<long>& unknown = {}) {
  std::vector<Stripe> result;
  for (std::size_t i = 0; i < im.size(); ++i)
    result.push_back({im[i], runs.size() > 1 ? runs[i] : runs[0], exceeded[i], unknown.empty() ? 0 : unknown[i]});
  return result;
}
/// Baker (2015), example data of his script for multiple stripes; `unknown`: runs that failed numerically.
inline std::vector<Stripe> baker(const std::vector<long>& unknown = {}) {
  return stripes({0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9, 1.0}, {40}, {0, 0, 0, 4, 6, 13, 12, 16}, unknown);
}
/// Example data of pyFragility.
inline std::vector<Stripe> py_fragility() {
  return stripes({.178, .274, .444, .56, .652, .79, .982, 1.246, 1.564, 2.014, 2.417, 3.021, 3.625, 4.028, 4.431, 5.035}, {45},
                 {0, 0, 0, 0, 0, 4, 13, 23, 38, 41, 44, 45, 45, 45, 45, 45});
}
inline std::vector<Stripe> three_stripes() {
  return stripes({1, 1.5, 2}, {59, 50, 44}, {2, 25, 43});
}
/// 16 capacities; those above `limit` are censored at it.
inline std::vector<RecordCapacity> sixteen_capacities(double limit = 1e9) {
  std::vector<RecordCapacity> result;
  for (const double im : {.36, .45, .52, .58, .63, .70, .74, .81, .88, .95, 1.03, 1.12, 1.24, 1.37, 1.6, 1.9}) {
    if (im <= limit)
      result.push_back({im, Known::exact, limit});
    else
      result.push_back({limit, Known::at_least});
  }
  return result;
}
/// Ten demands; those above `limit` are known to be at least that.
inline std::vector<CloudPoint> ten_demands(double limit = 1e9) {
  const double im[] = {.1, .15, .2, .25, .3, .4, .5, .6, .8, 1.};
  const double demand[] = {.0021, .0028, .0047, .0049, .0072, .0083, .0125, .0131, .021, .0236};
  std::vector<CloudPoint> result;
  for (int i = 0; i < 10; ++i) result.push_back({im[i], std::min(demand[i], limit), demand[i] > limit});
  return result;
}

inline const Fragility& fit_of(const OrRefused<Fragility>& result) {
  return std::get<Fragility>(result);
}
template <class T>
std::string reason_of(const OrRefused<T>& result) {
  const auto* refused = std::get_if<Refused>(&result);
  return refused ? refused->reason : "";
}

}  // namespace uplift
