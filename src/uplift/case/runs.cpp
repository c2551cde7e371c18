#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/case/build/names.h"
#include "uplift/case/case.h"
#include "uplift/case/schema/case_input.h"

// Which runs a case stands for: itself, its variants, its dampings, its stiffness sweep.
namespace uplift {
namespace {

bool may_open(const CaseInput& input) {
  return !input.interfaces.empty() || !input.foundations.empty();
}

const Values* part_if(const Values& table, std::string_view key) {
  return table.given(key) ? &table.part(key) : nullptr;
}

RunSpec base_run(const Case& read) {
  RunSpec spec;
  if (read.values.has("damping")) spec.damping = &read.values.table("damping");
  return spec;
}

/// The file that a variant names. It says everything itself, and the motions of a comparison are those of this case.
std::string other_case_of(const Case& read, const Values& variant) {
  for (const char* key : {"law", "interface", "method", "impact", "scheme", "traction", "step"})
    if (variant.given(key)) fail(variant, key, "nothing beside another case, which states all itself", "a value");
  if (const Values* compare = read.values.has("compare") ? &read.values.table("compare") : nullptr)
    if (!compare->tables("motion").empty())
      fail(variant, "case", "variants of this case beside [[compare.motion]], whose motions are those of this case", "another case");
  const std::filesystem::path path = path_beside(variant.where("case"), variant.text("case"));
  if (!std::filesystem::is_regular_file(path)) fail(variant, "case", "a case file", escaped(path.string()));
  return path.lexically_normal().string();
}

RunSpec variant_run(const Case& read, const Values& variant) {
  RunSpec spec = base_run(read);
  spec.name = variant.text("name");
  spec.label = variant.has("label") ? variant.text("label") : spec.name;
  if (variant.has("case")) spec.other_case = other_case_of(read, variant);
  spec.law = part_if(variant, "law");
  if (variant.has("interface")) spec.interface = variant.text("interface");
  spec.method = part_if(variant, "method");
  spec.impact = part_if(variant, "impact");
  spec.scheme = part_if(variant, "scheme");
  if (variant.has("traction")) spec.path_average = variant.text("traction") == "path";
  if (variant.has("step")) spec.step = variant.number("step");
  spec.expected_to_fail = variant.text("expected") == "may_fail";
  return spec;
}

RunSpec bonded_run(const Case& read) {
  RunSpec spec = base_run(read);
  spec.name = spec.label = "bonded";
  spec.bonded = true;
  return spec;
}

/// Names become file names: nothing that a shell or a file system would take amiss.
void check_file_name(const Values& table) {
  constexpr std::size_t most = 64;  // of a variant, a damping and a motion: together they name a file, of at most 255 characters
  if (table.text("name").size() > most)
    fail(table, "name", fmt::format("a name of at most {} characters (it names files; `label` may be longer)", most),
         fmt::format("{} characters", table.text("name").size()));
  for (const char c : table.text("name"))
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-' && c != '.')
      fail(table, "name", "letters, digits, '_', '-' and '.' (it names files; `label` may be anything)", "\"" + table.text("name") + "\"");
}

std::vector<RunSpec> sweep_runs(const Case& read, const Values& sweep, const Values* damping) {
  std::vector<RunSpec> runs;
  for (const double ratio : sweep.numbers("ratios")) {
    if (!(ratio > 0)) fail(sweep, "ratios", "ratios > 0", fmt::format("{}", ratio));
    for (const bool path : {true, false}) {
      RunSpec spec = base_run(read);
      if (damping) spec.damping = damping;
      spec.name = fmt::format("sweep-{:g}-{}", ratio, path ? "path" : "end");
      spec.label = fmt::format("k F = {:g}, {}", ratio, path ? "path average" : "end of step");
      spec.law = &sweep.part("law");
      spec.stiffness_ratio = ratio;
      spec.stiffness_parameter = sweep.text("parameter");
      spec.path_average = path;
      spec.impact = &sweep.part("impact");
      spec.rigid_ground = sweep.flag("rigid_ground");
      spec.expected_to_fail = !path;
      spec.pictures = false;
      if (sweep.has("duration")) spec.duration = sweep.number("duration");
      runs.push_back(std::move(spec));
    }
  }
  return runs;
}

/// Every run with every one of some tables; pictures of the first alone.
std::vector<RunSpec> with_each(const std::vector<RunSpec>& plain, const std::vector<Values>& tables, const std::string& what,
                               const Values* RunSpec::*place) {
  if (tables.empty()) return plain;
  std::vector<RunSpec> made;
  Names known(what);
  for (const Values& table : tables) {
    check_file_name(table);
    known.add(table, "name");
    for (RunSpec spec : plain) {
      spec.name += "-" + table.text("name");
      const std::string& label = table.text(table.has("label") ? "label" : "name");
      spec.group = spec.group.empty() ? label : spec.group + ", " + label;
      spec.*place = &table;
      spec.pictures = spec.pictures && &table == &tables.front();
      made.push_back(std::move(spec));
    }
  }
  return made;
}

/// Whether a [[compare.motion]] stands for the case's own records: every name is replaced by itself.
bool is_own_motion(const Values& motion) {
  return motion.texts("replace") == motion.texts("by");
}

/// Every run under the case's own motion and under every further one. The own motion is left out where a [[compare.motion]] names it.
std::vector<RunSpec> with_motions(const std::vector<RunSpec>& plain, const std::vector<Values>& motions) {
  if (motions.empty()) return plain;
  std::vector<RunSpec> made;
  const bool named = std::ranges::any_of(motions, is_own_motion);
  for (RunSpec spec : plain)
    if (!named) {
      spec.group = spec.motion_label = "motion of the case";
      made.push_back(std::move(spec));
    }
  for (RunSpec spec : with_each(plain, motions, "motion of the comparison", &RunSpec::motion)) {
    spec.motion_label = spec.motion->text(spec.motion->has("label") ? "label" : "name");
    spec.pictures = spec.pictures && named;
    made.push_back(std::move(spec));
  }
  return made;
}

bool undamped(const Values& damping) {
  return damping.number("alpha") == 0 && damping.number("beta") == 0 && damping.numbers("modal").empty() &&
         damping.tables("rayleigh").empty();
}

}  // namespace

std::vector<RunSpec> runs_of_case(const Case& read) {
  RunSpec spec = base_run(read);
  spec.name = "run";
  spec.label = "as in the case";
  std::vector<RunSpec> runs{spec};
  if (read.values.flag("bonded") && may_open(*read.input)) runs.push_back(bonded_run(read));
  return runs;
}

std::vector<RunSpec> companions_of_case(const Case& read) {
  bool long_enough = false;
  for (const CaseStage& stage : read.input->stages) {
    if (stage.statics || !stage.duration || !stage.step) continue;
    long_enough = *stage.duration >= least_steps_to_compare * *stage.step;
    if (!long_enough) break;
  }
  const bool wanted = !read.values.has("verdict") || read.values.table("verdict").flag("step_check");
  if (!wanted || !long_enough) return {};
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
  const Values& root = read.values;
  return !root.tables("variant").empty() || (root.has("compare") && !root.table("compare").tables("motion").empty());
}

Comparison comparison_of_case(const Case& read) {
  const Values& root = read.values;
  if (!compares(read)) throw InputError(root.where(), "variant", "at least one [[variant]] or [[compare.motion]] to compare", "none");
  std::vector<RunSpec> plain;
  if (root.tables("variant").empty()) plain.push_back(runs_of_case(read).front());
  Names names("variant");
  for (const Values& variant : root.tables("variant")) {
    check_file_name(variant);
    names.add(variant, "name");
    plain.push_back(variant_run(read, variant));
  }
  if (root.flag("bonded") && may_open(*read.input)) {
    names.add("bonded", root.where("bonded"), "variant.name");
    plain.push_back(bonded_run(read));
  }
  Comparison made;
  const Values* compare = root.has("compare") ? &root.table("compare") : nullptr;
  made.runs = plain;
  if (compare) {
    const std::vector<Values>& motions = compare->tables("motion");
    for (const Values& motion : motions) check_motion(read, motion);
    made.runs = with_motions(made.runs, motions);
    made.runs = with_each(made.runs, compare->tables("damping"), "damping case", &RunSpec::damping);
  }
  if (compare && compare->has("stiffness_sweep")) {
    // Without damping the error cannot hide; the first undamped case is taken when there is one.
    const Values* damping = nullptr;
    for (const Values& each : compare->tables("damping"))
      if (!damping && undamped(each)) damping = &each;
    made.sweep = sweep_runs(read, compare->table("stiffness_sweep"), damping);
  }
  return made;
}

}  // namespace uplift
