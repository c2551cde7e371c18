#include "uplift/model/model.h"

namespace uplift {

namespace {

void add_to(Space space, const Element& element, const Matrix& local, double factor, std::vector<Triplet>& entries) {
  const auto nodes = element.nodes();
  const int each = element.unknowns_per_node();
  const auto unknown = [&](Index i) { return space.unknowns() * nodes[i / each] + static_cast<int>(i % each); };
  for (Index j = 0; j < local.cols(); ++j)
    for (Index i = 0; i < local.rows(); ++i)
      if (local(i, j) != 0) entries.emplace_back(unknown(i), unknown(j), factor * local(i, j));
}

/// Entries of all element matrices, at most.
std::size_t entries_of(const std::vector<std::unique_ptr<const Element>>& elements) {
  std::size_t count = 0;
  for (const auto& element : elements) {
    const std::size_t unknowns = element->nodes().size() * static_cast<std::size_t>(element->unknowns_per_node());
    count += unknowns * unknowns;
  }
  return count;
}

}  // namespace

Sparse assembled(Space space, std::size_t nodes, const std::vector<std::unique_ptr<const Element>>& elements, Matrix* Local::*wanted) {
  const bool damping = wanted == &Local::damping;
  std::vector<Triplet> entries;
  if (!damping) entries.reserve(entries_of(elements));  // a list that grows is there twice
  Matrix local, stiffness;
  for (const auto& element : elements) {
    const bool proportional = damping && element->beta != 0;
    Local one;
    one.*wanted = &local;
    if (proportional) one.stiffness = &stiffness;
    element->form(one);
    add_to(space, *element, local, 1, entries);
    if (proportional) add_to(space, *element, stiffness, element->beta, entries);
  }
  const Index unknowns = space.unknowns() * static_cast<Index>(nodes);
  Sparse matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Sparse assembled(const Model& model, Matrix* Local::*wanted) {
  return assembled(model.space, model.nodes.size(), model.elements, wanted);
}

}  // namespace uplift
