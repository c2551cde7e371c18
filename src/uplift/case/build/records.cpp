#include "uplift/case/build/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <thread>
#include <tuple>

#include "uplift/base/file.h"
#include "uplift/base/format.h"
#include "uplift/base/text.h"
#include "uplift/base/units.h"
#include "uplift/case/build/model.h"
#include "uplift/motion/formats/convert.h"
#include "uplift/motion/formats/read.h"
#include "uplift/motion/generate.h"
#include "uplift/motion/parallel.h"
#include "uplift/motion/processing/processing.h"

namespace uplift {
namespace {

/// The component that the table names, of those in the file, or numbers: channels of a building may all be called "360 Deg".
Motion component_of(const CaseRecordSource& record, std::vector<Motion> motions) {
  std::vector<std::string> known, quoted;
  for (const Motion& each : motions) known.push_back(each.component);
  const auto times = [&](const std::string& name) { return std::ranges::count(known, name); };
  const bool numbered = std::ranges::any_of(known, [&](const std::string& name) { return name.empty() || times(name) > 1; });
  for (std::size_t i = 0; i < known.size(); ++i)
    quoted.push_back(numbered ? fmt::format("\"{}\" ({})", i + 1, in_quotes(known[i])) : in_quotes(known[i]));
  if (!record.component) {
    if (motions.size() > 1) fail(record, "", "component, one of " + listed(quoted) + " in this file", "none");
    return std::move(motions.front());
  }
  const std::string& wanted = record.component->name;
  if (times(wanted) > 1) fail(*record.component, "a number: one of " + listed(quoted), in_quotes(wanted) + ", which several are called");
  for (std::size_t i = 0; i < motions.size(); ++i)
    if (times(wanted) == 0 && wanted == fmt::format("{}", i + 1)) return std::move(motions[i]);
  const auto found = std::ranges::find(known, wanted);
  if (found == known.end())
    fail(*record.component, (known.size() > 1 ? "one of " : "") + listed(quoted), in_quotes(wanted), nearest_name(wanted, known));
  return std::move(motions[static_cast<std::size_t>(found - known.begin())]);
}

Motion read_record(const CaseRecordSource& record) {
  require_file(record.location, record.file->where(), record.file->path());
  try {
    Motion motion = component_of(record, read_motions(record.location, record.options));
    motion.file = record.file->name;
    return motion;
  } catch (const InputError& error) {
    // what is wrong with an option has the option's name and no place
    const std::string said = error.what(), before = error.path() + ": expected ";
    const bool of_option = error.path() == "format" || error.path() == "unit" || error.path() == "step" || error.path() == "column";
    const std::size_t at = said.find(before);
    if (!of_option || at == said.npos) throw;
    throw InputError(record.where(error.path()), record.path(error.path()), said.substr(at + before.size()), "");
  }
}

/// Generated records with one seed: drawn together, so that they are independent of each other.
struct Family {
  GenerateOptions options;
  std::vector<std::size_t> records;
  std::vector<std::unique_ptr<const TargetSpectrum>> targets;
};

bool same(const GenerateOptions& a, const GenerateOptions& b) {
  const auto all = [](const GenerateOptions& o) {
    return std::tuple(o.duration, o.step, o.envelope.shape, o.envelope.rise, o.envelope.fall, o.from, o.to);
  };
  return all(a) == all(b);
}

std::vector<Family> families_of(const std::vector<CaseRecordSource>& records) {
  std::vector<Family> families;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (!records[i].generated) continue;
    const CaseGenerated& generated = *records[i].generated;
    std::unique_ptr<const TargetSpectrum> target = make_part(target_catalog(), *generated.target);
    const GenerateOptions options = generate_options(*generated.table, *target);
    auto family = std::ranges::find(families, options.seed, [](const Family& each) { return each.options.seed; });
    if (family == families.end()) family = families.insert(family, Family{options, {}, {}});
    if (!same(family->options, options))
      fail(generated, "seed",
           fmt::format("a seed of its own (the record {} has this one with other times or another band)",
                       in_quotes(records[family->records.front()].name.name)),
           fmt::format("{}", options.seed));
    family->records.push_back(i);
    family->targets.push_back(std::move(target));
  }
  return families;
}

/// As many as there are cores, unless their frequencies by points take too much memory (2.3 kB a point as measured).
int families_at_a_time(const std::vector<Family>& families) {
  constexpr double bytes_of_point = 2300, most_bytes = 1e9;
  double points = 1;
  for (const Family& family : families) points = std::max(points, family.options.duration / family.options.step);
  const int cores = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U));
  return static_cast<int>(std::clamp(most_bytes / (bytes_of_point * points), 1.0, static_cast<double>(cores)));
}

