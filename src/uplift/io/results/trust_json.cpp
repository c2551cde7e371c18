#include "uplift/io/results/trust_json.h"

#include <fmt/format.h>

#include <cmath>

#include "uplift/io/text/json_writer.h"

namespace uplift {
namespace {

void write_run(JsonWriter& json, const TrustRun& run) {
  json.begin_object().member("name", run.name).member("choice", run.choice).member("label", run.label);
  json.member("status", to_string(run.status)).member("bonded_status", to_string(run.bonded_status)).member("reason", run.reason);
  json.member("counts", run.counts()).member("wall_seconds", run.wall).end_object();
}

void write_band(JsonWriter& json, const TrustBand& band) {
  json.begin_object().member("quantity", band.quantity->name).member("interface", band.interface).member("unit", band.quantity->unit);
  json.member("value", band.value).member("least", band.least).member("most", band.most).member("dominant", band.dominant);
  json.key("values").begin_array();
  for (const std::optional<double>& value : band.values) {
    if (value)
      json.value(*value);
    else
      json.null();
  }
  json.end_array().end_object();
}

void write_spectrum(JsonWriter& json, const TrustSpectrum& spectrum) {
  json.begin_object().member("floor", spectrum.floor).member("damping", spectrum.damping);
  json.member("speaks_to", spectrum.speaks_to).member("limited_by", spectrum.limited_by).key("reaches").begin_array();
  for (const TrustSpectrum::Reach& reach : spectrum.reaches)
    json.begin_object().member("choice", reach.choice).member("to", reach.to).end_object();
  json.end_array();
  if (spectrum.above_broadened) json.member("above_broadened", *spectrum.above_broadened).member("above_at", spectrum.above_at);
  json.key("frequencies").numbers(spectrum.frequencies).key("value").numbers(spectrum.value);
  json.key("least").numbers(spectrum.least).key("most").numbers(spectrum.most).end_object();
}

}  // namespace

std::string trust_json(const TrustAnswer& answer) {
  JsonWriter json(0, 2);
  json.begin_object().member("format", "uplift-trust-1").member("complete", answer.complete).member("dominant", answer.dominant);
  json.member("spectrum_band", answer.accepted);
  json.key("base");
  write_run(json, answer.base);
  json.key("runs").begin_array();
  for (const TrustRun& run : answer.runs) write_run(json, run);
  json.end_array().key("not_changed").begin_array();
  for (const TrustPlan::LeftOut& each : answer.left_out)
    json.begin_object().member("choice", each.choice).member("reason", each.reason).end_object();
  json.end_array().key("bands").begin_array();
  for (const TrustBand& band : answer.bands) write_band(json, band);
  json.end_array().key("spectra").begin_array();
  for (const TrustSpectrum& spectrum : answer.spectra) write_spectrum(json, spectrum);
  json.end_array().end_object();
  return json.take() + "\n";
}

std::string trust_sentence(const TrustAnswer& answer) {
  if (!answer.base.counts())
    return fmt::format("No bands: the run of the case {}.", answer.base.status == RunStatus::failed ? "failed" : "was interrupted");
  if (answer.runs.empty()) return "Nothing was changed.";
  const std::size_t all = answer.runs.size(), counted = answer.counted();
  if (counted == 0) return fmt::format("No bands: none of the {} runs with a changed choice was completed.", all);
  const std::string over = counted == all ? "all changed choices" : fmt::format("{} of {} changed choices", counted, all);
  std::string text;
  for (const char* name : {"max_uplifted_ratio", "max_opening", "max_moment"})
    for (const TrustBand& band : answer.bands) {
      if (band.quantity->name != name) continue;
      text += fmt::format("{}{} from {} to {}", text.empty() ? "Over " + over + ": " : ", ", band.quantity->brief,
                          band.format_value(band.least), band.format_value(band.most));
      break;  // of the first interface
    }
  if (text.empty()) return "";
  return text + (answer.dominant.empty() ? "." : fmt::format(". What moves most numbers most is the {}.", answer.dominant));
}

}  // namespace uplift
