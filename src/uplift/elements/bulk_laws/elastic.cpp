#include <algorithm>

#include "uplift/elements/bulk_law.h"

// Linear elastic continuum: stress = D strain. Nothing is inelastic, so that a solid of it is linear.
namespace uplift {
namespace {

class Elastic final : public BulkLaw {
 public:
  using BulkLaw::BulkLaw;
  bool linear() const override { return true; }
  int num_history() const override { return 6; }

  BulkResponse respond(const BulkPoints& points) const override {
    const std::size_t count = points.strain.size();
    for (std::size_t p = 0; p < count; ++p) points.stress[p] = elastic() * points.strain[p];
    std::fill_n(points.now, 6 * count, 0.0);
    if (points.tangent != nullptr) std::fill_n(points.tangent, count, elastic());
    return {};
  }
};

}  // namespace

const BulkLawEntry& entry_bulk_law_elastic() {
  static const BulkLawEntry entry{{.name = "elastic",
                                   .summary = "linear elastic: what a linear analysis assumes",
                                   .equations = "stress = lambda tr(strain) I + 2 G strain, with E and poisson of the solid",
                                   .source = "Hooke; docs/theory, section 9",
                                   .params = {}},
                                  [](const BulkLawContext& solid, const Values&) -> std::unique_ptr<const BulkLaw> {
                                    return std::make_unique<Elastic>(solid.material);
                                  }};
  return entry;
}

}  // namespace uplift
