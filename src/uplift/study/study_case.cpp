#include "uplift/study/study_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <set>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/case/build/names.h"
#include "uplift/case/decided.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/case/schema/sections.h"
#include "uplift/motion/spectrum.h"
#include "uplift/statistics/latin_hypercube.h"
#include "uplift/study/study_generated.h"
#include "uplift/study/study_motions.h"

namespace uplift {
namespace {

// ---- motions ----

/// The record whose intensity is that of the motion; null where a function drives.
const CaseRecord* measured_record(const StudyCase& study, const CaseOtherMotion* given, const CaseTable& place) {
  std::vector<std::string> driving;
  for (const DrivenBy& each : motions_wanted(study.read)) driving.push_back(each.function.name);
  std::string name = study.plan.intensity.of;
  if (name.empty()) name = given ? given->replace.front() : driving.empty() ? "" : driving.front();
  if (std::ranges::find(driving, name) == driving.end())
    fail(place, "of", "the name of a record or function that drives the case", in_quotes(name), nearest_name(name, driving));
  const auto found = std::ranges::find(study.read.records, name_taken(given, name), &CaseRecord::name);
  return found == study.read.records.end() ? nullptr : &*found;
}

double intensity_at_one(const IntensityMeasure& measure, const Motion& acceleration, const Intensity& all) {
  switch (measure.kind) {
    case IntensityMeasure::Kind::pga:
      return all.pga / measure.in_si;
    case IntensityMeasure::Kind::pgv:
      return all.pgv / measure.in_si;
    case IntensityMeasure::Kind::sa:
      return response_spectra(acceleration.values, acceleration.step, {1 / measure.period}, {measure.damping}, Spectrum::Kind::psa, 1)[0]
                 .values[0] /
             measure.in_si;
    case IntensityMeasure::Kind::factor:
      break;
  }
  return 1;
}

std::string bytes_of(const Motion& motion) {
  std::string bytes(to_string(motion.kind));
  const auto add = [&](double value) { bytes += fmt::format("{:016x}", std::bit_cast<std::uint64_t>(value)); };
  add(motion.step);
  for (const double value : motion.values) add(value);
  return bytes;
}

/// Of everything that takes a place, in the order of the plan.
std::string motion_hash(const StudyCase& study, const CaseOtherMotion* given) {
  if (!given) return sha256("the motion of the case");
  std::string text;
  for (std::size_t i = 0; i < given->replace.size(); ++i) {
    const std::string& by = given->by[i];
    const auto record = std::ranges::find(study.read.records, by, &CaseRecord::name);
    text += given->replace[i] + "\n" + (record == study.read.records.end() ? by : sha256(bytes_of(record->motion()))) + "\n";
  }
  return sha256(text);
}

StudyMotion motion_of(const StudyCase& study, const CaseOtherMotion* given) {
  StudyMotion motion;
  motion.given = given;
  motion.name = given ? given->name.name : "own";
  motion.label = given ? given->label : "motion of the case";
  motion.hash = motion_hash(study, given);
  const CaseTable& place = study.plan.intensity.given;
  const CaseRecord* record = measured_record(study, given, place);
  if (!record) {
    if (study.plan.intensity.kind != IntensityMeasure::Kind::factor)
      fail(place, "measure", "\"factor\" for a motion that is a function, or a record in its place", in_quotes(study.plan.intensity.word));
    return motion;
  }
  const Motion& acceleration = *giving(record->history, MotionKind::acceleration)->motion();
  motion.record = record->name;
  motion.step = acceleration.step;
  motion.duration = acceleration.duration();
  motion.measures = intensity_of(acceleration);
  motion.intensity = intensity_at_one(study.plan.intensity, acceleration, motion.measures);
  if (!(motion.intensity > 0)) fail(place, "measure", "records that are not zero throughout", "the record " + in_quotes(record->name));
  return motion;
}

// ---- samples ----

/// Units of the variables, and the distributions of their values.
void resolve_variables(StudyCase& study) {
  std::set<std::string> known;
  for (StudyVariable& variable : study.plan.variables) {
    for (const std::string& path : variable.paths) {
      std::string nearest;
      const std::optional<NumberAt> number = number_at(study.read.values, path, &nearest);
      if (!number) fail(variable.given, "paths", "paths of numbers of the case, as \"interface[0].law.K_n\"", in_quotes(path), nearest);
      if (path.starts_with("record") || path.starts_with("compare"))
        fail(variable.given, "paths", "no number of a record: a study has motions", in_quotes(path));
      if (variable.is_factor && number->value == 0) fail(variable.given, "paths", "numbers that are not 0, for a factor", in_quotes(path));
      if (!known.insert(path).second) fail(variable.given, "paths", "numbers that are set once", in_quotes(path) + " again");
      study.edits_mesh = study.edits_mesh || path.starts_with("mesh") || path.find(".cut") != path.npos;
      const std::string unit(variable.is_factor ? "1" : number->field->unit);
      if (path != variable.paths.front() && unit != variable.unit)
        fail(variable.given, "paths", fmt::format("numbers of the unit {}", variable.unit), in_quotes(path));
      variable.unit = unit;
    }
    variable.distribution = distribution_of(variable);
  }
}

/// Probabilities: samples x variables.
Matrix draw(const StudyPlan& plan) {
  const auto count = static_cast<Index>(plan.variables.size());
  if (plan.samples == 1) return Matrix::Constant(1, count, 0.5);  // the medians
  if (plan.correlations.empty()) return latin_hypercube(plan.samples, count, plan.seed).probability;
  Matrix target = Matrix::Identity(count, count);
  for (const StudyCorrelation& each : plan.correlations)
    target(static_cast<Index>(each.first), static_cast<Index>(each.second)) =
        target(static_cast<Index>(each.second), static_cast<Index>(each.first)) = each.value;
  OrRefused<LatinHypercube> drawn = latin_hypercube(plan.samples, target, plan.seed);
  if (const Refused* refused = std::get_if<Refused>(&drawn))
    fail(plan.correlations.front().given, "", "correlations that can be reached", refused->reason);
  return std::get<LatinHypercube>(drawn).probability;
}

std::vector<StudySample> samples_of(const StudyCase& study, const std::string& resolved) {
  std::vector<StudySample> samples(static_cast<std::size_t>(study.plan.samples));
  const Matrix probability = study.plan.variables.empty() ? Matrix() : draw(study.plan);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    StudySample& sample = samples[i];
    std::string text = resolved;
    for (std::size_t k = 0; k < study.plan.variables.size(); ++k) {
      const StudyVariable& variable = study.plan.variables[k];
      sample.values.push_back(quantile(variable.distribution, probability(static_cast<Index>(i), static_cast<Index>(k))));
      for (const std::string& path : variable.paths) {
        const double value = sample.values.back() * (variable.is_factor ? number_at(study.read.values, path)->value : 1);
        sample.edits.push_back({path, value});
        text += fmt::format("{} = {:016x}\n", path, std::bit_cast<std::uint64_t>(value));
      }
    }
    sample.hash = sha256(text);
  }
  return samples;
}

/// The least and the largest value of every variable are such as the case takes: what it refuses is said before any run.
void check_samples(const StudyCase& study) {
  for (std::size_t k = 0; k < study.plan.variables.size(); ++k) {
    const std::vector<std::string>& paths = study.plan.variables[k].paths;
    const auto value_of = [k](const StudySample& sample) { return sample.values[k]; };
    const auto [least, most] = std::ranges::minmax_element(study.samples, {}, value_of);
    for (const auto at : {least, most}) {
      std::vector<CaseEdit> own = at->edits;
      std::erase_if(own, [&](const CaseEdit& edit) { return std::ranges::find(paths, edit.path) == paths.end(); });
      try {
        check(edited(study.raw, own), case_section());
      } catch (const InputError& error) {
        fail(study.plan.variables[k].given, "distribution", "values that the case takes",
             fmt::format("sample {}: {}", at - study.samples.begin(), error.what()));
      }
    }
  }
}

/// The numbers of limits are those of an interface, a foundation or a beam that the case has.
void check_limits(const StudyCase& study) {
  const CaseInput& input = *study.read.input;
  for (const StudyLimit& limit : study.plan.limits) {
    if (limit.quantity == nullptr || (limit.of.empty() && !limit.quantity->of_beam())) continue;
    const CaseTable& table = limit.given;
    std::vector<std::string> known;
    if (limit.quantity->of_beam()) {
      for (const CaseEnvelope& envelope : input.output.envelopes) known.push_back(envelope.beam.name);
      if (known.empty()) fail(table, "quantity", "a case with [[output.beam_envelope]], which gives this number", "none");
    } else {
      for (const CaseInterface& interface : input.interfaces) known.push_back(interface.name.name);
      for (const CaseFoundation& foundation : input.foundations) known.push_back(foundation.name.name);
    }
    if (!limit.of.empty() && std::ranges::find(known, limit.of) == known.end())
      fail(table, "of", listed(known), in_quotes(limit.of), nearest_name(limit.of, known));
  }
}

/// The case with the reduced model of the plan, where the plan names one.
Raw with_reduced_model(const Raw& raw, const Raw& plan) {
  const Raw* own = std::get<std::shared_ptr<RawTable>>(plan.data)->find("reduced_model");
  if (own == nullptr) return raw;
  Raw made = edited(raw, {{"reduced_model", std::string()}});
  auto& entries = std::get<std::shared_ptr<RawTable>>(made.data)->entries;
  std::ranges::find(entries, "reduced_model", [](const auto& entry) -> std::string_view { return entry.first; })->second = *own;
  return made;
}

}  // namespace

