#include "uplift/io/report/report.h"

#include <fmt/format.h>

#include "uplift/io/report/motions.h"
#include "uplift/io/text/base64.h"
#include "uplift/io/text/deflate.h"

namespace uplift {
namespace {

constexpr std::string_view placeholder = "/*UPLIFT_DATA*/";

/// The catalog of the numbers of the verdict: how they are formatted depends on what they are.
void write_quantities(JsonWriter& json) {
  json.begin_object();
  for (const VerdictQuantity& each : verdict_quantities) {
    json.key(each.name).begin_object().member("meaning", each.meaning);
    if (is_share(each)) json.member("share", true);
    if (near_zero(each)) json.member("near_zero", true);
    json.end_object();
  }
  json.end_object();
}

/// What is to be known of the floor spectra of these runs; empty: nothing.
std::string floors_warning(const ReportInput& input) {
  std::string names;
  for (const ReportRun& run : input.runs)
    if (run.built->plan.method->constrains() && !run.spec->bonded && run.result->group == input.runs.front().result->group)
      names += (names.empty() ? "" : ", ") + run.result->label;
  return names.empty() ? "" : fmt::format("runs with constraints ({}): {}.", names, floors_of_constraints);
}

}  // namespace

std::string report_json(const ReportInput& input) {
  JsonWriter json(6);
  json.begin_object().member("format", "uplift-report-2").member("subtitle", input.from->subtitle).member("resolved", input.from->resolved);
  json.key("summary").document(input.summary);
  if (!input.trust.empty()) json.key("trust").document(input.trust);
  json.key("quantities");
  write_quantities(json);
  json.member("statics", statics_alone(input.runs.front().built->plan)).member("floorsWarning", floors_warning(input));
  json.key("verdict");
  write_sentences(json, input);
  json.key("uplifted");
  write_uplifted_shares(json, input);
  json.key("figures");
  write_figures(json, *input.read);
  json.key("choices");
  write_choices(json, *input.read, *input.runs.front().built);
  json.key("tables");
  write_tables(json, input);
  json.key("charts");
  write_charts(json, input);
  if (input.runs.front().built->model.space.dimension == 2) {
    json.key("model");
    write_model(json, *input.read, *input.runs.front().built);
    json.key("animations");
    write_animations(json, input);
  } else {
    json.key("model").null().key("animations").begin_array().end_array();
    write_space(json, input);
  }
  json.end_object();
  return json.take();
}

std::string report_page(const std::string& json) {
  const std::string_view page = report_template();
  const std::size_t at = page.find(placeholder);
  if (page.empty() || at == page.npos) return {};
  const std::string packed = deflated(json);
  std::string out;
  out.reserve(page.size() + base64_length(packed.size()));
  out += page.substr(0, at);
  append_base64(out, packed);
  out += page.substr(at + placeholder.size());
  return out;
}

}  // namespace uplift
