#pragma once
#include <complex>
#include <cstddef>
#include <vector>

namespace uplift {

/// Discrete Fourier transform of n >= 2 real values, X[k] = sum over i of x[i] exp(-2 pi j i k/n), k = 0 ... n/2 (the rest is their
/// conjugate).
std::vector<std::complex<double>> fourier(const std::vector<double>& values);
/// The n real values whose transform this is; `half` has n/2 + 1 of them.
std::vector<double> inverse_fourier(const std::vector<std::complex<double>>& half, std::size_t n);
/// The smallest even number >= n without prime factors beyond 5: lengths that are transformed quickly.
std::size_t fourier_length(std::size_t n);

}  // namespace uplift