std::string identity_of_case(const Raw& raw, const Case& read) {
  Raw what = edited(raw, {{"title", std::string()}, {"description", std::string()}});
  std::erase_if(std::get<std::shared_ptr<RawTable>>(what.data)->entries, [](const auto& entry) { return entry.first == "trust"; });
  const Case own = check_case_like(read, true, what);
  std::string text = to_toml(own.values, decided_texts(own)) + "\n";
  for (const std::string& file : input_files(own))
    text += std::filesystem::path(file).filename().string() + " " + sha256(read_file(file)) + "\n";
  return text;
}

StudyCase study_case(const StudyPlan& plan, const Raw& case_raw, const MeshReader& read_mesh, const std::string& motions) {
  const Raw raw = with_reduced_model(case_raw, plan.raw);
  StudyCase study;
  study.plan = plan;
  study.raw = with_motions(raw, plan.many_motions, plan.raw);
  study.read_mesh = read_mesh;
  const GeneratedRecords generated(study.raw, motions);
  if (generated.any()) {
    if (!generated.kept()) generated.keep(check_case(study.raw, plan.case_file, read_mesh).records);
    study.raw = generated.from_files(study.raw);
  }
  study.read = check_case(study.raw, plan.case_file, read_mesh);
  resolve_variables(study);
  study.samples = samples_of(study, identity_of_case(raw, study.read));
  check_samples(study);
  check_limits(study);
  Names names("motion");
  if (const std::optional<CaseComparison>& compare = study.read.input->compare)
    for (const CaseOtherMotion& motion : compare->motions) {
      names.add(motion.name);
      if (motion.replace.empty()) fail(motion, "replace", "one name at least", "none");
      check_motion(study.read, motion);
      study.motions.push_back(motion_of(study, &motion));
      for (std::size_t k = 0; k + 1 < study.motions.size(); ++k)
        if (study.motions[k].hash == study.motions.back().hash)
          fail(motion, "by", "a motion that differs from all others", fmt::format("that of {} again", in_quotes(study.motions[k].name)));
    }
  if (study.motions.empty()) study.motions.push_back(motion_of(study, nullptr));
  return study;
}

