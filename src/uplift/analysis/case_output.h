#pragma once
#include "uplift/analysis/case.h"

namespace uplift {

/// The columns of the output: the automatic ones, then those that the case asks for. Sets plan.requests; uses top, base and facts.
void add_requests(const Case&, Built&);
/// Throws InputError when a list of texts names a column that there is not.
void check_columns(const Values& table, std::string_view key, const std::vector<Request>& requests);
/// True when the full unknown can move: it follows a free unknown or a prescribed motion.
bool moves(const Model&, int full_unknown);

}  // namespace uplift
