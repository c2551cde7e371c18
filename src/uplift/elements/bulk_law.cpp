#include "uplift/elements/bulk_law.h"

#include <array>

namespace uplift {

bool BulkLaw::stays_elastic(const BulkTrial&) const {
  return false;
}

double BulkLaw::locked_energy(const double*) const {
  return 0;
}

void BulkLaw::find_outputs(const double*, double*) const {}

// The bulk laws of parts.def. A law is found because it is listed there, not because its object file registers itself.
#define BULK_LAW(name) const BulkLawEntry& entry_bulk_law_##name();
#include "uplift/parts.def"

std::span<const BulkLawEntry* const> bulk_law_catalog() {
  static const std::array laws{
#define BULK_LAW(name) &entry_bulk_law_##name(),
#include "uplift/parts.def"
  };
  return laws;
}

std::span<const PartInfo* const> bulk_laws() {
  static const std::array laws{
#define BULK_LAW(name) static_cast<const PartInfo*>(&entry_bulk_law_##name()),
#include "uplift/parts.def"
  };
  return laws;
}

}  // namespace uplift
