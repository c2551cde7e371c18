#pragma once
#include "uplift/case/build/names.h"
#include "uplift/case/case.h"
#include "uplift/case/schema/output_sections.h"

namespace uplift {

struct CaseNames;  // case/build/names.h

/// The columns of the output: the automatic ones, then those that the case asks for. Sets plan.requests; uses top, base and facts.
void add_requests(const Case&, const CaseNames& names, BuiltCase&);
/// The motions of the top that the verdict makes of several columns, and the storey shears and drift ratios in space of which both axes are
/// recorded: uses plan.requests, top, base and facts. Sets plan.combined.
void add_combined(BuiltCase&);
/// Their names: horizontal and vertical motion of the top, and its drift from the base with and without what the base's rotation makes of
/// it.
inline constexpr std::string_view combined_top = "top", combined_top_up = "top up", combined_drift = "drift", combined_bending = "bending";
/// The floors whose spectra the case asks for. Sets plan.floors and plan.floor_bands; uses the plan's stages.
void add_floors(const Case&, BuiltCase&);
/// The node of `node`, or the one nearest to `at`, which is noted for `what`; InputError when neither or both are given.
int asked_node(const NodeAsked& asked, const std::string& what, BuiltCase& built);
/// Throws InputError when a list of texts names a column that there is not.
void check_columns(const std::vector<NameUsed>& names, const std::vector<Request>& requests);
/// True when the full unknown can move: it follows a free unknown or a prescribed motion.
bool moves(const Model&, int full_unknown);

}  // namespace uplift
