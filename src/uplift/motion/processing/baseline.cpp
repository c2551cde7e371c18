// Baseline: a polynomial in time taken away from the acceleration, by least squares, on demand such that the motion ends at rest.
#include <fmt/format.h>

#include <cmath>

#include "uplift/math/dense.h"
#include "uplift/motion/formats/convert.h"
#include "uplift/motion/processing/step.h"

namespace uplift {

namespace {

/// Values of the shifted Legendre polynomials 0 ... order at n equal points over [0, 1]: one column each.
Matrix legendre(std::size_t n, int order) {
  Matrix basis(static_cast<Index>(n), order + 1);
  for (Index i = 0; i < basis.rows(); ++i) {
    const double x = 2 * static_cast<double>(i) / static_cast<double>(n - 1) - 1;
    double before = 0, now = 1;
    for (int k = 0; k <= order; ++k) {
      basis(i, k) = now;
      const double next = ((2 * k + 1) * x * now - k * before) / (k + 1);
      before = now;
      now = next;
    }
  }
  return basis;
}

class Baseline final : public ProcessStep {
 public:
  explicit Baseline(const Values& v) : ProcessStep(v), order_(v.integer("order")) {
    const std::string& end = v.text("end");
    constraints_ = end == "free" ? 0 : end == "velocity" ? 1 : 2;
    if (order_ + 1 < constraints_) refuse("order", "1 at least where velocity and displacement end at zero", fmt::format("{}", order_));
  }

  Motion apply(Motion motion) const override {
    if (constraints_ > 0) need_acceleration(motion);
    const auto n = static_cast<Index>(motion.values.size());
    if (n <= order_ + 1) refuse("", fmt::format("more than {} points", order_ + 1), fmt::format("{}", n));
    const Matrix basis = legendre(motion.values.size(), order_);
    Map values(motion.values.data(), n);
    const Vector trend = basis * coefficients(basis, values, motion.step);
    values -= trend;
    motion.processing.push_back(fmt::format(
        "Baseline: polynomial of order {} taken away from the {} by least squares{}; {:.4g} {} at the beginning, {:.4g} at the end.",
        order_, to_string(motion.kind), constrained(), trend[0], unit_of(motion.kind), trend[n - 1]));
    return motion;
  }

 private:
  /// Least squares, min |a - B c|2, with G c = G(a): velocity and displacement at the end, of what is straight between the points.
  Vector coefficients(const Matrix& basis, const Vector& values, double step) const {
    const Index k = basis.cols(), all = k + constraints_;
    Matrix system = Matrix::Zero(all, all);
    Vector right(all);
    system.topLeftCorner(k, k) = basis.transpose() * basis;
    right.head(k) = basis.transpose() * values;
    for (Index j = 0; j <= k && constraints_ > 0; ++j) {
      const Vector history = j < k ? Vector(basis.col(j)) : values;
      const Integrals path = integrals_of({history.data(), static_cast<std::size_t>(history.size())}, step);
      const double duration = step * static_cast<double>(values.size() - 1), scale = static_cast<double>(values.size());
      const double ends[] = {scale * path.velocity.back() / duration, scale * path.displacement.back() / (duration * duration)};
      for (int c = 0; c < constraints_; ++c)
        if (j < k)
          system(k + c, j) = system(j, k + c) = ends[c];
        else
          right[k + c] = ends[c];
    }
    return CompleteQr(system).solve(right).head(k);
  }
  const char* constrained() const {
    constexpr const char* words[] = {"", ", so that the velocity ends at zero", ", so that velocity and displacement end at zero"};
    return words[constraints_];
  }
  int order_, constraints_ = 0;
};

}  // namespace

const Entry<Processing>& entry_process_baseline() {
  static const Entry<Processing> entry{
      {.name = "baseline",
       .summary = "takes a polynomial in time away from the acceleration, on demand such that the motion ends at rest",
       .equations = "a -> a - p(t), p of least squares; with end = \"velocity\": v(end) = 0, with \"displacement\": v(end) = u(end) = 0",
       .source = "Chiu, BSSA 87 (1997), for the least squares",
       .params = {integer("order", "order of the polynomial").between(0, 3).standard(1),
                  choice("end", {"free", "velocity", "displacement"}, "what is zero at the end").standard("free")}},
      [](const Values& v) { return std::make_unique<Baseline>(v); }};
  return entry;
}

}  // namespace uplift
