#include "uplift/study/study_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "uplift/statistics/sample_effects.h"

namespace uplift {
namespace {

void count_runs(const StudyLimit& limit, const std::vector<StudyCurve>& curves, StudyLimitFit& fit) {
  for (const StudyCurve& curve : curves)
    for (const auto& [intensity, run] : curve.runs()) {
      const RunOutcome outcome = outcome_of(limit, *run.result);
      ++(outcome == RunOutcome::survived ? fit.survived : outcome == RunOutcome::exceeded ? fit.exceeded : fit.unknown);
    }
}

/// Whether runs were completed and none has the number of the limit, as a sliding safety without friction: it says nothing of the
/// structure.
bool lacks_number(const StudyLimit& limit, const std::vector<StudyCurve>& curves) {
  bool completed = false;
  if (limit.quantity == nullptr) return false;
  for (const StudyCurve& curve : curves)
    for (const auto& [intensity, run] : curve.runs()) {
      if (demand_of(limit, *run.result)) return false;
      completed = completed || run.result->outcome == StudyOutcome::completed;
    }
  return completed;
}

// ---- capacities ----

std::optional<RecordCapacity> capacity_of(const CapacitySearch& search, Unknown unknown) {
  std::optional<RecordCapacity> capacity = search.capacity(unknown);
  if (capacity && capacity->known == Known::exact && !capacity->largest) capacity->largest = search.plan().largest;
  return capacity;
}

void fit_searches(const std::vector<StudyCurve>& curves, std::size_t limit, StudyLimitFit& fit) {
  std::vector<RecordCapacity> survived, left_out, exceeded;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (curves[i].runs().empty()) continue;
    const CapacitySearch& search = curves[i].searches()[limit];
    StudyCapacity one{i,
                      capacity_of(search, Unknown::survived),
                      capacity_of(search, Unknown::left_out),
                      capacity_of(search, Unknown::exceeded),
                      search.found(),
                      search.resurrections()};
    if (one.survived) survived.push_back(*one.survived);
    if (one.left_out) left_out.push_back(*one.left_out);
    if (one.exceeded) exceeded.push_back(*one.exceeded);
    fit.capacities.push_back(std::move(one));
  }
  fit.fit = both_ways(fit_capacities(survived), fit_capacities(left_out), fit_capacities(exceeded), study_confidence);
}

/// Motions in rows, samples in columns.
OrRefused<TwoWayLayout> layout_of(const StudyCase& study, const std::vector<StudyCurve>& curves,
                                  const std::vector<StudyCapacity>& capacities) {
  const auto rows = static_cast<Index>(study.motions.size()), columns = static_cast<Index>(study.samples.size());
  if (!study.plan.crossed || rows < 2 || columns < 2) return Refused{"it takes two samples and two motions at least, crossed"};
  if (static_cast<Index>(capacities.size()) < rows * columns) return Refused{"not all curves have runs"};
  Matrix table(rows, columns);
  for (const StudyCapacity& each : capacities) {
    if (!each.left_out || each.left_out->known != Known::exact) return Refused{"not all capacities are known exactly"};
    table(static_cast<Index>(curves[each.curve].motion()), static_cast<Index>(curves[each.curve].sample())) = each.left_out->im;
  }
  return two_way_layout(table);
}

/// Up to the limit: beyond it few curves have runs.
std::optional<IdaFractiles> fractiles_of(const StudyLimit& limit, const std::vector<StudyCurve>& curves) {
  constexpr int count = 40;
  if (limit.quantity == nullptr || limit.quantity->at_least || !(limit.limit > 0)) return std::nullopt;
  std::vector<std::vector<IdaPoint>> all;
  for (const StudyCurve& curve : curves) {
    std::vector<IdaPoint> points;
    for (const auto& [intensity, run] : curve.runs()) {
      const std::optional<double> demand = demand_of(limit, *run.result);
      const StudyOutcome outcome = run.result->outcome;
      if (outcome_of(limit, *run.result) == RunOutcome::unknown) continue;
      points.push_back(
          {intensity, demand ? std::abs(*demand) : 0, outcome == StudyOutcome::overturned || outcome == StudyOutcome::separated});
    }
    if (!points.empty()) all.push_back(std::move(points));
  }
  if (all.size() < 3) return std::nullopt;
  std::vector<double> demands;
  for (int i = 1; i <= count; ++i) demands.push_back(limit.limit * i / count);
  return ida_fractiles(all, std::move(demands));
}

// ---- stripes and clouds ----

SharedRun shared_run(const StudyCurve& curve, SharedRun run) {
  run.motion = static_cast<long>(curve.motion());
  run.sample = static_cast<long>(curve.sample());
  return run;
}

void fit_stripes_of(const StudyLimit& limit, const std::vector<StudyCurve>& curves, StudyLimitFit& fit) {
  std::map<double, Stripe> stripes;
  std::vector<SharedRun> runs;
  for (const StudyCurve& curve : curves)
    for (const auto& [intensity, run] : curve.runs()) {
      Stripe& stripe = stripes[intensity];
      stripe.im = intensity;
      ++stripe.runs;
      const RunOutcome outcome = outcome_of(limit, *run.result);
      stripe.exceeded += outcome == RunOutcome::exceeded;
      stripe.unknown += outcome == RunOutcome::unknown;
      if (outcome != RunOutcome::unknown) runs.push_back(shared_run(curve, {intensity, outcome == RunOutcome::exceeded}));
    }
  for (const auto& [intensity, stripe] : stripes) fit.stripes.push_back(stripe);
  if (fit.stripes.empty()) return;
  fit.fit = fit_stripes_both_ways(fit.stripes, study_confidence);
  if (const Fragility* curve = std::get_if<Fragility>(&fit.fit.middle)) fit.shared = shared_error_of_stripes(*curve, runs);
}

/// Demands of runs that ended early are lower bounds where they are demands at all; a lost structure has at least the limit. Runs of
/// unknown outcome have at most the limit where they count as survived, at least the limit where they count as exceeded. A demand of 0,
/// which has no logarithm, is at most the limit: the run has survived.
void fit_cloud_of(const StudyLimit& limit, const std::vector<StudyCurve>& curves, StudyLimitFit& fit) {
  std::vector<SharedRun> runs;
  std::vector<double> unknown;  // intensities
  for (const StudyCurve& curve : curves)
    for (const auto& [intensity, run] : curve.runs()) {
      const std::optional<double> demand = demand_of(limit, *run.result);
      const StudyOutcome outcome = run.result->outcome;
      const double size = demand ? std::abs(*demand) : 0;
      const auto add = [&](double reached, bool at_least, bool at_most = false) {
        fit.cloud.push_back({intensity, reached, at_least, at_most});
        SharedRun shared{intensity, false, reached, at_least};
        shared.at_most = at_most;
        runs.push_back(shared_run(curve, shared));
      };
      if (outcome == StudyOutcome::completed && size == 0) ++fit.without_demand, add(limit.limit, false, true);
      if (outcome == StudyOutcome::completed && size > 0) add(size, false);
      if (outcome == StudyOutcome::overturned || outcome == StudyOutcome::separated) add(std::max(size, limit.limit), true);
      const RunOutcome counted = outcome_of(limit, *run.result);
      if (counted == RunOutcome::exceeded && !says_something(outcome)) add(size, true);
      if (counted == RunOutcome::unknown) unknown.push_back(intensity);
    }
  OrRefused<CloudFit> made = fit_cloud(fit.cloud, limit.limit);
  if (const Refused* refused = std::get_if<Refused>(&made)) {
    fit.fit = {*refused, *refused, *refused};
    return;
  }
  fit.regression = std::get<CloudFit>(std::move(made));
  // without bounds the middle is by least squares, with m - 2; both ends are by likelihood, with m
  const auto exact = static_cast<double>(fit.cloud.size());
  const bool bounds = std::ranges::any_of(fit.cloud, [](const CloudPoint& each) { return each.at_least || each.at_most; });
  const double scatter = bounds ? 1 : std::sqrt(exact / (exact - 2));
  const auto with_unknown = [&](bool exceeded) -> OrRefused<Fragility> {
    std::vector<CloudPoint> points = fit.cloud;
    for (const double intensity : unknown) points.push_back({intensity, limit.limit, exceeded, !exceeded});
    OrRefused<CloudFit> all = fit_cloud(points, limit.limit, scatter);
    if (const Refused* refused = std::get_if<Refused>(&all)) return *refused;
    return std::get<CloudFit>(std::move(all)).fragility;
  };
  fit.fit = both_ways(with_unknown(false), fit.regression->fragility, with_unknown(true), study_confidence);
  if (std::holds_alternative<Fragility>(fit.fit.middle)) fit.shared = shared_error_of_cloud(*fit.regression, limit.limit, runs);
}

// ---- tornado ----

/// What is known of the response of the samples: capacities, or else the demands of completed runs (that of a lost structure is one of
/// the instant at which the run ended). Logarithms by motion and intensity, then by sample.
std::map<std::pair<std::size_t, double>, std::map<std::size_t, double>> known_responses(const StudyLimit& limit,
                                                                                        const std::vector<StudyCurve>& curves,
                                                                                        const std::vector<StudyCapacity>& capacities) {
  std::map<std::pair<std::size_t, double>, std::map<std::size_t, double>> logarithms;
  const auto add = [&](const StudyCurve& curve, double intensity, double value) {
    if (value > 0) logarithms[{curve.motion(), intensity}][curve.sample()] = std::log(value);
  };
  for (const StudyCapacity& each : capacities)
    if (each.left_out && each.left_out->known == Known::exact) add(curves[each.curve], 0, each.left_out->im);
  if (!capacities.empty()) return logarithms;
  for (const StudyCurve& curve : curves)
    for (const auto& [intensity, run] : curve.runs())
      if (const std::optional<double> demand = demand_of(limit, *run.result); demand && run.result->outcome == StudyOutcome::completed)
        add(curve, intensity, std::abs(*demand));
  return logarithms;
}

/// Mean logarithm of the response of every sample, and on what it rests. Crossed samples are compared under the same motions at the same
/// intensities, by the effects of both; paired ones have motions of their own.
ColumnMeans responses(const StudyCase& study, const StudyLimit& limit, const std::vector<StudyCurve>& curves,
                      const std::vector<StudyCapacity>& capacities) {
  std::vector<LayoutCell> cells;
  std::size_t rows = 0;
  for (const auto& [motion, of_samples] : known_responses(limit, curves, capacities)) {
    for (const auto& [sample, logarithm] : of_samples) cells.push_back({rows, sample, logarithm});
    ++rows;
  }
  if (study.plan.crossed) return column_means(cells, rows, study.samples.size());
  std::vector<double> sum(study.samples.size()), count(study.samples.size());
  for (const LayoutCell& cell : cells) sum[cell.column] += cell.value, count[cell.column] += 1;
  ColumnMeans made{std::vector<std::optional<double>>(sum.size()), 0, std::ssize(cells)};
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (count[i] > 0) made.mean[i] = sum[i] / count[i], ++made.columns;
  return made;
}

std::vector<StudyInfluence> tornado_of(const StudyCase& study, const std::vector<std::optional<double>>& response) {
  std::vector<StudyInfluence> tornado;
  for (std::size_t v = 0; v < study.plan.variables.size(); ++v) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < response.size(); ++i)
      if (response[i]) order.push_back(i);
    const std::size_t third = order.size() / 3;
    if (third == 0) continue;
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return study.samples[i].values[v]; });
    const auto mean = [&](std::size_t begin) {
      double sum = 0;
      for (std::size_t k = begin; k < begin + third; ++k) sum += *response[order[k]];
      return std::exp(sum / static_cast<double>(third));
    };
    tornado.push_back({v, mean(0), mean(order.size() - third)});
  }
  std::ranges::stable_sort(tornado, std::greater{}, [](const StudyInfluence& each) { return std::abs(std::log(each.high / each.low)); });
  return tornado;
}

}  // namespace

