#pragma once
#include <string>

#include "uplift/case/build/names.h"
#include "uplift/case/case.h"
#include "uplift/case/schema/output_sections.h"

// Section forces, storey shears, drifts and reactions that a case asks for.
namespace uplift {

struct CaseNames;  // case/build/names.h

/// Section forces in the order of SectionRows.
struct SectionComponent {
  std::string_view word, unit;
  double reversed;  // its sign in an element that runs against its line
};
std::vector<SectionComponent> section_components(Space space);

/// Whether the quantity is a force of supports, ties or rigid bodies on a node.
bool is_constraint_force(const std::string& quantity);
/// The column of a history of a beam, a level, a group, or of the node that was found for it. Throws InputError.
Request force_request(const CaseHistory& history, const BuiltCase& built, const CaseNames& names, int node = -1);
/// Sets plan.envelopes.
void add_envelopes(const CaseOutput& output, BuiltCase& built);

}  // namespace uplift