Case case_of_sample(const StudyCase& study, std::size_t sample) {
  return check_case_like(study.read, !study.edits_mesh, edited(study.raw, study.samples[sample].edits), study.read_mesh);
}

RunSpec run_of_study(const StudyCase& study, const Case& sample, std::size_t motion, double factor) {
  RunSpec spec = runs_of_case(sample).front();
  spec.pictures = false;
  spec.motion_factor = factor;
  if (const CaseOtherMotion* given = study.motions[motion].given) {
    const std::vector<CaseOtherMotion>& motions = sample.input->compare->motions;
    spec.motion = &*std::ranges::find(motions, given->name.name, [](const CaseOtherMotion& each) { return each.name.name; });
  }
  return spec;
}

std::string resolved_run(const StudyCase& study, std::size_t sample, std::size_t motion, double factor) {
  const Raw changed = edited(study.raw, study.samples[sample].edits);
  const Raw made = with_one_motion(changed, study.read, study.motions[motion].given, factor);
  const Case read = check_case_like(study.read, true, made, study.read_mesh);
  return to_toml(read.values, decided_texts(read));
}

std::string run_identity(const StudyCase& study, std::size_t sample, std::size_t motion, double factor) {
  return sha256(fmt::format("{} {} {:016x} {}", study.samples[sample].hash, study.motions[motion].hash,
                            std::bit_cast<std::uint64_t>(factor), UPLIFT_VERSION));
}

}  // namespace uplift