ConfidenceInterval StudyLimitFit::theta_interval() const {
  if (const TwoWayLayout* crossed = std::get_if<TwoWayLayout>(&layout)) return crossed->median_interval(study_confidence);
  const Fragility& curve = std::get<Fragility>(fit.middle);
  ConfidenceInterval made = curve.theta_interval(study_confidence);
  const SharedError* error = std::get_if<SharedError>(&shared);
  if (error == nullptr) return made;
  const ConfidenceInterval wider = error->theta_interval(curve.theta(), study_confidence);
  if (made.lower) made.lower = std::min(*made.lower, *wider.lower);
  if (made.upper) made.upper = std::max(*made.upper, *wider.upper);
  return made;
}

ConfidenceInterval StudyLimitFit::probability_interval(double im) const {
  const Fragility& curve = std::get<Fragility>(fit.middle);
  ConfidenceInterval made = curve.probability_interval(im, study_confidence);
  if (!std::holds_alternative<TwoWayLayout>(layout) && !std::holds_alternative<SharedError>(shared)) return made;
  const ConfidenceInterval median = theta_interval();
  const auto moved = [&](double theta) { return normal_cdf(std::log(im / theta) / curve.beta()); };
  if (made.lower && median.upper) made.lower = std::min(*made.lower, moved(*median.upper));
  if (made.upper && median.lower) made.upper = std::max(*made.upper, moved(*median.lower));
  return made;
}

