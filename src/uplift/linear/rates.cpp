#include "uplift/linear/rates.h"

#include <algorithm>
#include <chrono>

#include "uplift/linear/blas.h"

extern "C" void dgemm_(const char* transpose_a, const char* transpose_b, const int* m, const int* n, const int* k, const double* alpha,
                       const double* a, const int* stride_a, const double* b, const int* stride_b, const double* beta, double* c,
                       const int* stride_c);

namespace uplift {

namespace {

template <class Work>
double seconds(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double streaming(double bytes) {
  const auto size = static_cast<Index>(std::clamp(bytes, 1e6, 128e6) / sizeof(double));
  const Vector buffer = Vector::Ones(size);
  double best = 1e9, sum = 0;
  for (int pass = 0; pass < 3; ++pass) best = std::min(best, seconds([&] { sum += buffer.sum(); }));
  return sum > 0 ? static_cast<double>(size) * sizeof(double) / best : 0;  // the sum is used, or no loop would run
}

double dense_product() {
  prepare_blas();
  constexpr int n = 256;
  const double one = 1, zero = 0;
  const Matrix a = Matrix::Ones(n, n);
  Matrix c(n, n);
  double best = 1e9;
  for (int pass = 0; pass < 3; ++pass)
    best = std::min(best, seconds([&] { dgemm_("N", "T", &n, &n, &n, &one, a.data(), &n, a.data(), &n, &zero, c.data(), &n); }));
  return 2.0 * n * n * n / best;
}

}  // namespace

Rates measure_rates(double factor_bytes) {
  return {streaming(factor_bytes), dense_product()};
}

double factor_seconds(const FactorCost& cost, const Rates& rates) {
  return 1.5 * cost.operations / rates.operations_per_second + 1e-8 * cost.entries;
}

double solve_seconds(const FactorCost& cost, const Rates& rates) {
  return 16 * cost.entries / rates.bytes_per_second;
}

}  // namespace uplift
