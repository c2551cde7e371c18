#include <fmt/format.h>

#include <algorithm>

#include "uplift/io/results/study_json.h"
#include "uplift/io/text/numbers.h"

namespace uplift {
namespace {

std::string exact(double value) {
  std::string text;
  append_exact(text, value);
  return text;
}

std::string exact(const std::optional<double>& value) {
  return value ? exact(*value) : "";
}

std::string fit_cells(const OrRefused<Fragility>& result) {
  const Fragility* fit = std::get_if<Fragility>(&result);
  return fit ? exact(fit->theta()) + "," + exact(fit->beta()) : ",";
}

std::string seismic_cells(const OrRefused<SeismicCapacity>& result) {
  const SeismicCapacity* known = std::get_if<SeismicCapacity>(&result);
  if (!known) return ",,,,";
  return fmt::format("{},{},{},{},{}", exact(known->median), exact(known->beta_r), exact(known->beta_u), exact(known->hclpf()),
                     exact(known->hclpf_composite()));
}

std::string bootstrap_cells(const OrRefused<Bootstrap>& result) {
  const Bootstrap* known = std::get_if<Bootstrap>(&result);
  if (!known) return ",,,";
  const ConfidenceInterval theta = known->theta(study_confidence), beta = known->beta(study_confidence);
  return fmt::format("{},{},{},{}", exact(theta.lower), exact(theta.upper), exact(beta.lower), exact(beta.upper));
}

std::string capacity_cells(const std::optional<RecordCapacity>& capacity) {
  if (!capacity) return "nothing,";
  return fmt::format("{},{}",
                     capacity->known == Known::exact      ? "exact"
                     : capacity->known == Known::at_least ? "at_least"
                                                          : "at_most",
                     exact(capacity->im));
}

std::string text_of(const ConfidenceInterval& interval) {
  const auto end = [](const std::optional<double>& value) { return value ? fmt::format("{:.3g}", *value) : std::string("unbounded"); };
  return fmt::format("{:.0f} %: {} to {}", 100 * study_confidence, end(interval.lower), end(interval.upper));
}

/// A probability in per cent; tiny ones are those of the tail of a distribution that nobody has seen.
std::string probability_text(double probability) {
  constexpr double least = 1e-5, most = 0.99;
  if (probability < least) return "below 0.001 %";
  return probability > most ? "above 99 %" : fmt::format("{:.3g} %", 100 * probability);
}

std::string_view composite_words(const StudySite& site) {
  return site.factors.empty() ? "the composite beta of motions and samples" : "the factors of safety and the composite beta";
}

/// The annual rate, or why there is none; empty without a hazard curve or without a fit, which says why itself. Beside it that of the
/// composite beta and the factors of safety, where the capacity is known.
std::string risk_text(const StudySite& site, const StudyLimitFit& of) {
  const OrRefused<Fragility>& fit = of.fit.middle;
  if (site.hazard.empty() || std::holds_alternative<Refused>(fit)) return "";
  const OrRefused<AnnualRisk> risk = risk_of(site, fit);
  if (const Refused* refused = std::get_if<Refused>(&risk)) return "; no annual rate (" + refused->reason + ")";
  const AnnualRisk& known = std::get<AnnualRisk>(risk);
  const double beyond = known.share_beyond();
  const std::string caution = beyond > 0.1 ? fmt::format(", {:.0f} % of it from beyond the points of the hazard curve", 100 * beyond) : "";
  const OrRefused<AnnualRisk> composite = composite_risk_of(site, of.capacity);
  const AnnualRisk* beside = std::get_if<AnnualRisk>(&composite);
  return fmt::format("; annual rate {:.3g}{}{}", known.rate, caution,
                     beside ? fmt::format(" (with {} {:.3g})", composite_words(site), beside->rate) : "");
}

}  // namespace

std::string fits_csv(const StudyDocument& study) {
  const std::string unit = study.plan.intensity.unit;
  std::string text = fmt::format(
      "limit,survived [1],exceeded [1],unknown [1],theta [{0}],beta [1],theta lower [{0}],theta upper [{0}],beta lower [1],beta upper [1],"
      "theta unknown survived [{0}],beta unknown survived [1],theta unknown exceeded [{0}],beta unknown exceeded [1],probability at design "
      "[1],probability at 1.5 design [1],annual rate [1/a],share of it from beyond the hazard curve [1],capacity median [{0}],beta_r [1],"
      "beta_u [1],HCLPF [{0}],HCLPF composite [{0}],theta bootstrap lower [{0}],theta bootstrap upper [{0}],beta bootstrap lower [1],"
      "beta bootstrap upper [1],refused\n",
      unit);
  for (const StudyDocument::Limit& each : study.limits) {
    const Fragility* fit = std::get_if<Fragility>(&each.fit.fit.middle);
    const ConfidenceInterval theta = fit ? each.fit.theta_interval() : ConfidenceInterval{},
                             beta = fit ? fit->beta_interval(study_confidence) : ConfidenceInterval{};
    const std::optional<PerformancePair> pair = performance_of(study.plan.site, each.fit.fit.middle);
    const OrRefused<AnnualRisk> risk = risk_of(study.plan.site, each.fit.fit.middle);
    const AnnualRisk* known = std::get_if<AnnualRisk>(&risk);
    const std::string reason = !fit                                        ? std::get<Refused>(each.fit.fit.middle).reason
                               : !known && !study.plan.site.hazard.empty() ? std::get<Refused>(risk).reason
                                                                           : "";
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_cell(each.limit.name), each.fit.survived,
                        each.fit.exceeded, each.fit.unknown, fit_cells(each.fit.fit.middle), exact(theta.lower), exact(theta.upper),
                        exact(beta.lower), exact(beta.upper), fit_cells(each.fit.fit.survived), fit_cells(each.fit.fit.exceeded),
                        pair ? exact(pair->at_design) : "", pair ? exact(pair->at_one_and_a_half) : "", known ? exact(known->rate) : "",
                        known ? exact(known->share_beyond()) : "", seismic_cells(each.fit.capacity), bootstrap_cells(each.fit.bootstrap),
                        csv_cell(reason));
  }
  return text;
}

