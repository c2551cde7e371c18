#include "uplift/study/trust.h"

#include <fmt/format.h>

#include <cmath>

#include "uplift/base/format.h"
#include "uplift/io/report/parts.h"

// How far the numbers can be trusted: bands of the verdict and of the floor spectra, and what was changed to get them.
namespace uplift {
namespace {

void write_heads(JsonWriter& json, std::initializer_list<std::pair<const char*, const char*>> heads) {
  json.key("columns").begin_array();
  for (const auto& [key, label] : heads) json.begin_object().member("key", key).member("label", label).member("kind", "text").end_object();
  json.end_array();
}

/// How far each spectrum speaks, by choice.
void write_trust_reaches(JsonWriter& json, const TrustAnswer& answer) {
  if (answer.spectra.empty()) return;
  json.begin_object()
      .member("id", "trust_reaches")
      .member("title", "Reliable frequency range of the floor spectra")
      .member("rowGroup", "floor");
  json.member(
      "caption",
      fmt::format(
          "Up to the stated frequency, no repetition with the changed choice differs from the case by more than {} of the raw curve. A "
          "peak that shifts in frequency counts in full; broadened spectra cover such shifts. Elements and step: frequency that they "
          "resolve, with ten nodes per wavelength and ten steps per period. Above broadened: largest excess of the raw curve of a "
          "repetition over the broadened curve of the case, and its frequency.",
          percent(answer.accepted)));
  json.key("columns").begin_array();
  write_column(json, {"damping", "Damping", "", "percent", 2});
  write_column(json, {"to", "Reliable to", "Hz", "number", 3});
  std::vector<std::string> choices;
  for (const TrustSpectrum::Reach& reach : answer.spectra.front().reaches) choices.push_back(reach.choice);
  for (const std::string& choice : choices) write_column(json, {choice.c_str(), choice.c_str(), "Hz", "number", 3});
  write_column(json, {"above", "Above broadened", "", "text", 0});
  json.end_array().key("rows").begin_array();
  for (const TrustSpectrum& each : answer.spectra) {
    json.begin_object().member("floor", each.floor).member("damping", each.damping).member("to", each.speaks_to);
    for (const TrustSpectrum::Reach& reach : each.reaches) json.member(reach.choice, reach.to);
    if (each.above_broadened)
      json.member("above", *each.above_broadened < 5e-3 ? std::string("nowhere")
                                                        : fmt::format("{} at {:.3g} Hz", percent(*each.above_broadened), each.above_at));
    json.end_object();
  }
  json.end_array().end_object();
}

void write_trust_bands(JsonWriter& json, const TrustAnswer& answer) {
  if (answer.bands.empty()) return;
  json.begin_object().member("id", "trust").member("title", "Trust bands of the results");
  json.member("caption",
              "Range of each result of the verdict over all runs in which one computational choice was changed. Band: half of the range "
              "divided by the "
              "value; results that are themselves shares, changes or residuals have a smallest and a largest value only. "
              "Most sensitive to: the choice with the largest deviation from the case.");
  write_heads(json, {{"number", "Result"},
                     {"of", "Interface"},
                     {"value", "Case"},
                     {"least", "Smallest"},
                     {"most", "Largest"},
                     {"band", "Band"},
                     {"by", "Most sensitive to"}});
  json.key("rows").begin_array();
  for (const TrustBand& band : answer.bands) {
    const std::optional<double> share = band.share();
    json.begin_object().member("number", band.quantity->meaning).member("of", band.interface);
    json.member("value", band.format_value(band.value)).member("least", band.format_value(band.least));
    json.member("most", band.format_value(band.most)).member("band", share ? "±" + percent(*share) : "");
    json.member("by", band.dominant).end_object();
  }
  json.end_array().end_object();
}

}  // namespace

void write_trust_tables(JsonWriter& json, const TrustAnswer& answer) {
  write_trust_bands(json, answer);
  write_trust_reaches(json, answer);

  json.begin_object().member("id", "trust_runs").member("title", "Changed computational choices");
  json.member("caption", "One choice is changed at a time. Runs that failed or were interrupted do not count for the bands.");
  write_heads(json, {{"choice", "Choice"}, {"label", "Changed to"}, {"status", "Status"}, {"why", "Why"}});
  json.key("rows").begin_array();
  for (const TrustRun& run : answer.runs) {
    json.begin_object().member("choice", run.choice).member("label", run.label).member("status", to_string(run.status));
    json.member("why", run.reason).end_object();
  }
  for (const TrustPlan::LeftOut& each : answer.left_out)
    json.begin_object()
        .member("choice", each.choice)
        .member("label", "–")
        .member("status", "not changed")
        .member("why", each.reason)
        .end_object();
  json.end_array().end_object();
}

std::vector<Chart> trust_charts(const TrustAnswer& answer) {
  std::vector<Chart> charts;
  for (const TrustSpectrum& each : answer.spectra) {
    Chart chart{fmt::format("trust_{}_{:g}", each.floor, 100 * each.damping),
                "trust",
                fmt::format("Floor {}, {} damping", each.floor, percent(each.damping)),
                each.limited_by.empty() ? fmt::format("All runs lie within {} of the case at all frequencies.", percent(answer.accepted))
                                        : fmt::format("Reliable up to {:.3g} Hz, limited by the {}.", each.speaks_to, each.limited_by),
                {"Frequency", "Hz", true},
                {"Pseudo-acceleration", "m/s2"},
                {}};
    chart.curves.push_back({"case", "case", each.frequencies, each.value, false, false});
    chart.curves.push_back({"smallest of all runs", "", each.frequencies, each.least, true, false});
    chart.curves.push_back({"largest of all runs", "", each.frequencies, each.most, true, false});
    charts.push_back(std::move(chart));
  }
  return charts;
}

}  // namespace uplift
