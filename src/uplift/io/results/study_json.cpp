#include "uplift/io/results/study_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "uplift/case/schema/case_input.h"
#include "uplift/io/results/result_writer.h"
#include "uplift/io/results/study_site.h"

namespace uplift {

std::string_view word_of(RunOutcome outcome) {
  return outcome == RunOutcome::survived ? "survived" : outcome == RunOutcome::exceeded ? "exceeded" : "unknown";
}

namespace {

constexpr std::string_view limit_unit = "as stated in unit";

std::vector<std::string_view> outcome_words() {
  return {std::begin(study_outcomes), std::end(study_outcomes)};
}

std::string_view word_of(Known known) {
  return known == Known::exact ? "exact" : known == Known::at_least ? "at_least" : "at_most";
}

// ---- what was studied ----

void write_provenance(ResultWriter& out, const StudyDocument& study) {
  out.text("version", UPLIFT_VERSION, "version of the program");
  out.text("case_file", study.case_file, "case file, seen from the study's folder");
  out.text("case_sha256", study.case_hash, "SHA-256 of the case file");
  out.text("plan_sha256", study.plan_hash, "SHA-256 of the plan");
  out.text("reduced_model", study.reduced_model,
           "the reduced model that the case names, its size and the statement of its error; empty: the whole model was computed");
  out.list("inputs", "other files that the case reads", study.inputs, [&](const auto& input) {
    out.text("file", input.first, "path, seen from the study's folder");
    out.text("sha256", input.second, "SHA-256");
  });
  out.count("seed", static_cast<long>(study.plan.seed), "seed of the samples");
}

void write_intensity(ResultWriter& out, const IntensityMeasure& measure) {
  out.word("measure",
           measure.kind == IntensityMeasure::Kind::pga   ? "pga"
           : measure.kind == IntensityMeasure::Kind::pgv ? "pgv"
           : measure.kind == IntensityMeasure::Kind::sa  ? "sa"
                                                         : "factor",
           {"pga", "pgv", "sa", "factor"}, "measure of the motions");
  out.text("label", measure.label(), "measure in words");
  out.text("unit", measure.unit, "unit of all intensities in this document");
  out.number("period", measure.period, "s", "period of the oscillator of sa, else 0");
  out.number("damping", measure.damping, "1", "its damping ratio");
}

void write_method(ResultWriter& out, const StudyMethod& method) {
  out.word("type", to_string(method.type), {"ida", "truncated_ida", "stripes", "cloud"}, "method");
  out.numbers("levels", method.levels, intensity_unit, "intensities of stripes, factors of clouds; empty for searches");
  out.number("largest", method.search.largest, intensity_unit, "largest intensity of a search, else 0");
  out.number("tolerance", method.search.tolerance, "1", "relative tolerance of a capacity");
}

void write_motion(ResultWriter& out, const StudyMotion& motion) {
  out.text("name", motion.name, "name");
  out.text("label", motion.label, "label");
  out.text("record", motion.record, "record whose intensity it is; empty: a function drives");
  out.number("intensity", motion.intensity, intensity_unit, "intensity at the factor 1");
  out.number("pga", motion.measures.pga, "m/s2", "peak acceleration at the factor 1");
  out.number("pgv", motion.measures.pgv, "m/s", "peak velocity");
  out.number("arias", motion.measures.arias, "m/s", "Arias intensity");
  out.number("cav", motion.measures.cav, "m/s", "cumulative absolute velocity");
  out.number("significant_duration", motion.measures.significant_duration(), "s", "time between 5 % and 95 % of the Arias intensity");
  out.number("step", motion.step, "s", "time step of the record");
  out.number("duration", motion.duration, "s", "duration of the record");
}

struct Variable {
  StudyVariable variable;
  std::vector<double> values;
};

void write_variable(ResultWriter& out, const Variable& each) {
  const StudyVariable& variable = each.variable;
  out.text("name", variable.name, "name");
  out.texts("paths", variable.paths, "numbers of the case that it sets");
  out.word("meaning", variable.is_factor ? "factor" : "value", {"factor", "value"}, "factor on the case's values, or their value");
  out.text("unit", variable.unit, "unit of the values");
  const std::size_t kind = variable.distribution.index();
  out.word("distribution", kind == 0 ? "normal" : kind == 1 ? "lognormal" : "uniform", {"normal", "lognormal", "uniform"}, "distribution");
  const auto parameters = std::visit(
      [](const auto& d) -> std::array<double, 2> {
        const auto& [first, second] = d;
        return {first, second};
      },
      variable.distribution);
  out.numbers("parameters", parameters, "as the distribution has them",
              "mean and standard deviation; median and standard deviation of the logarithm; least and largest value");
  out.numbers("values", each.values, "as stated in unit", "value of every sample");
}

std::vector<Variable> variables_of(const StudyDocument& study) {
  std::vector<Variable> made;
  for (std::size_t k = 0; k < study.plan.variables.size(); ++k) {
    made.push_back({study.plan.variables[k], {}});
    for (const StudySample& sample : study.samples) made.back().values.push_back(sample.values[k]);
  }
  return made;
}

// ---- runs ----

void write_run(ResultWriter& out, const StudyDocument::Run& run) {
  out.text("id", run.id, "identity: SHA-256 of case, motion, factor and program version");
  out.number("intensity", run.intensity, intensity_unit, "intensity");
  out.number("factor", run.factor, "1", "factor on the motion");
  out.word("outcome", to_string(run.outcome), outcome_words(), "how the run ended");
  std::vector<std::string> states;
  for (const RunOutcome state : run.states) states.emplace_back(word_of(state));
  out.texts("states", states, "for each limit: survived, exceeded or unknown");
  out.numbers_or_null("demands", run.demands, "as stated in the limit", "the number of the verdict for each limit; null: the run has none");
}

void write_curve(ResultWriter& out, const StudyDocument::Curve& curve) {
  out.text("motion", curve.motion, "motion");
  out.count("sample", curve.sample, "sample, from 0");
  out.flag("complete", curve.complete, "whether no run of it is missing");
  out.list("runs", "runs by intensity", curve.runs, [&](const StudyDocument::Run& run) { write_run(out, run); });
}

void write_failure(ResultWriter& out, const StudyDocument::Run& run) {
  out.text("id", run.id, "identity of the run");
  out.text("motion", run.motion, "motion");
  out.count("sample", run.sample, "sample, from 0");
  out.number("intensity", run.intensity, intensity_unit, "intensity");
  out.number("factor", run.factor, "1", "factor on the motion");
  out.word("outcome", to_string(run.outcome), outcome_words(), "how the run ended");
  out.text("reason", run.reason, "why");
  out.text("case", run.case_file, "case of this run alone, for `uplift run`; in the study's folder");
  out.text("replay", run.problem_file, "interface problem of the failed step, for `uplift replay`; empty: none");
}

// ---- fits ----

/// A fit, or why there is none; with its intervals and its curve where wanted.
void write_fit(ResultWriter& out, const OrRefused<Fragility>& result, const StudyLimitFit* with_curve) {
  const Fragility* fit = std::get_if<Fragility>(&result);
  const Fragility none;
  const Fragility& shown = fit ? *fit : none;
  const bool there = fit != nullptr || out.is_schema();
  out.flag("fitted", fit != nullptr, "whether the data identify a curve");
  out.text("reason", fit ? "" : std::get<Refused>(result).reason, "why not");
  out.when(there).number("theta", shown.theta(), intensity_unit, "median");
  out.when(there).number("beta", shown.beta(), "1", "standard deviation of the logarithm");
  if (!with_curve) return;
  out.when(there).number("log_likelihood", shown.log_likelihood(), "1", "logarithm of the likelihood");
  out.when(there).number("se_log_theta", shown.se_log_theta(), "1", "standard error of ln theta");
  out.when(there).number("se_beta", shown.se_beta(), "1", "standard error of beta");
  out.when(there).number("correlation", shown.correlation(), "1", "correlation of both errors");
  if (!there) return;
  out.when(there);
  write_interval(
      out, "theta_interval", fit ? with_curve->theta_interval() : ConfidenceInterval{}, intensity_unit,
      "interval of theta; where motions and samples are crossed and all capacities known, it follows from the two-way layout; of "
      "stripes and clouds it knows that runs share motions and samples");
  out.when(there);
  write_interval(out, "beta_interval", fit ? fit->beta_interval(study_confidence) : ConfidenceInterval{}, "1", "interval of beta");
  std::vector<double> intensities, probabilities;
  std::vector<std::optional<double>> lower, upper;
  constexpr int points = 41;
  for (int i = 0; fit && i < points; ++i) {
    const double im = fit->theta() * std::exp(fit->beta() * (6.0 * i / (points - 1) - 3));
    const ConfidenceInterval probability = with_curve->probability_interval(im);
    intensities.push_back(im);
    probabilities.push_back(fit->probability(im));
    lower.push_back(probability.lower);
    upper.push_back(probability.upper);
  }
  out.when(there);
  out.object("curve", "fragility curve with its interval", [&] {
    out.numbers("intensity", intensities, intensity_unit, "intensities");
    out.numbers("probability", probabilities, "1", "probability that the limit is exceeded");
    out.numbers_or_null("lower", lower, "1", "lower end of the interval; null: unbounded");
    out.numbers_or_null("upper", upper, "1", "upper end of the interval; null: unbounded");
  });
}

void write_bootstrap(ResultWriter& out, const OrRefused<Bootstrap>& result) {
  const Bootstrap* bootstrap = std::get_if<Bootstrap>(&result);
  const bool there = bootstrap != nullptr || out.is_schema();
  out.flag("known", bootstrap != nullptr, "whether at least half of the draws have a fit");
  out.text("reason", bootstrap ? "" : std::get<Refused>(result).reason, "why not");
  out.when(there).count("draws", bootstrap ? bootstrap->draws() : 0, "draws that have a fit");
  out.when(there).count("refused", bootstrap ? bootstrap->refused() : 0, "draws that have none, which are left out");
  out.when(there).number("se_log_theta", bootstrap ? bootstrap->se_log_theta() : 0, "1", "standard deviation of ln theta");
  out.when(there).number("se_beta", bootstrap ? bootstrap->se_beta() : 0, "1", "standard deviation of beta");
  out.when(there).number("correlation", bootstrap ? bootstrap->correlation() : 0, "1", "correlation of both");
  if (!there) return;
  out.when(there);
  write_interval(out, "theta_interval", bootstrap ? bootstrap->theta(study_confidence) : ConfidenceInterval{}, intensity_unit,
                 "percentiles of theta; runs count as independent");
  out.when(there);
  write_interval(out, "beta_interval", bootstrap ? bootstrap->beta(study_confidence) : ConfidenceInterval{}, "1", "percentiles of beta");
}

void write_capacity_end(ResultWriter& out, std::string_view key, const std::optional<RecordCapacity>& capacity, std::string_view meaning) {
  out.object(key, meaning, [&] {
    out.word("known", capacity ? word_of(capacity->known) : "nothing", {"exact", "at_least", "at_most", "nothing"}, "what is known of it");
    out.number_or_null("intensity", capacity ? std::optional(capacity->im) : std::nullopt, intensity_unit, "intensity");
  });
}

void write_capacity(ResultWriter& out, const StudyDocument& study, const StudyCapacity& capacity) {
  const bool known = capacity.curve < study.curves.size();
  out.text("motion", known ? study.curves[capacity.curve].motion : "", "motion");
  out.count("sample", known ? study.curves[capacity.curve].sample : 0, "sample, from 0");
  out.flag("found", capacity.found, "whether the search is complete");
  write_capacity_end(out, "capacity", capacity.left_out, "without runs of unknown outcome");
  write_capacity_end(out, "unknown_survived", capacity.survived, "with these runs counted as survived");
  write_capacity_end(out, "unknown_exceeded", capacity.exceeded, "with these runs counted as exceeded");
  out.numbers("resurrections", capacity.resurrections, intensity_unit, "intensities of survivals above the capacity");
}

void write_dispersion(ResultWriter& out, const OrRefused<TwoWayLayout>& result) {
  const TwoWayLayout* layout = std::get_if<TwoWayLayout>(&result);
  const bool there = layout != nullptr || out.is_schema();
  const TwoWayLayout shown = layout ? *layout : TwoWayLayout{};
  const SeismicCapacity capacity = layout ? layout->capacity() : SeismicCapacity{};
  out.flag("known", layout != nullptr, "whether motions and samples can be told apart");
  out.text("reason", layout ? "" : std::get<Refused>(result).reason, "why not");
  out.when(there).number("median", shown.median, intensity_unit, "median capacity A_m");
  out.when(there).number("beta_r", capacity.beta_r, "1", "randomness: between motions, with the interaction");
  out.when(there).number("beta_u", capacity.beta_u, "1", "uncertainty: between samples");
  out.when(there).number("hclpf", capacity.hclpf(), intensity_unit, "A_m exp(-1.65 (beta_r + beta_u))");
}

void write_fractiles(ResultWriter& out, const IdaFractiles& fractiles) {
  out.numbers("demands", fractiles.demands, limit_unit, "demands up to the limit");
  out.numbers_or_null("p16", fractiles.p16, intensity_unit,
                      "intensity at which 16 % of the curves have reached it; null: so many never do");
  out.numbers_or_null("p50", fractiles.p50, intensity_unit, "median");
  out.numbers_or_null("p84", fractiles.p84, intensity_unit, "intensity at which 84 % of the curves have reached it");
}

void write_limit(ResultWriter& out, const StudyDocument& study, const StudyDocument::Limit& each) {
  const StudyLimit& limit = each.limit;
  const StudyLimitFit& fit = each.fit;
  out.text("name", limit.name, "name");
  out.text("quantity", limit.quantity ? limit.quantity->name : "", "number of the verdict; empty: overturning and separation alone");
  out.text("label", limit.quantity ? limit.quantity->brief : "overturned or separated", "quantity in words");
  out.text("of", limit.of, "interface or beam; empty: the worst of all");
  out.text("unit", limit.quantity ? limit.quantity->unit : "", "unit of the limit and of demands");
  out.number("limit", limit.limit, limit_unit, "limit");
  out.flag("at_least", limit.quantity && limit.quantity->at_least, "whether smaller numbers exceed it");
  out.text("source", limit.source, "where the limit comes from");
  out.count("survived", fit.survived, "runs that survived");
  out.count("exceeded", fit.exceeded, "runs that exceeded it");
  out.count("unknown", fit.unknown, "runs of unknown outcome");
  out.list("capacities", "of methods that search: one for each curve", fit.capacities,
           [&](const StudyCapacity& capacity) { write_capacity(out, study, capacity); });
  out.list("stripes", "of stripes: counts at every intensity", fit.stripes, [&](const Stripe& stripe) {
    out.number("intensity", stripe.im, intensity_unit, "intensity");
    out.count("runs", stripe.runs, "runs");
    out.count("exceeded", stripe.exceeded, "runs that exceeded the limit");
    out.count("unknown", stripe.unknown, "runs of unknown outcome");
  });
  out.when(fit.regression.has_value() || out.is_schema()).object("regression", "of a cloud: ln demand = a + b ln intensity", [&] {
    const CloudFit cloud = fit.regression.value_or(CloudFit{});
    out.number("a", cloud.a, "1", "constant");
    out.number("b", cloud.b, "1", "slope");
    out.number("sigma", cloud.sigma, "1", "standard deviation of ln demand");
    out.count("without_demand", fit.without_demand, "runs with demand 0, which has no logarithm: they count as at most the limit");
  });
  out.number("confidence", study_confidence, "1", "confidence of all intervals");
  out.object("fit", "lognormal fragility without runs of unknown outcome, where both ends are near enough",
             [&] { write_fit(out, fit.fit.middle, &fit); });
  out.object("unknown_survived", "with runs of unknown outcome counted as survived", [&] { write_fit(out, fit.fit.survived, nullptr); });
  out.object("unknown_exceeded", "with runs of unknown outcome counted as exceeded", [&] { write_fit(out, fit.fit.exceeded, nullptr); });
  out.object("dispersion", "scatter of the runs from motion to motion and from sample to sample",
             [&] { write_dispersion(out, fit.layout); });
  out.object("capacity", "capacity as nuclear practice states it, with the factors of safety of the plan",
             [&] { write_capacity(out, fit); });
  out.when(study.plan.bootstrap > 0 || out.is_schema())
      .object("bootstrap", "parametric bootstrap of the fit: data sets drawn from it and fitted again",
              [&] { write_bootstrap(out, fit.bootstrap); });
  const StudySite& site = study.plan.site;
  out.when(site.design.has_value() || out.is_schema()).object("performance", "probabilities that the limit is exceeded, by the fit", [&] {
    write_performance(out, site, fit);
  });
  out.when(!site.hazard.empty() || out.is_schema()).object("risk", "convolution of the fit with the hazard curve", [&] {
    write_risk(out, site, fit);
  });
  out.when(fit.fractiles.has_value() || out.is_schema())
      .object("fractiles", "of searches: fractiles of the curves of all motions and samples",
              [&] { write_fractiles(out, fit.fractiles.value_or(IdaFractiles{})); });
  out.list("tornado", "how each variable moves the capacity, or the demand where none is searched", fit.tornado,
           [&](const StudyInfluence& influence) {
             out.text("variable", influence.variable < study.plan.variables.size() ? study.plan.variables[influence.variable].name : "",
                      "variable");
             out.number("low", influence.low, "of intensity, or of the demand",
                        "geometric mean over the third of the samples with its smallest values");
             out.number("high", influence.high, "of intensity, or of the demand", "over the third with its largest values");
           });
  out.object("tornado_basis", "on what `tornado` rests", [&] {
    out.count("samples", fit.tornado_samples,
              "samples that are compared: those with a known response, and in a crossed study with motions in common");
    out.count("responses", fit.tornado_responses, "capacities, or demands of completed runs, that are compared");
    out.text("reason", fit.no_tornado, "why there is no tornado; empty: there is one, or no variable");
  });
}

void write_floor(ResultWriter& out, const StudyFloor& floor) {
  out.text("floor", floor.floor, "floor");
  out.number("damping", floor.damping, "1", "damping ratio of the equipment");
  out.number("level", floor.level, intensity_unit, "intensity; of a cloud the factor on the motions");
  out.count("runs", floor.runs, "runs");
  out.count("lost", floor.lost, "of these, runs that overturned or separated: their spectra are those up to there");
  out.count("missing", floor.missing, "further runs, without an outcome: they have no spectra");
  out.numbers("frequencies", floor.frequencies, "Hz", "frequencies; empty: no run of the level has a spectrum");
  out.numbers("p16", floor.p16, "m/s2", "pseudo-acceleration that 16 % of the runs stay below");
  out.numbers("p50", floor.p50, "m/s2", "median");
  out.numbers("p84", floor.p84, "m/s2", "pseudo-acceleration that 84 % of the runs stay below");
}

/// Runs without a result of the structure.
std::vector<StudyDocument::Run> failures_of(const StudyDocument& study) {
  std::vector<StudyDocument::Run> failures;
  for (const StudyDocument::Curve& curve : study.curves)
    for (const StudyDocument::Run& run : curve.runs)
      if (!says_something(run.outcome)) failures.push_back(run);
  return failures;
}

void write_counts(ResultWriter& out, const StudyDocument& study) {
  std::array<long, std::size(study_outcomes)> counts{};
  for (const StudyDocument::Curve& curve : study.curves)
    for (const StudyDocument::Run& run : curve.runs) ++counts[static_cast<std::size_t>(run.outcome)];
  constexpr std::string_view meanings[] = {"completed",
                                           "overturned: rotation beyond the small-displacement model",
                                           "separated: open everywhere beyond that model",
                                           "a step failed",
                                           "the energy balance is violated beyond the case's limit",
                                           "it took longer than allowed",
                                           "it needed more memory than allowed",
                                           "its process ended"};
  for (std::size_t k = 0; k < counts.size(); ++k) out.count(study_outcomes[k], counts[k], meanings[k]);
}

void write_study(ResultWriter& out, const StudyDocument& study) {
  out.constant("format", "uplift-study-1", "format of this document");
  out.text("name", study.name, "name of the study");
  out.text("title", study.case_title, "title of the case");
  out.flag("complete", !study.curves.empty() && std::ranges::all_of(study.curves, &StudyDocument::Curve::complete),
           "whether no run is missing");
  out.object("provenance", "what it was made from", [&] { write_provenance(out, study); });
  out.object("intensity", "measure of the motions", [&] { write_intensity(out, study.plan.intensity); });
  out.object("method", "which intensities are run", [&] { write_method(out, study.plan.method); });
  out.count("samples", std::ssize(study.samples), "number of samples of the variables");
  out.word("pairing", study.plan.crossed ? "crossed" : "paired", {"crossed", "paired"}, "how samples and motions are combined");
  out.list("motions", "motions", study.motions, [&](const StudyMotion& motion) { write_motion(out, motion); });
  out.list("variables", "uncertain numbers of the case", variables_of(study),
           [&](const Variable& variable) { write_variable(out, variable); });
  write_site(out, study.plan.site);
  write_factors(out, study.plan.site);
  out.object("outcomes", "number of runs by their outcome", [&] { write_counts(out, study); });
  out.list("limits", "limit states", study.limits, [&](const StudyDocument::Limit& limit) { write_limit(out, study, limit); });
  out.list("curves", "runs of every motion and sample", study.curves, [&](const StudyDocument::Curve& curve) { write_curve(out, curve); });
  out.list("failures", "runs without a result of the structure", failures_of(study),
           [&](const StudyDocument::Run& run) { write_failure(out, run); });
  out.list("floor_spectra", "percentiles of floor spectra", study.floors, [&](const StudyFloor& floor) { write_floor(out, floor); });
}

}  // namespace

StudyDocument study_document(const StudyCase& study, const std::vector<StudyCurve>& curves) {
  StudyDocument made;
  made.case_title = study.read.input->title;
  made.plan = study.plan;
  made.motions = study.motions;
  made.samples = study.samples;
  for (const StudyCurve& curve : curves) {
    StudyDocument::Curve& one = made.curves.emplace_back();
    one.motion = study.motions[curve.motion()].name;
    one.sample = static_cast<long>(curve.sample());
    one.complete = curve.complete();
    for (const auto& [intensity, run] : curve.runs()) {
      StudyDocument::Run& now = one.runs.emplace_back();
      now.id = run.point.id;
      now.intensity = intensity;
      now.factor = run.point.factor;
      now.outcome = run.result->outcome;
      now.reason = run.result->reason;
      now.motion = one.motion;
      now.sample = one.sample;
      const std::string folder = "runs/" + now.id.substr(0, 16);
      if (!says_something(now.outcome)) now.case_file = folder + "/case.resolved.toml";
      if (run.result->replay) now.problem_file = folder + "/problem.json";
      for (const StudyLimit& limit : study.plan.limits) {
        now.demands.push_back(demand_of(limit, *run.result));
        now.states.push_back(outcome_of(limit, *run.result));
      }
    }
  }
  for (std::size_t k = 0; k < study.plan.limits.size(); ++k) made.limits.push_back({study.plan.limits[k], fit_limit(study, curves, k)});
  made.floors = floor_percentiles(study, curves);
  return made;
}

std::string study_json(const StudyDocument& study) {
  JsonWriter json(0, 2);
  json.begin_object();
  ResultWriter out(json);
  write_study(out, study);
  json.end_object();
  return json.take() + "\n";
}

std::string study_schema() {
  ResultWriter out("study.json", "Results of a study. Numbers are in SI units where no other unit is stated.");
  write_study(out, {});
  return out.schema();
}

}  // namespace uplift