/// Of every record, empty for those from files.
std::vector<Motion> generate_records(const std::vector<CaseRecordSource>& records) {
  std::vector<Motion> made(records.size());
  const std::vector<Family> families = families_of(records);
  in_parallel(static_cast<int>(families.size()), families_at_a_time(families), [&](int number) {
    const Family& family = families[static_cast<std::size_t>(number)];
    std::vector<const TargetSpectrum*> targets;
    for (const auto& target : family.targets) targets.push_back(target.get());
    std::vector<GeneratedMotion> motions = generate_motions(targets, family.options);
    for (std::size_t k = 0; k < motions.size(); ++k) {
      if (const SpectrumFit& fit = motions[k].fit; !fit.good())
        motions[k].motion.repairs.push_back(fmt::format("it does not fit its target well: mean error {}, down to {} of it",
                                                        percent(fit.mean_error), percent(fit.least_ratio)));
      made[family.records[k]] = std::move(motions[k].motion);
    }
  });
  return made;
}

}  // namespace

std::vector<CaseRecord> read_records(const std::vector<CaseRecordSource>& sources) {
  std::vector<CaseRecord> made;
  std::vector<Motion> generated = generate_records(sources);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const CaseRecordSource& source = sources[i];
    Motion motion = source.file ? read_record(source) : std::move(generated[i]);
    motion.name = source.name.name;
    for (const Values* step : source.processes) motion = make_part(process_catalog(), *step)->apply(std::move(motion));
    check_values(motion, source.where(), source.path());
    made.push_back({motion.name, std::make_shared<const MotionHistory>(std::make_shared<const Motion>(std::move(motion)))});
  }
  return made;
}

std::shared_ptr<const MotionHistory> giving(const std::shared_ptr<const MotionHistory>& history, MotionKind kind) {
  if (history->gives(kind)) return history;
  return std::make_shared<const MotionHistory>(std::make_shared<const Motion>(converted(*history->motion(), kind)));
}

std::shared_ptr<const MotionHistory> scaled(const std::shared_ptr<const MotionHistory>& history, double factor) {
  if (factor == 1) return history;
  Motion motion = *history->motion();
  for (double& value : motion.values) value *= factor;
  return std::make_shared<const MotionHistory>(std::make_shared<const Motion>(std::move(motion)));
}

const std::string& name_taken(const CaseOtherMotion* instead, const std::string& name) {
  return instead != nullptr ? instead->taken(name) : name;
}

void check_motion(const Case& read, const CaseOtherMotion& motion) {
  const std::vector<std::string>&replaced = motion.replace, &by = motion.by;
  if (by.size() != replaced.size())
    fail(motion, "by", fmt::format("as many names as in replace ({})", replaced.size()), fmt::format("{}", by.size()));
  Names known("function or record");
  for (const CaseFunction& function : read.input->functions) known.add(function.name);
  for (const CaseRecordSource& record : read.input->records) known.add(record.name);
  std::vector<std::string> drives;
  for (const DrivenBy& place : motions_wanted(read)) drives.push_back(place.function.name);
  for (std::size_t i = 0; i < by.size(); ++i) {
    known.find(by[i], motion.where("by"), motion.path("by"));
    if (std::ranges::find(drives, replaced[i]) == drives.end())
      fail(motion, "replace",
           "the name of a function or record of a ground acceleration, prescribed motion or incident wave, " +
               (drives.empty() ? std::string("of which the case has none") : listed(drives)),
           in_quotes(replaced[i]), nearest_name(replaced[i], drives));
    if (std::ranges::count(replaced, replaced[i]) > 1) fail(motion, "replace", "every name once", in_quotes(replaced[i]) + " again");
  }
}

std::vector<DrivenBy> motions_wanted(const Case& read) {
  std::vector<DrivenBy> wanted;
  for (const CaseGround& ground : read.input->grounds)
    wanted.push_back({ground.function, MotionKind::acceleration, "amplitude", ground.amplitude});
  for (const CaseMotion& motion : read.input->motions)
    if (motion.function)
      wanted.push_back({*motion.function, MotionKind::displacement, "amplitude",
                        parse_quantity(motion.amplitude, motion.turns ? "rad" : "m").value, motion.turns});
  for (const CaseAbsorbing& absorbing : read.input->absorbing)
    if (absorbing.incident) wanted.push_back({absorbing.incident->function, MotionKind::velocity, "velocity", absorbing.incident->stated});
  return wanted;
}

