#include <algorithm>
#include <utility>

#include "uplift/case/build/model.h"
#include "uplift/case/build/records.h"
#include "uplift/case/build/stages.h"

namespace uplift {
namespace {

/// Functions in the place of others; ambiguous where one function has several names or takes several quantities.
class NewFunctions {
 public:
  NewFunctions(const BuiltCase& built, const CaseNames& names) : built_(built), names_(names) {}
  /// Null where the place of the function is not known, or the new one would be constant.
  std::shared_ptr<const TimeFunction> of(const std::shared_ptr<const TimeFunction>& old) const {
    const FunctionUse* use = nullptr;
    for (const FunctionUse& each : built_.functions) {
      if (each.made != old) continue;
      if (use != nullptr && (each.kind != use->kind || each.factor != use->factor || name(each) != name(*use))) return nullptr;
      use = &each;
    }
    if (use == nullptr) return nullptr;
    std::shared_ptr<const TimeFunction> made = names_.function(use->name, use->kind, use->factor);
    return made->is_one() ? nullptr : made;
  }

 private:
  static std::string name(const FunctionUse& use) { return use.name ? use.name->name : std::string(); }
  const BuiltCase& built_;
  const CaseNames& names_;
};

}  // namespace

bool change_motion(const Case& read, const RunSpec& spec, BuiltCase& built) {
  Model& model = built.model;
  if (!model.motions.empty() || !model.time_load_tables.empty() || built.plan.rest != nullptr) return false;
  CaseNames names;
  names.space = model.space;
  names.instead = spec.motion;
  names.motion_factor = spec.motion_factor;
  names.share = newmark_share(built.plan.stages);
  std::vector<FunctionUse> used;
  names.functions_used = &used;
  add_functions(read, names);
  const NewFunctions functions(built, names);
  std::vector<std::pair<std::shared_ptr<const TimeFunction>*, std::shared_ptr<const TimeFunction>>> changes;
  const auto change = [&](std::shared_ptr<const TimeFunction>& old) {
    if (old->is_one()) return true;
    const auto same = std::ranges::find_if(changes, [&](const auto& each) { return *each.first == old; });
    changes.emplace_back(&old, same != changes.end() ? same->second : functions.of(old));
    return changes.back().second != nullptr;
  };
  for (TimeLoad& load : model.time_loads) {
    if (load.dead && !load.function->is_one()) return false;
    if (!change(load.function)) return false;
  }
  for (GroundAcceleration& ground : model.grounds)
    if (!change(ground.function)) return false;
  for (auto& [old, made] : changes) *old = std::move(made);
  built.functions = std::move(used);
  built.motions = motions_used(read, spec.motion, spec.motion_factor);
  return true;
}

}  // namespace uplift
