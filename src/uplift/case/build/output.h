#pragma once
#include "uplift/case/build/names.h"
#include "uplift/case/case.h"
#include "uplift/case/schema/output_sections.h"

namespace uplift {

struct CaseNames;  // case/build/names.h

/// The columns of the output: the automatic ones, then those that the case asks for. Sets plan.requests; uses top, base and facts.
void add_requests(const Case&, const CaseNames& names, BuiltCase&);
/// The floors whose spectra the case asks for. Sets plan.floors and plan.floor_bands; uses the plan's stages.
void add_floors(const Case&, BuiltCase&);
/// The node of `node`, or the one nearest to `at`, which is noted for `what`; InputError when neither or both are given.
int asked_node(const NodeAsked& asked, const std::string& what, const Names& nodes, BuiltCase& built);
/// Throws InputError when a list of texts names a column that there is not.
void check_columns(const std::vector<NameUsed>& names, const std::vector<Request>& requests);
/// True when the full unknown can move: it follows a free unknown or a prescribed motion.
bool moves(const Model&, int full_unknown);

}  // namespace uplift