StudyLimitFit fit_limit(const StudyCase& study, const std::vector<StudyCurve>& curves, std::size_t number) {
  StudyLimitFit fit;
  const StudyLimit& limit = study.plan.limits[number];
  count_runs(limit, curves, fit);
  if (lacks_number(limit, curves)) {
    const Refused refused{"no run has the number " + std::string(limit.quantity->name) + ", so that none can exceed its limit"};
    fit.fit = {refused, refused, refused};
    fit.capacity = refused;
    return fit;
  }
  if (study.plan.method.searches()) {
    fit_searches(curves, number, fit);
    fit.layout = layout_of(study, curves, fit.capacities);
    fit.fractiles = fractiles_of(limit, curves);
  } else if (study.plan.method.type == StudyMethod::Type::stripes) {
    fit_stripes_of(limit, curves, fit);
  } else {
    fit_cloud_of(limit, curves, fit);
  }
  if (const Fragility* curve = std::get_if<Fragility>(&fit.fit.middle); curve && study.plan.bootstrap > 0)
    fit.bootstrap = curve->bootstrap(study.plan.seed, study.plan.bootstrap);
  fit.capacity = seismic_capacity(study.plan.site, fit, !study.plan.variables.empty());
  if (study.plan.variables.empty()) return fit;
  const ColumnMeans response = responses(study, limit, curves, fit.capacities);
  fit.tornado = tornado_of(study, response.mean);
  fit.tornado_samples = response.columns, fit.tornado_responses = response.cells;
  if (fit.tornado.empty())
    fit.no_tornado = "it takes three samples at least whose " + std::string(fit.capacities.empty() ? "demand" : "capacity") + " is known" +
                     (study.plan.crossed ? " under common motions" : "") + ", and there are " + std::to_string(response.columns);
  return fit;
}

