#pragma once
#include "uplift/session/session.h"

// The pieces that run_case, compare_case and trust_case are made of.
namespace uplift {

/// Refuses a case with an interface law of the caller that the caller does not have.
void check_external_laws(const BuiltCase& built, const Control& control);
/// Builds one run of a case and connects the caller's laws.
BuiltCase build_run(const LoadedCase& loaded, const RunSpec& spec, const Control& control);
/// Runs it, observed by the caller where it is the first one, and writes its fields where the case asks for them and there is a folder.
RunResult run_built(const LoadedCase& loaded, const BuiltCase& built, const std::string& label, const Control& control, bool first,
                    std::vector<std::string>* field_lists);
/// Frees the matrices of a model whose run is over: results are written without them.
void free_matrices(BuiltCase& built);

}  // namespace uplift
