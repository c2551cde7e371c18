#include <fmt/format.h>

#include <cmath>

#include "uplift/analysis/wording.h"
#include "uplift/io/report_parts.h"
#include "uplift/study/trust.h"

// How far the numbers can be trusted: bands of the verdict and of the floor spectra, and what was changed to get them.
namespace uplift {
namespace {

void write_heads(JsonWriter& json, std::initializer_list<std::pair<const char*, const char*>> heads) {
  json.key("columns").begin_array();
  for (const auto& [key, label] : heads) json.begin_object().member("key", key).member("label", label).member("kind", "text").end_object();
  json.end_array();
}

}  // namespace

void write_trust_tables(JsonWriter& json, const TrustAnswer& answer) {
  json.begin_object().member("id", "trust").member("title", "How far the numbers can be trusted");
  json.member(
      "caption",
      "Every number of the verdict over all runs in which one choice of the computation was changed. Band: half of it, over the value. "
      "Moved most by: the choice whose change is farthest from the case as it stands.");
  write_heads(json, {{"number", "Number"},
                     {"of", "Interface"},
                     {"value", "As in the case"},
                     {"least", "Least"},
                     {"most", "Most"},
                     {"band", "Band"},
                     {"by", "Moved most by"}});
  json.key("rows").begin_array();
  for (const TrustBand& band : answer.bands) {
    const std::optional<double> share = band.share();
    json.begin_object().member("number", band.quantity->meaning).member("of", band.interface);
    json.member("value", said(*band.quantity, band.value)).member("least", said(*band.quantity, band.least));
    json.member("most", said(*band.quantity, band.most)).member("band", share ? "±" + percent(*share) : "–");
    json.member("by", band.dominant).end_object();
  }
  json.end_array().end_object();

  json.begin_object().member("id", "trust_runs").member("title", "What was changed");
  json.member("caption", "One choice at a time; a run that failed counts for no band.");
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
                each.limited_by.empty() ? fmt::format("All runs lie within {} of the case at every frequency.", percent(answer.accepted))
                                        : fmt::format("Speaks to {:.3g} Hz: beyond, the {} moves it by more than {}.", each.speaks_to,
                                                      each.limited_by, percent(answer.accepted)),
                {"Frequency", "Hz", true},
                {"Pseudo-acceleration", "m/s2"},
                {}};
    chart.curves.push_back({"as in the case", "as in the case", each.frequencies, each.value, false, false});
    chart.curves.push_back({"least of all runs", "", each.frequencies, each.least, true, false});
    chart.curves.push_back({"most of all runs", "", each.frequencies, each.most, true, false});
    charts.push_back(std::move(chart));
  }
  return charts;
}

}  // namespace uplift
