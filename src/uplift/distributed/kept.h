#pragma once
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "uplift/model/matrix_home.h"

namespace uplift {

/// A matrix whose rows the ranks of the job keep (Ranks).
class KeptMatrix final : public DistributedMatrix {
 public:
  KeptMatrix(std::int64_t number, std::vector<int> firsts, std::vector<double> entries)
      : number_(number), firsts_(std::move(firsts)), entries_(std::move(entries)) {}
  ~KeptMatrix() override;
  KeptMatrix(const KeptMatrix&) = delete;
  KeptMatrix& operator=(const KeptMatrix&) = delete;
  void multiply(std::span<const DistributedTerm> sum, const Vector& x, Vector& y) const override;
  Vector diagonal() const override;
  const std::vector<double>& entries() const override { return entries_; }
  const std::vector<int>& firsts() const override { return firsts_; }
  std::int64_t number() const { return number_; }

 private:
  std::int64_t number_;
  std::vector<int> firsts_;
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
  int processes() const override;
  std::vector<int> divide(const CoupledVertices& graph) const override;
  bool takes_cells() const override { return takes_cells_; }
  std::shared_ptr<const DistributedCells> keep_cells(const std::vector<int>& firsts, const std::vector<EqualCells>& classes) const override;
  std::vector<std::shared_ptr<const DistributedMatrix>> keep(const std::vector<int>& firsts, const ElementsOfModel& elements,
                                                             const std::vector<MatrixOfElements>& matrices) const override;

 private:
  bool takes_cells_;
};

}  // namespace uplift
