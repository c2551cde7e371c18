#pragma once
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "data_support.h"
#include "uplift/motion/processing/processing.h"

// Motions and files that the tests of the motion layer share.
namespace uplift {

inline constexpr double in_g = 9.80665;

/// All numbers of a text file; lines that begin with # or a letter are left out.
inline std::vector<std::vector<double>> rows_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#' || std::isalpha(static_cast<unsigned char>(line[0]))) continue;
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream words(line);
    std::vector<double> row;
    for (double value = 0; words >> value;) row.push_back(value);
    if (!row.empty()) rows.push_back(std::move(row));
  }
  return rows;
}

/// El Centro 1940 NS in g, 0.02 s. The record begins one step after rest.
inline std::vector<double> el_centro() {
  std::vector<double> values{0};
  for (const std::vector<double>& row : rows_of(support::data_file("records/elcentro.dat")))
    values.insert(values.end(), row.begin(), row.end());
  return values;
}

inline std::vector<double> noise(std::size_t count, unsigned seed = 1) {
  std::vector<double> values(count);
  for (double& value : values) value = static_cast<double>((seed = seed * 1664525U + 1013904223U) >> 8) / (1U << 24) - 0.5;
  return values;
}

/// Values of f at 0, step, 2 step ...
template <class F>
Motion motion_of(std::size_t count, double step, F f) {
  Motion motion;
  motion.step = step;
  for (std::size_t i = 0; i < count; ++i) motion.values.push_back(f(step * static_cast<double>(i)));
  return motion;
}

inline double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

}  // namespace uplift
