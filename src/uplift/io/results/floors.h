#pragma once
#include <string>
#include <vector>

#include "uplift/io/results/result_writer.h"
#include "uplift/verdict/floor_spectra.h"

namespace uplift {

/// floor_spectra.csv: a line for every frequency, in one block for every run, floor and damping; then the envelopes. The bonded run and the
/// ratio stand beside the runs that have one; empty cells: there is none.
std::string floor_spectra_csv(const std::vector<RunResult>& runs, const FloorAnswers& floors);

/// For summary.json: the array of the floors of one run, and that of the envelopes.
void write_floors(ResultWriter& out, std::string_view key, const FloorRun& run);
void write_floor_envelopes(ResultWriter& out, std::string_view key, const FloorAnswers& floors);

}  // namespace uplift
