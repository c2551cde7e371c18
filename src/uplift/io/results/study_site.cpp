#include "uplift/io/results/study_site.h"

#include <optional>
#include <vector>

namespace uplift {
namespace {

void write_pair(ResultWriter& out, const std::optional<PerformancePair>& pair) {
  out.number_or_null("at_design", pair ? std::optional(pair->at_design) : std::nullopt, "1", "at the design motion; null: no curve");
  out.number_or_null("at_one_and_a_half", pair ? std::optional(pair->at_one_and_a_half) : std::nullopt, "1", "at 1.5 times it");
}

}  // namespace

void write_interval(ResultWriter& out, std::string_view key, const ConfidenceInterval& interval, std::string_view unit,
                    std::string_view meaning) {
  out.object(key, meaning, [&] {
    out.number_or_null("lower", interval.lower, unit, "lower end; null: unbounded");
    out.number_or_null("upper", interval.upper, unit, "upper end; null: unbounded");
  });
}

void write_site(ResultWriter& out, const StudySite& site) {
  out.when(site.design.has_value() || out.is_schema()).object("design", "design motion of the site", [&] {
    out.number("intensity", site.design.value_or(0), intensity_unit, "its intensity");
    out.text("source", site.design_source, "where it comes from");
  });
  out.when(!site.hazard.empty() || out.is_schema()).object("hazard", "hazard curve of the site", [&] {
    std::vector<double> intensities, rates;
    for (const HazardPoint& point : site.hazard) intensities.push_back(point.im), rates.push_back(point.rate);
    out.numbers("intensities", intensities, intensity_unit, "intensities");
    out.numbers("rates", rates, "1/a", "mean annual rates with which they are exceeded");
    out.text("source", site.hazard_source, "where it comes from");
  });
}

void write_factors(ResultWriter& out, const StudySite& site) {
  out.list("factors", "factors of safety that the runs do not vary", site.factors, [&](const SafetyFactor& factor) {
    out.text("name", factor.name, "name");
    out.number("median", factor.median, "1", "median");
    out.number("beta_r", factor.beta_r, "1", "randomness");
    out.number("beta_u", factor.beta_u, "1", "uncertainty");
    out.text("source", factor.source, "where the numbers come from");
  });
}

void write_performance(ResultWriter& out, const StudySite& site, const StudyLimitFit& fit) {
  const std::optional<PerformancePair> pair = performance_of(site, fit.fit.middle);
  const double design = site.design.value_or(1);
  write_pair(out, pair);
  write_interval(out, "at_design_interval", pair ? fit.probability_interval(design) : ConfidenceInterval{}, "1", "its interval");
  write_interval(out, "at_one_and_a_half_interval", pair ? fit.probability_interval(1.5 * design) : ConfidenceInterval{}, "1",
                 "its interval");
  out.when(pair.has_value())
      .flag("met", pair && pair->met(), "whether they are at most 1 % and 10 %, the aims of ASCE/SEI 43; absent: no curve");
  out.object("unknown_survived", "with runs of unknown outcome counted as survived",
             [&] { write_pair(out, performance_of(site, fit.fit.survived)); });
  out.object("unknown_exceeded", "with runs of unknown outcome counted as exceeded",
             [&] { write_pair(out, performance_of(site, fit.fit.exceeded)); });
  out.object("composite", "by the median and the composite beta of the capacity, with the factors of safety",
             [&] { write_pair(out, composite_performance_of(site, fit.capacity)); });
}

void write_capacity(ResultWriter& out, const StudyLimitFit& fit) {
  const SeismicCapacity* known = std::get_if<SeismicCapacity>(&fit.capacity);
  const bool there = known != nullptr || out.is_schema();
  const SeismicCapacity shown = known ? *known : SeismicCapacity{};
  out.flag("known", known != nullptr, "whether median and both scatters are known");
  out.text("reason", known ? "" : std::get<Refused>(fit.capacity).reason, "why not");
  out.when(there).number("median", shown.median, intensity_unit, "median A_m: of the runs, times the medians of the factors of safety");
  out.when(there).number("beta_r", shown.beta_r, "1", "randomness: of the runs and the factors");
  out.when(there).number("beta_u", shown.beta_u, "1", "uncertainty: of the runs and the factors");
  out.when(there).number("beta_c", shown.beta_c(), "1", "composite: root of the sum of both squares");
  out.when(there).number("hclpf", shown.hclpf(), intensity_unit,
                         "high confidence of a low probability of failure, 95 % of at most 5 %: A_m exp(-1.65 (beta_r + beta_u))");
  out.when(there).number("hclpf_composite", shown.hclpf_composite(), intensity_unit,
                         "1 % probability by the composite curve: A_m exp(-2.326 beta_c)");
}

void write_risk(ResultWriter& out, const StudySite& site, const StudyLimitFit& fit) {
  const OrRefused<AnnualRisk> result = risk_of(site, fit.fit.middle);
  const AnnualRisk* risk = std::get_if<AnnualRisk>(&result);
  const auto part = [&](double AnnualRisk::*of) { return risk ? std::optional(risk->*of) : std::nullopt; };
  const auto end = [&](const OrRefused<Fragility>& curve) {
    const OrRefused<AnnualRisk> other = risk_of(site, curve);
    return std::holds_alternative<AnnualRisk>(other) ? std::optional(std::get<AnnualRisk>(other).rate) : std::nullopt;
  };
  out.number_or_null("rate", part(&AnnualRisk::rate), "1/a", "annual rate with which the limit is exceeded; null: see reason");
  out.text("reason", risk ? "" : std::get<Refused>(result).reason, "why there is none");
  out.number_or_null("share_below", part(&AnnualRisk::share_below), "1",
                     "share that rests on rates below the first point of the hazard curve");
  out.number_or_null("share_above", part(&AnnualRisk::share_above), "1", "share that rests on rates above its last point");
  const OrRefused<AnnualRisk> composite = composite_risk_of(site, fit.capacity);
  const AnnualRisk* of_both = std::get_if<AnnualRisk>(&composite);
  out.number_or_null("composite", of_both ? std::optional(of_both->rate) : std::nullopt, "1/a",
                     "the rate by the median and the composite beta of the capacity, with the factors of safety; null: it is not known");
  out.number_or_null("unknown_survived", end(fit.fit.survived), "1/a", "the rate with runs of unknown outcome counted as survived");
  out.number_or_null("unknown_exceeded", end(fit.fit.exceeded), "1/a", "the rate with runs of unknown outcome counted as exceeded");
}

}  // namespace uplift