std::optional<PerformancePair> performance_of(const StudySite& site, const OrRefused<Fragility>& curve) {
  const Fragility* fit = std::get_if<Fragility>(&curve);
  if (!site.design || fit == nullptr) return std::nullopt;
  return performance_pair(*site.design, fit->theta(), fit->beta());
}

OrRefused<AnnualRisk> risk_of(const StudySite& site, const OrRefused<Fragility>& curve) {
  if (const Refused* refused = std::get_if<Refused>(&curve)) return *refused;
  const Fragility& fit = std::get<Fragility>(curve);
  return risk_of_curve(site.hazard, fit.theta(), fit.beta());
}

OrRefused<SeismicCapacity> seismic_capacity(const StudySite& site, const StudyLimitFit& fit, bool sampled) {
  SeismicCapacity of_runs;
  if (const TwoWayLayout* layout = std::get_if<TwoWayLayout>(&fit.layout)) {
    of_runs = layout->capacity();
  } else {
    if (sampled) return std::get<Refused>(fit.layout);
    if (const Refused* refused = std::get_if<Refused>(&fit.fit.middle)) return *refused;
    if (std::ranges::none_of(site.factors, [](const SafetyFactor& factor) { return factor.beta_u > 0; }))
      return Refused{"nothing says how uncertain it is: samples of variables, crossed with the motions, or [[factor]] tables with beta_u"};
    const Fragility& curve = std::get<Fragility>(fit.fit.middle);
    of_runs = {curve.theta(), curve.beta(), 0};
  }
  std::vector<SafetyFactor> factors = site.factors;
  factors.push_back({"the runs", 1, of_runs.beta_r, of_runs.beta_u});
  return separation_of_variables(of_runs.median, factors);
}

