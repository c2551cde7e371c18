#include "uplift/math/fourier.h"

#include <cassert>
#include <unsupported/Eigen/FFT>

namespace uplift {

std::vector<std::complex<double>> fourier(const std::vector<double>& values) {
  assert(values.size() >= 2);
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> half;
  transform.fwd(half, values);
  return half;
}

std::vector<double> inverse_fourier(const std::vector<std::complex<double>>& half, std::size_t n) {
  assert(half.size() == n / 2 + 1);
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<double> values(n);
  transform.inv(values, half, static_cast<Eigen::Index>(n));
  return values;
}

std::size_t fourier_length(std::size_t n) {
  for (std::size_t length = n + n % 2;; length += 2) {
    std::size_t rest = length;
    for (const std::size_t prime : {2U, 3U, 5U})
      while (rest > 0 && rest % prime == 0) rest /= prime;
    if (rest == 1) return length;
  }
}

}  // namespace uplift
