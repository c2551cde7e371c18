#pragma once
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "uplift/math/symmetric_sum.h"

namespace uplift {

/// A matrix whose rows the ranks of the job keep (Ranks).
class KeptMatrix final : public DistributedMatrix {
 public:
  KeptMatrix(std::int64_t number, Vector diagonal, std::vector<double> entries)
      : number_(number), diagonal_(std::move(diagonal)), entries_(std::move(entries)) {}
  ~KeptMatrix() override;
  KeptMatrix(const KeptMatrix&) = delete;
  KeptMatrix& operator=(const KeptMatrix&) = delete;
  void multiply(std::span<const DistributedTerm> sum, const Vector& x, Vector& y) const override;
  const Vector& diagonal() const override { return diagonal_; }
  const std::vector<double>& entries() const override { return entries_; }
  std::int64_t number() const { return number_; }

 private:
  std::int64_t number_;
  Vector diagonal_;
  std::vector<double> entries_;
};

/// The ranks of the job.
class HomeOnRanks final : public MatrixHome {
 public:
  std::shared_ptr<const DistributedMatrix> keep(Vector diagonal, const MakeColumns& make) const override;
};

}  // namespace uplift
