#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "uplift/base/file.h"
#include "uplift/cli/console.h"
#include "uplift/cli/study.h"
#include "uplift/io/report/report.h"
#include "uplift/io/report/study.h"

namespace uplift::cli {
namespace {

/// Curves without all of their runs, and capacities that the search has not narrowed down.
void warn_incomplete(const StudyDocument& document) {
  const auto missing = std::ranges::count(document.curves, false, &StudyDocument::Curve::complete);
  if (missing > 0) complain(fmt::format("warning: {} of {} curves are not complete", missing, document.curves.size()));
  for (const StudyDocument::Limit& each : document.limits)
    if (const auto open = std::ranges::count(each.fit.capacities, false, &StudyCapacity::found); open > 0 && missing == 0)
      complain(fmt::format("warning: {}: {} of {} capacities are not within the tolerance (method.most_runs)", each.limit.name, open,
                           each.fit.capacities.size()));
}

/// Whether the page was built into this program.
bool write_page(const Study& study, const Options& options, const StudyDocument& document, const std::string& text) {
  Provenance from;
  from.title = document.case_title;
  from.subtitle = "study \"" + document.name + "\"";
  if (study.reduced) from.subtitle += ". " + document.reduced_model;
  from.command = options.command;
  from.version = UPLIFT_VERSION;
  from.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  from.case_file = study.folder + "/plan.toml";
  from.case_hash = study.plan_hash;
  from.resolved = read_file(from.case_file);
  const std::string page = report_page(study_report_json(text, from));
  if (!page.empty())
    write_in(study, "report.html", page);
  else if (!options.quiet)
    complain("note: this program was built without the report's page (web/dist/report.html): no report.html is written");
  return !page.empty();
}

}  // namespace

StudyDocument document_of(const Study& study, const std::vector<StudyCurve>& curves) {
  StudyDocument document = study_document(study.of, curves);
  document.name = study.name;
  const auto from_study = [folder = std::filesystem::absolute(study.folder).lexically_normal()](const std::string& file) {
    return std::filesystem::absolute(file).lexically_normal().lexically_proximate(folder).string();
  };
  document.case_file = from_study(study.case_file);
  document.case_hash = study.case_hash;
  document.plan_hash = study.plan_hash;
  document.reduced_model = study.reduced_statement();
  for (const auto& [file, hash] : study.inputs) document.inputs.emplace_back(from_study(file), hash);
  return document;
}

void write_results(const Study& study, const std::vector<StudyCurve>& curves, const Options& options, bool with_page) {
  const StudyDocument document = document_of(study, curves);
  const std::string text = study_json(document);
  write_in(study, "study.json", text);
  write_in(study, "fits.csv", fits_csv(document));
  const bool page = with_page && write_page(study, options, document, text);
  if (options.json) return print_text(text);
  if (options.quiet) return;
  for (std::size_t k = 0; k < document.limits.size(); ++k) say(study_sentence(document, k));
  if (study.reduced) say(document.reduced_model);
  warn_incomplete(document);
  say(fmt::format("results: {0}/{1}, {0}/fits.csv", study.folder, page ? "report.html" : "study.json"));
}

}  // namespace uplift::cli
