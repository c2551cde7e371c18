#include "uplift/io/report/report.h"

#include <fmt/format.h>

#include "uplift/io/report/motions.h"
#include "uplift/io/text/base64.h"
#include "uplift/io/text/deflate.h"

namespace uplift {
namespace {

constexpr std::string_view placeholder = "/*UPLIFT_DATA*/";

void write_section(JsonWriter& json, const char* id, std::string_view title, std::string_view text) {
  json.begin_object().member("id", id).member("title", title).member("text", text).end_object();
}

std::string floors_text(const ReportInput& input) {
  std::string text =
      "Response spectra of the floor accelerations: the largest pseudo-acceleration of equipment with a given frequency and damping.";
  std::string names;
  for (const ReportRun& run : input.runs)
    if (run.built->plan.method->constrains() && !run.spec->bonded && run.result->group == input.runs.front().result->group)
      names += (names.empty() ? "" : ", ") + run.result->label;
  if (!names.empty()) text += fmt::format(" Warning: runs with constraints ({}): {}.", names, floors_of_constraints);
  return text;
}

void write_beams_section(JsonWriter& json, const ReportInput& input) {
  if (!input.runs.front().result->envelopes.empty())
    write_section(json, "beams", "Section forces of beams", "Envelopes along the beams, compared with those of the bonded reference run.");
}

void write_sections(JsonWriter& json, const ReportInput& input) {
  constexpr std::string_view law = "Response of the interface law to a sequence of openings and closings.";
  json.begin_array();
  if (statics_alone(input.runs.front().built->plan)) {
    write_section(json, "rest", "State under the static loads", "State of the base at the end of the static stages.");
    write_section(json, "response", "Response", "Displacements of the top and of the base at every load step.");
    write_section(json, "interface", "Interface", "Forces in the interface and its opening at every load step.");
    write_beams_section(json, input);
    write_section(json, "law", "Interface law", law);
    json.end_array();
    return;
  }
  write_section(json, "rest", "Residual state", "State of the base at the end of the run, compared with the state before the shaking.");
  write_section(json, "loads", "Loads", "Loads on the structure over time.");
  if (!motions_of(input.runs).empty())
    write_section(json, "motions", "Ground motions", "Recorded and generated ground motions that excite the model.");
  write_section(json, "response", "Response", "Displacements and velocities of the top and of the base.");
  write_section(
      json, "interface", "Interface",
      "Forces in the interface and its opening. The uplifted area is the area with a gap; zero pressure alone does not count as uplift.");
  write_beams_section(json, input);
  if (has_floors(input)) write_section(json, "floors", "Floor spectra", floors_text(input));
  if (input.compared && input.runs.size() > 1 && input.runs.back().result->group != input.runs.front().result->group)
    write_section(
        json, "others", "Other dampings and motions",
        "The same variants with the other dampings and motions of the case. Without damping, numerical errors of the velocity remain "
        "visible.");
  if (input.trust && !input.trust->spectra.empty())
    write_section(json, "trust", "Trust bands of the floor spectra",
                  "Range of each floor spectrum over all runs in which one computational choice was changed.");
  write_section(json, "energy", "Energy",
                "The energy balance is evaluated at every step. Its residual is the numerical energy error: energy that the computation "
                "created (positive) or lost (negative).");
  write_section(json, "law", "Interface law", law);
  json.end_array();
}

}  // namespace

std::string report_json(const ReportInput& input) {
  const Provenance& from = *input.from;
  JsonWriter json(6);
  json.begin_object();
  json.member("format", "uplift-report-1").member("title", from.title).member("subtitle", from.subtitle).member("version", from.version);
  json.member("created", from.created).member("command", from.command).member("builtWith", from.built_with);
  json.key("case")
      .begin_object()
      .member("file", from.case_file)
      .member("sha256", from.case_hash)
      .member("resolved", from.resolved)
      .key("inputs")
      .begin_array();
  for (const auto& [file, hash] : from.inputs) json.begin_object().member("file", file).member("sha256", hash).end_object();
  json.end_array().end_object();
  json.key("verdict");
  write_verdict(json, input);
  json.key("choices");
  write_choices(json, *input.read, *input.runs.front().built);
  json.key("tables");
  write_tables(json, input);
  json.key("sections");
  write_sections(json, input);
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
