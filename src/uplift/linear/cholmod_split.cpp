// Supernodal Cholesky with chosen unknowns last. CHOLMOD reorders what it is given (its supernodes need a postordered elimination tree),
// and would scatter the chosen unknowns again. Two kinds of explicit zeros in the pattern keep them together at the end: every component of
// the other unknowns is tied to the first chosen one, and each chosen one to the next. The tree then is a chain at its root, and every
// postorder of it ends with that chain.
#include "uplift/linear/cholmod_split.h"

#include <algorithm>
#include <mutex>
#include <numeric>
#include <utility>

#include "uplift/linear/cholmod_common.h"
#include "uplift/linear/supernodal.h"

namespace uplift {

namespace {

/// Explicit zeros that hold the chosen unknowns together: every end of a component and the first chosen one, each chosen one and the next.
using Chain = std::vector<std::pair<int, int>>;

/// Upper triangle of `a` with the chain.
Sparse with_chain(const Sparse& a, const Chain& chain) {
  std::vector<Triplet> zeros;
  for (const auto& [i, j] : chain) zeros.emplace_back(std::min(i, j), std::max(i, j), 0.0);
  Sparse extra(a.rows(), a.cols());
  extra.setFromTriplets(zeros.begin(), zeros.end());
  extra += a.triangularView<upper_triangle>();
  return extra;
}

class CholmodSplit : public SplitFactor {
 public:
  CholmodSplit(std::unique_ptr<Common> settings, cholmod_factor* factor, Index chosen, Chain chain)
      : settings_(std::move(settings)), factor_(factor), chosen_(chosen), chain_(std::move(chain)) {}
  ~CholmodSplit() override { cholmod_free_factor(&factor_, &settings_->common); }
  CholmodSplit(const CholmodSplit&) = delete;
  CholmodSplit& operator=(const CholmodSplit&) = delete;

  void forward(const Vector& b, Vector& y) const override {
    const auto* order = static_cast<const int*>(factor_->Perm);
    y.resize(b.size());
    for (Index k = 0; k < b.size(); ++k) y[k] = b[order[k]];
    Scratch scratch = take();
    solve_lower(supernodes(*factor_), y.data(), scratch->data());
    give_back(std::move(scratch));
  }

  void backward(const Vector& y, Vector& x) const override {
    const auto* order = static_cast<const int*>(factor_->Perm);
    Scratch scratch = take();
    double* solution = scratch->data() + factor_->n;
    std::copy_n(y.data(), y.size(), solution);
    solve_lower_transposed(supernodes(*factor_), solution, scratch->data());
    x.resize(y.size());
    for (Index k = 0; k < y.size(); ++k) x[order[k]] = solution[k];
    give_back(std::move(scratch));
  }

  void forward_all(std::span<const Vector* const> b, std::span<Vector* const> y) const override {
    const auto* order = static_cast<const int*>(factor_->Perm);
    in_groups(b, y, [&](Columns& columns) {
      for (std::size_t k = 0; k < factor_->n; ++k) columns.get(order[k], k);
      solve_lower_columns(supernodes(*factor_), columns.groups(), columns.values.data());
      for (std::size_t k = 0; k < factor_->n; ++k) columns.put(k, static_cast<Index>(k));
    });
  }

  void backward_all(std::span<const Vector* const> y, std::span<Vector* const> x) const override {
    const auto* order = static_cast<const int*>(factor_->Perm);
    in_groups(y, x, [&](Columns& columns) {
      for (std::size_t k = 0; k < factor_->n; ++k) columns.get(static_cast<Index>(k), k);
      solve_lower_transposed_columns(supernodes(*factor_), columns.groups(), columns.values.data());
      for (std::size_t k = 0; k < factor_->n; ++k) columns.put(k, order[k]);
    });
  }

  Matrix last() const override {
    Matrix block = Matrix::Zero(chosen_, chosen_);
    const Index first = static_cast<Index>(factor_->n) - chosen_;
    const auto *super = static_cast<const int*>(factor_->super), *pi = static_cast<const int*>(factor_->pi),
               *px = static_cast<const int*>(factor_->px), *rows = static_cast<const int*>(factor_->s);
    const auto* values = static_cast<const double*>(factor_->x);
    for (std::size_t s = 0; s < factor_->nsuper; ++s)
      for (int column = super[s]; column < super[s + 1]; ++column) {
        if (column < first) continue;
        const int height = pi[s + 1] - pi[s], local = column - super[s];
        for (int k = local; k < height; ++k)
          block(rows[pi[s] + k] - first, column - first) = values[px[s] + static_cast<Index>(local) * height + k];
      }
    return block;
  }

  SplitFactorisation refactorise(const Sparse& a) const override;
  /// The numbers, with the matrix and what its factor was analysed from.
  static SplitFactorisation fill(std::unique_ptr<CholmodSplit> factor, cholmod_sparse& upper, const Sparse& a);

  double nonzeros() const override { return static_cast<double>(factor_->xsize); }

