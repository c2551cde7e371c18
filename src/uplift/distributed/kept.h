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
  KeptMatrix(std::int64_t number, Index rows, std::vector<double> entries) : number_(number), rows_(rows), entries_(std::move(entries)) {}
  ~KeptMatrix() override;
  KeptMatrix(const KeptMatrix&) = delete;
  KeptMatrix& operator=(const KeptMatrix&) = delete;
  void multiply(std::span<const DistributedTerm> sum, const Vector& x, Vector& y) const override;
  Vector diagonal() const override;
  const std::vector<double>& entries() const override { return entries_; }
  std::int64_t number() const { return number_; }

 private:
  std::int64_t number_;
  Index rows_;
  std::vector<double> entries_;
};

/// Cells whose places the ranks of the job keep.
class KeptCells final : public DistributedCells {
 public:
  KeptCells(std::int64_t number, std::vector<double> bytes) : number_(number), bytes_(std::move(bytes)) {}
  ~KeptCells() override;
  KeptCells(const KeptCells&) = delete;
  KeptCells& operator=(const KeptCells&) = delete;
  const std::vector<double>& bytes() const override { return bytes_; }
  std::int64_t number() const { return number_; }

 private:
  std::int64_t number_;
  std::vector<double> bytes_;
};

/// The ranks of the job.
class HomeOnRanks final : public MatrixHome {
 public:
  explicit HomeOnRanks(bool takes_cells) : takes_cells_(takes_cells) {}
  bool takes_cells() const override { return takes_cells_; }
  std::shared_ptr<const DistributedCells> keep_cells(Index rows, const std::vector<EqualCells>& classes) const override;
  std::shared_ptr<const DistributedMatrix> keep(Index rows, const MakeColumns& make, const EqualCellPart& part) const override;

 private:
  bool takes_cells_;
};

}  // namespace uplift