std::optional<PerformancePair> composite_performance_of(const StudySite& site, const OrRefused<SeismicCapacity>& capacity) {
  const SeismicCapacity* known = std::get_if<SeismicCapacity>(&capacity);
  if (!site.design || known == nullptr) return std::nullopt;
  return performance_pair(*site.design, known->median, known->beta_c());
}

OrRefused<AnnualRisk> composite_risk_of(const StudySite& site, const OrRefused<SeismicCapacity>& capacity) {
  if (const Refused* refused = std::get_if<Refused>(&capacity)) return *refused;
  const SeismicCapacity& known = std::get<SeismicCapacity>(capacity);
  return risk_of_curve(site.hazard, known.median, known.beta_c());
}

std::vector<StudyFloor> floor_percentiles(const StudyCase& study, const std::vector<StudyCurve>& curves) {
  if (study.plan.method.searches()) return {};  // every motion has intensities of its own
  struct Runs {
    StudyFloor floor;
    std::vector<const StudySpectrum*> spectra;
  };
  std::map<std::tuple<double, std::string, double>, Runs> groups;
  std::map<double, long> missing;
  for (const StudyCurve& curve : curves)
    for (const auto& [intensity, run] : curve.runs()) {
      const std::vector<double>& levels = study.plan.method.levels;
      const double asked = study.plan.method.type == StudyMethod::Type::cloud ? run.point.factor : intensity;
      const double level = *std::ranges::min_element(levels, {}, [&](double each) { return std::abs(each - asked); });  // round-off
      missing[level] += !says_something(run.result->outcome);
      for (const StudySpectrum& spectrum : run.result->spectra) {
        Runs& group = groups[{level, spectrum.floor, spectrum.damping}];
        if (group.spectra.empty()) group.floor = {spectrum.floor, spectrum.damping, level, 0, 0, 0, spectrum.frequencies, {}, {}, {}};
        if (spectrum.frequencies != group.floor.frequencies) continue;
        group.spectra.push_back(&spectrum);
        group.floor.lost += run.result->outcome != StudyOutcome::completed;
      }
    }
  std::set<std::pair<std::string, double>> floors;
  for (const auto& [key, group] : groups) floors.emplace(std::get<1>(key), std::get<2>(key));
  for (const auto& [level, count] : missing)  // where all runs failed there are no spectra, which is stated
    for (const auto& [floor, damping] : floors)
      if (Runs& group = groups[{level, floor, damping}]; group.spectra.empty())
        group.floor = {floor, damping, level, 0, 0, 0, {}, {}, {}, {}};
  std::vector<StudyFloor> made;
  for (auto& [key, group] : groups) {
    StudyFloor& floor = group.floor;
    floor.runs = std::ssize(group.spectra);
    floor.missing = missing[floor.level];
    std::vector<double> values(group.spectra.size());
    for (std::size_t f = 0; f < floor.frequencies.size(); ++f) {
      std::ranges::transform(group.spectra, values.begin(), [&](const StudySpectrum* spectrum) { return spectrum->values[f]; });
      std::ranges::sort(values);
      floor.p16.push_back(percentile(values, 0.16));
      floor.p50.push_back(percentile(values, 0.5));
      floor.p84.push_back(percentile(values, 0.84));
    }
    made.push_back(std::move(floor));
  }
  return made;
}

}  // namespace uplift
