#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "uplift/base/file.h"
#include "uplift/case/build/names.h"
#include "uplift/case/case.h"
#include "uplift/case/schema/case_input.h"

// Which runs a case stands for: itself, its variants, its dampings, its stiffness sweep.
namespace uplift {
namespace {

bool may_open(const CaseInput& input) {
  return !input.interfaces.empty() || !input.foundations.empty();
}

RunSpec base_run(const Case& read) {
  RunSpec spec;
  if (read.input->damping) spec.damping = &*read.input->damping;
  return spec;
}

/// The file that a variant names. It says everything itself, and the motions of a comparison are those of this case.
std::string other_case_of(const Case& read, const NameUsed& file) {
  if (read.input->compare && !read.input->compare->motions.empty())
    fail(file, "variants of this case beside [[compare.motion]], whose motions are those of this case", "another case");
  const std::filesystem::path path = path_beside(file.where(), file.name);
  require_file(path, file.where(), file.path(), "a case file");
  return path.lexically_normal().string();
}

RunSpec variant_run(const Case& read, const CaseVariant& variant) {
  RunSpec spec = base_run(read);
  spec.name = variant.name.name;
  spec.label = variant.label;
  if (variant.other_case) spec.other_case = other_case_of(read, *variant.other_case);
  spec.law = variant.law;
  spec.interface = variant.interface;
  spec.method = variant.method;
  spec.impact = variant.impact;
  spec.scheme = variant.scheme;
  spec.path_average = variant.path_average;
  spec.step = variant.step;
  spec.expected_to_fail = variant.may_fail;
  return spec;
}

RunSpec bonded_run(const Case& read) {
  RunSpec spec = base_run(read);
  spec.name = spec.label = "bonded";
  spec.bonded = true;
  return spec;
}

/// Names become file names: nothing that a shell or a file system would take amiss.
void check_file_name(const NameUsed& used) {
  constexpr std::size_t most = 64;  // of a variant, a damping and a motion: together they name a file, of at most 255 characters
  if (used.name.size() > most)
    fail(used, fmt::format("a name of at most {} characters (it names files; `label` may be longer)", most),
         fmt::format("{} characters", used.name.size()));
  for (const char c : used.name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-' && c != '.')
      fail(used, "letters, digits, '_', '-' and '.' (it names files; `label` may be anything)", "\"" + used.name + "\"");
}

std::vector<RunSpec> sweep_runs(const Case& read, const CaseSweep& sweep, const CaseDamping* damping) {
  std::vector<RunSpec> runs;
  for (const double ratio : sweep.ratios) {
    if (!(ratio > 0)) fail(sweep, "ratios", "ratios > 0", fmt::format("{}", ratio));
    for (const bool path : {true, false}) {
      RunSpec spec = base_run(read);
      if (damping) spec.damping = damping;
      spec.name = fmt::format("sweep-{:g}-{}", ratio, path ? "path" : "end");
      spec.label = fmt::format("k F = {:g}, {}", ratio, path ? "path average" : "end of step");
      spec.law = sweep.law;
      spec.stiffness_ratio = ratio;
      spec.stiffness_parameter = sweep.parameter;
      spec.path_average = path;
      spec.impact = sweep.impact;
      spec.rigid_ground = sweep.rigid_ground;
      spec.expected_to_fail = !path;
      spec.pictures = false;
      spec.duration = sweep.duration;
      runs.push_back(std::move(spec));
    }
  }
  return runs;
}

/// Every run with every one of some tables; pictures of the first alone.
template <class Table>
std::vector<RunSpec> with_each(const std::vector<RunSpec>& plain, const std::vector<Table>& tables, const std::string& what,
                               const Table* RunSpec::*place) {
  if (tables.empty()) return plain;
  std::vector<RunSpec> made;
  Names known(what);
  for (const Table& table : tables) {
    check_file_name(table.name);
    known.add(table.name);
    for (RunSpec spec : plain) {
      spec.name += "-" + table.name.name;
      spec.group = spec.group.empty() ? table.label : spec.group + ", " + table.label;
      spec.*place = &table;
      spec.pictures = spec.pictures && &table == &tables.front();
      made.push_back(std::move(spec));
    }
  }
  return made;
}

/// Every run under the case's own motion and under every further one. The own motion is left out where a [[compare.motion]] names it.
std::vector<RunSpec> with_motions(const std::vector<RunSpec>& plain, const std::vector<CaseOtherMotion>& motions) {
  if (motions.empty()) return plain;
  std::vector<RunSpec> made;
  const bool named = std::ranges::any_of(motions, &CaseOtherMotion::is_own);
  for (RunSpec spec : plain)
    if (!named) {
      spec.group = spec.motion_label = "motion of the case";
      made.push_back(std::move(spec));
    }
  for (RunSpec spec : with_each(plain, motions, "motion of the comparison", &RunSpec::motion)) {
    spec.motion_label = spec.motion->label;
    spec.pictures = spec.pictures && named;
    made.push_back(std::move(spec));
  }
  return made;
}

bool undamped(const CaseDamping& damping) {
  return damping.made.alpha == 0 && damping.made.beta == 0 && damping.made.modal.empty();
}

}  // namespace

std::vector<RunSpec> runs_of_case(const Case& read) {
  RunSpec spec = base_run(read);
  spec.name = "run";
  spec.label = "as in the case";
  std::vector<RunSpec> runs{spec};
  if (read.input->bonded && may_open(*read.input)) runs.push_back(bonded_run(read));
  return runs;
}

std::vector<RunSpec> companions_of_case(const Case& read) {
  bool long_enough = false;
  for (const CaseStage& stage : read.input->stages) {
    if (stage.statics || !stage.duration || !stage.step) continue;
    long_enough = *stage.duration >= least_steps_to_compare * *stage.step;
    if (!long_enough) break;
  }
  if (!read.input->verdict.step_check || !long_enough) return {};
  std::vector<RunSpec> runs = runs_of_case(read);
  for (RunSpec& spec : runs) {
    spec.name += "-coarse";
    spec.label += ", twice the step";
    spec.step_factor = 2;
    spec.pictures = false;
  }
  return runs;
}

bool compares(const Case& read) {
  return !read.input->variants.empty() || (read.input->compare && !read.input->compare->motions.empty());
}

Comparison comparison_of_case(const Case& read) {
  const Values& root = read.values;
  if (!compares(read)) throw InputError(root.where(), "variant", "at least one [[variant]] or [[compare.motion]] to compare", "none");
  std::vector<RunSpec> plain;
  if (read.input->variants.empty()) plain.push_back(runs_of_case(read).front());
  Names names("variant");
  for (const CaseVariant& variant : read.input->variants) {
    check_file_name(variant.name);
    names.add(variant.name);
    plain.push_back(variant_run(read, variant));
  }
  if (read.input->bonded && may_open(*read.input)) {
    names.add("bonded", root.where("bonded"), "variant.name");
    plain.push_back(bonded_run(read));
  }
  Comparison made;
  const std::optional<CaseComparison>& compare = read.input->compare;
  made.runs = plain;
  if (compare) {
    for (const CaseOtherMotion& motion : compare->motions) check_motion(read, motion);
    made.runs = with_motions(made.runs, compare->motions);
    made.runs = with_each(made.runs, compare->dampings, "damping case", &RunSpec::damping);
  }
  if (compare && compare->sweep) {
    // Without damping the error cannot hide; the first undamped case is taken when there is one.
    const auto damping = std::ranges::find_if(compare->dampings, undamped);
    made.sweep = sweep_runs(read, *compare->sweep, damping == compare->dampings.end() ? nullptr : &*damping);
  }
  return made;
}

}  // namespace uplift