std::string study_runs_csv(const StudyDocument& study) {
  std::string text = fmt::format("id,motion,sample,intensity [{}],factor [1],outcome,reason", study.plan.intensity.unit);
  for (const StudyDocument::Limit& each : study.limits)
    text += "," + csv_cell(each.limit.name) + "," +
            csv_cell(fmt::format("{} [{}]", each.limit.name, each.limit.quantity ? each.limit.quantity->unit : "1"));
  text += "\n";
  for (const StudyDocument::Curve& curve : study.curves)
    for (const StudyDocument::Run& run : curve.runs) {
      text += fmt::format("{},{},{},{},{},{},{}", run.id, csv_cell(run.motion), run.sample, exact(run.intensity), exact(run.factor),
                          to_string(run.outcome), csv_cell(run.reason));
      for (std::size_t k = 0; k < run.states.size(); ++k) text += fmt::format(",{},{}", word_of(run.states[k]), exact(run.demands[k]));
      text += "\n";
    }
  return text;
}

std::string study_curves_csv(const StudyDocument& study) {
  const std::string unit = study.plan.intensity.unit;
  std::string text = fmt::format(
      "limit,motion,sample,found,capacity,capacity [{0}],unknown survived,unknown survived [{0}],unknown exceeded,unknown exceeded "
      "[{0}],resurrections [1]\n",
      unit);
  for (const StudyDocument::Limit& each : study.limits)
    for (const StudyCapacity& capacity : each.fit.capacities) {
      const StudyDocument::Curve& curve = study.curves[capacity.curve];
      text += fmt::format("{},{},{},{},{},{},{},{}\n", csv_cell(each.limit.name), csv_cell(curve.motion), curve.sample,
                          capacity.found ? "yes" : "no", capacity_cells(capacity.left_out), capacity_cells(capacity.survived),
                          capacity_cells(capacity.exceeded), capacity.resurrections.size());
    }
  return text;
}

std::string study_sentence(const StudyDocument& study, std::size_t number) {
  const StudyDocument::Limit& each = study.limits[number];
  const std::string unit = study.plan.intensity.unit == "1" ? "" : " " + study.plan.intensity.unit;
  const std::string counts =
      fmt::format("runs: {} survived, {} exceeded, {} unknown", each.fit.survived, each.fit.exceeded, each.fit.unknown);
  const auto short_text = [&](const OrRefused<Fragility>& result) {
    const Fragility* fit = std::get_if<Fragility>(&result);
    return fit ? fmt::format("{:.3g}{}, beta {:.3g}", fit->theta(), unit, fit->beta())
               : "no fit (" + std::get<Refused>(result).reason + ")";
  };
  std::string text = each.limit.name + ": ";
  if (std::holds_alternative<Fragility>(each.fit.fit.middle))
    text += fmt::format("median {} ({}); {}", short_text(each.fit.fit.middle), text_of(each.fit.theta_interval()), counts);
  else
    text += fmt::format("{}; {}", short_text(each.fit.fit.middle), counts);
  const StudySite& site = study.plan.site;
  const SeismicCapacity* capacity = std::get_if<SeismicCapacity>(&each.fit.capacity);
  if (capacity) text += fmt::format("; HCLPF {:.3g}{}", capacity->hclpf(), unit);
  const bool factors = !site.factors.empty();
  if (factors && !capacity) text += "; no capacity with the factors of safety (" + std::get<Refused>(each.fit.capacity).reason + ")";
  if (const std::optional<PerformancePair> pair =
          factors ? composite_performance_of(site, each.fit.capacity) : performance_of(site, each.fit.fit.middle))
    text += fmt::format("; at the design motion {}, at 1.5 times it {}{} (aims of ASCE/SEI 43: 1 % and 10 %, {})",
                        probability_text(pair->at_design), probability_text(pair->at_one_and_a_half),
                        factors ? " with the factors of safety" : "", pair->met() ? "met" : "not met");
  text += risk_text(site, each.fit);
  if (each.fit.unknown > 0)
    text += fmt::format("; unknown as survived: {}, as exceeded: {}", short_text(each.fit.fit.survived), short_text(each.fit.fit.exceeded));
  return text;
}

}  // namespace uplift