 private:
  /// Right-hand sides side by side, as solve_lower_columns wants them.
  struct Columns {
    std::span<const Vector* const> from;
    std::span<Vector* const> to;
    std::vector<double>& values;
    std::size_t unknowns;

    std::size_t groups() const { return (from.size() + columns_of_a_group - 1) / columns_of_a_group; }
    double* row(std::size_t group, std::size_t row) const { return values.data() + (group * unknowns + row) * columns_of_a_group; }
    void get(Index from_row, std::size_t to_row) const {
      for (std::size_t c = 0; c < from.size(); ++c) row(c / columns_of_a_group, to_row)[c % columns_of_a_group] = (*from[c])[from_row];
    }
    void put(std::size_t from_row, Index to_row) const {
      for (std::size_t c = 0; c < to.size(); ++c) (*to[c])[to_row] = row(c / columns_of_a_group, from_row)[c % columns_of_a_group];
    }
  };
  template <class Work>
  void in_groups(std::span<const Vector* const> from, std::span<Vector* const> to, const Work& work) const {
    constexpr std::size_t most = 4 * columns_of_a_group;  // at once: so many rows of x stay in the cache beside the factor's
    for (std::size_t first = 0; first < from.size(); first += most) {
      const std::size_t count = std::min(most, from.size() - first);
      for (Vector* column : to.subspan(first, count)) column->resize(static_cast<Index>(factor_->n));
      Scratch scratch = take();
      Columns columns{from.subspan(first, count), to.subspan(first, count), *scratch, factor_->n};
      scratch->assign(columns.groups() * factor_->n * columns_of_a_group, 0);
      work(columns);
      give_back(std::move(scratch));
    }
  }
  /// Scratch of half a back-solve, kept for the next one: the highest supernode's rows, and a solution, or the columns of several.
  using Scratch = std::unique_ptr<std::vector<double>>;
  Scratch take() const {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<std::vector<double>>(2 * factor_->n);
    Scratch scratch = std::move(idle_.back());
    idle_.pop_back();
    return scratch;
  }
  void give_back(Scratch scratch) const {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(scratch));
  }
  std::unique_ptr<Common> settings_;
  cholmod_factor* factor_;
  Index chosen_;
  Chain chain_;
  mutable std::mutex mutex_;  // guards the idle scratch only; the factor itself is read-only in a solve
  mutable std::vector<Scratch> idle_;
};

/// Fill-reducing order of the unknowns that are not chosen, then the chosen ones.
std::vector<int> order_of(const Sparse& a, const std::vector<int>& last, const std::vector<int>& others, Common& settings) {
  std::vector<int> place(static_cast<std::size_t>(a.rows()), -1);
  for (std::size_t k = 0; k < others.size(); ++k) place[static_cast<std::size_t>(others[k])] = static_cast<int>(k);
  std::vector<Triplet> entries;
  for (const int column : others)
    for (Sparse::InnerIterator entry(a, column); entry; ++entry) {
      const int row = place[static_cast<std::size_t>(entry.row())], col = place[static_cast<std::size_t>(column)];
      if (row >= 0 && row <= col) entries.emplace_back(row, col, 1.0);
    }
  Sparse upper(static_cast<Index>(others.size()), static_cast<Index>(others.size()));
  upper.setFromTriplets(entries.begin(), entries.end());
  entries = {};
  cholmod_sparse view = sparse_view(upper);
  std::vector<int> order;
  if (!others.empty()) {
    cholmod_factor* factor = analyse(view, settings);
    if (factor == nullptr) return {};
    const auto* permutation = static_cast<const int*>(factor->Perm);
    for (std::size_t k = 0; k < others.size(); ++k) order.push_back(others[static_cast<std::size_t>(permutation[k])]);
    cholmod_free_factor(&factor, &settings.common);
  }
  order.insert(order.end(), last.begin(), last.end());
  return order;
}

/// The last unknown, in the given order, of every connected component of the others.
std::vector<int> ends_of_components(const Sparse& a, const std::vector<int>& order, std::size_t others) {
  const auto n = static_cast<std::size_t>(a.rows());
  std::vector<int> place(n), root(n);
  for (std::size_t k = 0; k < n; ++k) place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  std::iota(root.begin(), root.end(), 0);  // union-find over places; the root is the largest place
  const auto find = [&](int k) {
    while (root[static_cast<std::size_t>(k)] != k)
      k = root[static_cast<std::size_t>(k)] = root[static_cast<std::size_t>(root[static_cast<std::size_t>(k)])];
    return k;
  };
  for (std::size_t k = 0; k < others; ++k)
    for (Sparse::InnerIterator entry(a, order[k]); entry; ++entry) {
      const int other = place[static_cast<std::size_t>(entry.row())];
      if (other >= static_cast<int>(others)) continue;
      const int from = find(static_cast<int>(k)), to = find(other);
      root[static_cast<std::size_t>(std::min(from, to))] = std::max(from, to);
    }
  std::vector<int> ends;
  for (std::size_t k = 0; k < others; ++k)
    if (root[k] == static_cast<int>(k)) ends.push_back(order[k]);
  return ends;
}

Chain chain_of(const std::vector<int>& last, const std::vector<int>& ends) {
  Chain chain;
  for (const int end : ends) chain.emplace_back(last.front(), end);
  for (std::size_t k = 1; k < last.size(); ++k) chain.emplace_back(last[k - 1], last[k]);
  return chain;
}

SplitFactorisation parts_failed(std::string why) {
  return {.factor = nullptr, .failed_unknown = -1, .why = std::move(why), .too_large = true};
}

SplitFactorisation CholmodSplit::fill(std::unique_ptr<CholmodSplit> factor, cholmod_sparse& upper, const Sparse& a) {
  cholmod_factorize(&upper, factor->factor_, &factor->settings_->common);
  if (factor->settings_->common.status < 0) return parts_failed("the sparse factorisation ran out of memory");
  if (const int broken = broken_unknown(*factor->factor_, a); broken >= 0)
    return {.factor = nullptr, .failed_unknown = broken, .why = singular_at(broken).why};
  return {.factor = std::move(factor), .failed_unknown = -1, .why = {}};
}

SplitFactorisation CholmodSplit::refactorise(const Sparse& a) const {
  if (!has_room(*factor_, a)) return {};
  Sparse upper = with_chain(a, chain_);
  cholmod_sparse view = sparse_view(upper);
  auto settings = std::make_unique<Common>();
  if (std::string why = refusal(cost_of(*factor_, settings->common, upper.nonZeros())); !why.empty()) return parts_failed(std::move(why));
  cholmod_factor* copy = cholmod_copy_factor(factor_, &settings->common);
  if (copy == nullptr) return parts_failed("the sparse factorisation ran out of memory");
  return fill(std::make_unique<CholmodSplit>(std::move(settings), copy, chosen_, chain_), view, a);
}

/// The analysis with the chosen unknowns last: the upper triangle, ready to be factorised, and the factor without numbers, null when there
/// is none.
struct AnalysedParts {
  AnalysedParts(const Sparse& a, const std::vector<int>& last) : settings(std::make_unique<Common>()) {
    std::vector<char> chosen(static_cast<std::size_t>(a.rows()), 0);
    for (const int unknown : last) chosen[static_cast<std::size_t>(unknown)] = 1;
    std::vector<int> others;
    for (int i = 0; i < a.rows(); ++i)
      if (chosen[static_cast<std::size_t>(i)] == 0) others.push_back(i);
    count = others.size();
    std::vector<int> order = order_of(a, last, others, *settings);
    if (order.empty()) return;
    chain = chain_of(last, ends_of_components(a, order, count));
    upper = with_chain(a, chain);
    view = sparse_view(upper);
    settings->common.nmethods = 1;
    settings->common.method[0].ordering = CHOLMOD_GIVEN;
    factor = cholmod_analyze_p(&view, order.data(), nullptr, 0, &settings->common);
  }
  ~AnalysedParts() {
    if (settings != nullptr) cholmod_free_factor(&factor, &settings->common);
  }
  AnalysedParts(const AnalysedParts&) = delete;
  AnalysedParts& operator=(const AnalysedParts&) = delete;
  FactorCost cost() const {
    if (factor != nullptr) return cost_of(*factor, settings->common, upper.nonZeros());
    FactorCost none;
    none.why = why_not_analysed(settings->common);
    return none;
  }

