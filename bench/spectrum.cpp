#include "uplift/motion/spectrum.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

// 300 frequencies (0.1 to 50 Hz) x 5 dampings of 16 000 points at 0.005 s: what `uplift motion` draws.
namespace {

using namespace uplift;

std::vector<double> noise(std::size_t count) {
  std::vector<double> values(count);
  unsigned state = 1;
  for (double& value : values) value = static_cast<double>((state = state * 1664525U + 1013904223U) >> 8) / (1U << 24) - 0.5;
  return values;
}

void spectrum(benchmark::State& state, Peaks peaks) {
  const std::vector<double> acceleration = noise(16000), frequencies = log_spaced(0.1, 50, 300);
  for (auto _ : state)
    benchmark::DoNotOptimize(response_spectra(acceleration, 0.005, frequencies, {0.005, 0.02, 0.05, 0.1, 0.2}, Spectrum::Kind::psa,
                                              static_cast<int>(state.range(0)), peaks));
}
BENCHMARK_CAPTURE(spectrum, at_points, Peaks::at_points)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(spectrum, between, Peaks::between)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void rotated(benchmark::State& state) {
  const std::vector<double> first = noise(16000);
  const std::vector<double> second(first.rbegin(), first.rend()), frequencies = log_spaced(0.1, 50, 300);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        rotated_spectra(first, second, 0.005, frequencies, 0.05, Spectrum::Kind::psa, static_cast<int>(state.range(0))));
}
BENCHMARK(rotated)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
