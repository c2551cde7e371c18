#include "uplift/io/report/study.h"

#include "uplift/io/text/json_writer.h"

namespace uplift {

std::string study_report_json(const std::string& study, const Provenance& from) {
  JsonWriter json;
  json.begin_object().member("format", "uplift-report-2").member("title", from.title).member("subtitle", from.subtitle);
  json.member("version", from.version).member("builtWith", from.built_with).member("created", from.created).member("command", from.command);
  json.member("resolved", from.resolved);
  json.key("case").begin_object().member("file", from.case_file).member("sha256", from.case_hash).end_object();
  json.key("study").document(study);
  return json.end_object().take();
}

}  // namespace uplift
