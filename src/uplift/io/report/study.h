#pragma once
#include <string>

#include "uplift/io/results/summary.h"

// The report of a study, on the page of the other reports.
namespace uplift {

/// The data of the page, see report_page(). `study`: the document study.json. Of `from` it takes command, version and time, the name of the
/// plan as `case_file`, its SHA-256 as `case_hash` and its text as `resolved`.
std::string study_report_json(const std::string& study, const Provenance& from);

}  // namespace uplift
