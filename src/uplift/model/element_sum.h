#pragma once
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "uplift/elements/element.h"

namespace uplift {

/// The sum of one matrix over all elements, A = sum A_e, as products with it and as T^T A T. A itself is never made, nor the list of all
/// entries of all elements, which takes three times the memory of the sum: two passes over the elements find the places and fill them.
class ElementSum {
 public:
  /// `wanted`: which matrix; damping: with what the elements' own factors beta make of their stiffness. The elements must stay alive.
  /// `left_out`: of each element, whether it is no part of the sum; empty: none is.
  ElementSum(Space space, const std::vector<std::unique_ptr<const Element>>& elements, Matrix* Local::*wanted,
             std::vector<char> left_out = {})
      : space_(space), elements_(elements), wanted_(wanted), left_out_(std::move(left_out)) {}
  /// The matrix of one element; `stiffness` is room.
  static void form(const Element& element, Matrix* Local::*wanted, Matrix& local, Matrix& stiffness);
  /// A X, full unknowns.
  Matrix times(const Matrix& x) const;
  /// Diagonal of T^T A T with the sizes of all factors: zero where no element reaches, whatever cancels elsewhere. `expansion`: T^T.
  Vector size_of_diagonal(const Sparse& expansion) const;
  /// T^T A T without entries that are only round-off.
  Sparse reduced(const Sparse& expansion) const;
  /// Diagonal of T^T A T, from `first` on.
  Vector diagonal(const Sparse& expansion, Index first, Index count) const;
  /// Columns first ... first + count - 1 of T^T A T, free x count: those of `reduced`, to the last bit. Elements that do not reach them are
  /// not looked at. `diagonal`: of T^T A T.
  Sparse columns(const Sparse& expansion, const Vector& diagonal, Index first, Index count) const;

 private:
  struct Columns {
    Index first, count;
    bool has(Index column) const { return column >= first && column < first + count; }
  };
  /// Full unknowns of each element, and its matrix.
  using TakeElement = std::function<void(std::span<const int> unknowns, const Matrix& local)>;
  using Wanted = std::function<bool(std::span<const int> unknowns)>;
  void each_element(const TakeElement& take, const Wanted& is_wanted = {}) const;
  /// The parts T^T A_e T of each element that its matrix couples, each with its free unknowns, if one of them is among the columns. Always
  /// in the same order.
  using TakeGroup = std::function<void(std::span<const int> unknowns, const Matrix& block)>;
  void each_group(const Sparse& expansion, Columns columns, const TakeGroup& take) const;
  Sparse places(const Sparse& expansion, Columns columns) const;
  Sparse filled(const Sparse& expansion, Columns columns) const;

  Space space_;
  const std::vector<std::unique_ptr<const Element>>& elements_;
  Matrix* Local::*wanted_;
  std::vector<char> left_out_;
};

}  // namespace uplift
