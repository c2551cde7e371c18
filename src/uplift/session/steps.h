#pragma once
#include <deque>
#include <memory>

#include "uplift/session/session.h"

// The pieces that run_case, compare_case and trust_case are made of.
namespace uplift {

/// The case that a run is of: the given one, or the other one that its variant names, read from its file. Models point into it. Throws
/// InputError.
std::shared_ptr<const LoadedCase> case_of(const LoadedCase& loaded, const RunSpec& spec);
/// Builds one run of its own case (case_of) and connects the caller's laws. Throws InputError, also for a law that the caller does not
/// have.
BuiltCase build_run(const LoadedCase& loaded, const RunSpec& spec);
/// The same behind others.
void append_run(const LoadedCase& loaded, const RunSpec& spec, std::deque<BuiltCase>& to);
/// Runs it, observed by the caller where it is the first one, and writes its fields where the case asks for them and there is a folder.
/// With a reduced model the model of `built` is put into its coordinates. `histories`: file of the folder to which its rows are written
/// while it runs; empty: none.
RunResult run_built(const LoadedCase& loaded, BuiltCase& built, const std::string& label, const Control& control, bool first,
                    std::vector<std::string>* field_lists, const std::string& histories = {});
/// What is known of the error of the reduced model, where the case names one.
void add_statement(const LoadedCase& loaded, std::vector<std::string>& warnings);
/// Frees the matrices of a model whose run is over: results are written without them.
void free_matrices(BuiltCase& built);

}  // namespace uplift