std::vector<MotionUse> motions_used(const Case& read, const CaseOtherMotion* instead, double factor) {
  std::vector<MotionUse> used;
  for (const DrivenBy& place : motions_wanted(read)) {
    const std::string& name = name_taken(instead, place.function.name);
    const auto record = std::ranges::find(read.records, name, &CaseRecord::name);
    if (record == read.records.end()) continue;
    const auto same = [&](const MotionUse& each) { return each.history == record->history && each.kind == place.kind; };
    if (std::ranges::none_of(used, same)) used.push_back({record->history, place.kind});
  }
  for (MotionUse& use : used) use.history = scaled(use.history, factor);
  return used;
}

double newmark_share(const std::vector<Stage>& stages) {
  const Stage* first = nullptr;
  for (const Stage& stage : stages) {
    if (stage.type == Stage::Type::statics) continue;
    if (!first) first = &stage;
    if (stage.step != first->step || !(stage.scheme == first->scheme)) return 0;
  }
  if (!first || first->scheme.gamma != 0.5) return 0;
  return (first->scheme.beta - 1.0 / 6) * first->step * first->step;
}

void warn_motions(const std::vector<MotionUse>& used, const std::vector<Stage>& stages, std::vector<std::string>& said) {
  double duration = 0, coarsest = 0;
  for (const Stage& stage : stages)
    if (stage.type == Stage::Type::dynamics) {
      duration += stage.duration;
      coarsest = std::max(coarsest, stage.step);
    }
  if (coarsest == 0) return;
  std::vector<const MotionHistory*> seen;
  for (const MotionUse& use : used) {
    const Motion& motion = *use.history->motion();
    if (use.kind == MotionKind::displacement && motion.kind == MotionKind::acceleration) {
      double fastest = 0;
      for (std::size_t i = 0; i < motion.values.size(); ++i)
        fastest = std::max(fastest, std::abs(use.history->at(MotionKind::velocity, motion.step * static_cast<double>(i))));
      const double left = use.history->at(MotionKind::velocity, motion.duration());
      if (std::abs(left) > 0.01 * fastest)
        said.push_back(
            fmt::format("the record {} ends with a velocity of {}: the displacement that it prescribes drifts away; correct its "
                        "base line",
                        in_quotes(motion.name), format_quantity(left, "m/s")));
    }
    if (use.kind == MotionKind::acceleration && motion.kind == MotionKind::velocity)
      said.push_back(
          fmt::format("the record {} is a velocity: its acceleration is the slope of a spline, which is {} too low at {:.3g} Hz and {} at "
                      "{:.3g} Hz (docs/theory, eq 32a); take the acceleration itself where it holds such frequencies",
                      in_quotes(motion.name), percent(1 - spline_slope_share(0.25)), 0.25 / motion.step,
                      percent(1 - spline_slope_share(0.4)), 0.4 / motion.step));
    if (std::ranges::find(seen, use.history.get()) != seen.end()) continue;
    seen.push_back(use.history.get());
    if (motion.file.empty())
      for (const std::string& doubt : motion.repairs) said.push_back(fmt::format("the record {}: {}", in_quotes(motion.name), doubt));
    const double steps = motion.step / coarsest;
    if (steps < 1 - 1e-9)
      said.push_back(
          fmt::format("the step of {} is coarser than that of the record {} ({}): its high frequencies are lost; take a smaller "
                      "step, or resample the record",
                      format_quantity(coarsest, "s"), in_quotes(motion.name), format_quantity(motion.step, "s")));
    else if (std::abs(steps - std::round(steps)) > 1e-6 * steps)
      said.push_back(fmt::format("the step of {} is no whole fraction of that of the record {} ({}): its peaks fall between the steps",
                                 format_quantity(coarsest, "s"), in_quotes(motion.name), format_quantity(motion.step, "s")));
    if (duration < motion.duration() * (1 - 1e-9))
      said.push_back(fmt::format("the record {} lasts {}, the dynamic stages {}: the rest of it is not used", in_quotes(motion.name),
                                 format_quantity(motion.duration(), "s"), format_quantity(duration, "s")));
    constexpr double felt = 0.02;  // of the peak
    const double last = motion.values.back();
    if (motion.kind == MotionKind::acceleration && duration > motion.duration() * (1 + 1e-9) &&
        std::abs(last) > felt * std::abs(peak_of(motion).value))
      said.push_back(
          fmt::format("the record {} ends at {} with {}, and the run goes on to {}: there the ground stops with a jerk; taper it",
                      in_quotes(motion.name), format_quantity(motion.duration(), "s"), format_quantity(last, unit_of(motion.kind)),
                      format_quantity(duration, "s")));
  }
}

}  // namespace uplift