  std::unique_ptr<Common> settings;
  std::size_t count = 0;  // unknowns that are not chosen
  Chain chain;
  Sparse upper;
  cholmod_sparse view{};
  cholmod_factor* factor = nullptr;
};

}  // namespace

SplitFactorisation cholmod_split(const Sparse& a, const std::vector<int>& last) {
  AnalysedParts analysed(a, last);
  const FactorCost cost = analysed.cost();
  if (!cost.why.empty()) return parts_failed(cost.why);
  if (std::string why = refusal(cost); !why.empty()) return parts_failed(std::move(why));
  cholmod_factor* raw = std::exchange(analysed.factor, nullptr);
  auto factor =
      std::make_unique<CholmodSplit>(std::move(analysed.settings), raw, static_cast<Index>(last.size()), std::move(analysed.chain));
  const auto* permutation = static_cast<const int*>(raw->Perm);
  const bool stayed = std::equal(last.begin(), last.end(), permutation + analysed.count);
  SplitFactorisation made = CholmodSplit::fill(std::move(factor), analysed.view, a);
  if (made.factor != nullptr && !stayed) return {.factor = nullptr, .failed_unknown = -1, .why = "the chosen unknowns did not stay last"};
  return made;
}

FactorCost cholmod_split_cost(const Sparse& a, const std::vector<int>& last) {
  return AnalysedParts(a, last).cost();
}

}  // namespace uplift
