#include "uplift/analysis/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/analysis/wording.h"
#include "uplift/model/builder.h"

namespace uplift {
namespace {

using Column = Request::Kind;

int find_index(const RunResult& result, Request::Kind kind, int of) {
  for (std::size_t k = 0; k < result.columns.size(); ++k) {
    const Request& column = result.columns[k];
    const bool node =
        kind == Column::displacement || kind == Column::velocity || kind == Column::acceleration || kind == Column::absolute_acceleration;
    if (column.kind == kind && (node ? column.unknown : column.interface) == of) return static_cast<int>(k);
  }
  return -1;
}

/// Axial force at the beginning of the first dynamic stage, compression positive [N]; the stated dead load when it was not recorded.
double static_force(const Built& built, const RunResult& run, int interface) {
  const std::vector<double>* axial = find_column(run, Column::axial, interface);
  if (axial && !axial->empty() && std::isfinite(axial->front())) return -axial->front();
  return built.weight;
}

void say_uplift(const Built& built, const RunResult& run, Verdict& verdict) {
  const double duration = run.end_time;
  if (built.facts.empty()) {
    verdict.paragraphs.push_back("The model has no interface: a linear analysis, which cannot say whether anything lifts off.");
    return;
  }
  if (run.max_uplifted_ratio.value <= 0) {
    verdict.paragraphs.push_back(
        "No point of any interface opened: a linear analysis of the bonded model would have been enough for these loads.");
    return;
  }
  verdict.facts.push_back({"Uplifted area", percent(run.max_uplifted_ratio.value),
                           fmt::format("largest, at {}; counted by gap", spoken(run.max_uplifted_ratio.time, "s"))});
  verdict.facts.push_back({"Largest gap", spoken(run.max_opening.value, "m"), fmt::format("at {}", spoken(run.max_opening.time, "s"))});
  std::string text =
      fmt::format("The base first opens at {}. A gap stands open during {} of {} ({}).", spoken(run.first_uplift, "s"),
                  spoken(run.time_uplifted, "s"), spoken(duration, "s"), percent(duration > 0 ? run.time_uplifted / duration : 0));
  text += run.full_loss > 0 ? fmt::format(" All contact is lost during {} in total.", spoken(run.full_loss, "s"))
                            : " Contact is never lost altogether.";
  if (run.max_penetration > built.plan.gap_tolerance)
    text += fmt::format(" Closed points interpenetrate by at most {}.", spoken(run.max_penetration, "m"));
  verdict.paragraphs.push_back(std::move(text));
}

void say_forces(const Built& built, const RunResult& run, Verdict& verdict) {
  if (built.facts.empty()) return;
  verdict.facts.push_back({"Base moment", spoken(std::abs(run.max_base_moment.value), "N m"),
                           fmt::format("largest, at {}", spoken(run.max_base_moment.time, "s"))});
  for (std::size_t k = 0; k < built.facts.size(); ++k) {
    const InterfaceFacts& facts = built.facts[k];
    const int interface = static_cast<int>(k);
    const std::string of = built.facts.size() > 1 ? " of " + facts.name : "";
    const double force = static_force(built, run, interface);
    if (!(force > 0)) continue;
    const Peak* moment = find_peak(run, Column::moment, interface);
    if (moment && moment->value != 0 && facts.half_width > 0)
      verdict.facts.push_back({"Safety against overturning" + of, fmt::format("{:.3g}", force * facts.half_width / std::abs(moment->value)),
                               fmt::format("W b/M with W = {} and b = {}", spoken(force, "N"), spoken(facts.half_width, "m"))});
    const Peak* shear = find_peak(run, Column::shear, interface);
    if (shear && shear->value != 0 && facts.friction > 0)
      verdict.facts.push_back({"Safety against sliding" + of, fmt::format("{:.3g}", facts.friction * force / std::abs(shear->value)),
                               fmt::format("mu W/V with mu = {:g}", facts.friction)});
    const Peak* pressure = find_peak(run, Column::max_pressure, interface);
    if (pressure && pressure->value > 0)
      verdict.facts.push_back({"Largest pressure" + of, spoken(pressure->value, "Pa"),
                               fmt::format("{:.3g} times the mean {}, at {}", pressure->value * facts.area / force,
                                           spoken(force / facts.area, "Pa"), spoken(pressure->time, "s"))});
  }
}

void say_beside_bonded(const Built& built, const RunResult& run, const RunResult& bonded, Verdict& verdict) {
  if (bonded.status != RunStatus::completed) {
    verdict.paragraphs.push_back(
        fmt::format("The bonded model could not be run to the end ({}): there is nothing to compare with.", bonded.reason));
    return;
  }
  std::string text;
  if (bonded.max_base_moment.value != 0)
    text += fmt::format("Beside the bonded base, the largest base moment is {} ({} instead of {})",
                        beside(run.max_base_moment.value, bonded.max_base_moment.value), spoken(std::abs(run.max_base_moment.value), "N m"),
                        spoken(std::abs(bonded.max_base_moment.value), "N m"));
  const Peak* top = built.top >= 0 ? find_peak(run, Column::displacement, built.top_sway()) : nullptr;
  const Peak* top_bonded = built.top >= 0 ? find_peak(bonded, Column::displacement, built.top_sway()) : nullptr;
  if (top && top_bonded && top_bonded->value != 0) {
    text += fmt::format("{} the largest motion of {} is {} ({} instead of {})", text.empty() ? "Beside the bonded base," : ", and",
                        built.model.nodes[static_cast<std::size_t>(built.top)].name, beside(top->value, top_bonded->value),
                        spoken(std::abs(top->value), "m"), spoken(std::abs(top_bonded->value), "m"));
    verdict.facts.push_back(
        {"Top motion", spoken(std::abs(top->value), "m"),
         fmt::format("{} beside the bonded base, at {}", beside(top->value, top_bonded->value), spoken(top->time, "s"))});
  }
  if (!text.empty()) verdict.paragraphs.push_back(text + ".");
  double tension = 0, mean = 0;
  for (std::size_t k = 0; k < built.facts.size(); ++k) {
    const Peak* moment = find_peak(bonded, Column::moment, static_cast<int>(k));
    const double force = static_force(built, bonded, static_cast<int>(k));
    if (!moment || !(force > 0)) continue;
    tension = std::max(tension, std::abs(moment->value));
    mean = force * built.facts[k].half_width;
  }
  if (tension > 0 && mean > 0)
    verdict.paragraphs.push_back(
        fmt::format("The bonded base would have to carry {} times the moment W b at which the resultant leaves the base: {}.",
                    fmt::format("{:.3g}", tension / mean),
                    tension > mean ? "more than any base without tension can carry, so the bonded analysis says nothing about forces here"
                                   : "less than the moment that overturns the base statically"));
}

/// Mean over the last tenth of the run beside the first value.
void say_residual(const Built& built, const RunResult& run, Verdict& verdict) {
  for (std::size_t k = 0; k < built.facts.size(); ++k) {
    const std::vector<double>* rotation = find_column(run, Column::rotation, static_cast<int>(k));
    if (!rotation || rotation->size() < 20) continue;
    const std::size_t tail = rotation->size() / 10;
    double sum = 0, least = INFINITY, most = -INFINITY;
    for (auto it = rotation->end() - static_cast<std::ptrdiff_t>(tail); it != rotation->end(); ++it) {
      sum += *it;
      least = std::min(least, *it);
      most = std::max(most, *it);
    }
    const double mean = sum / static_cast<double>(tail) - rotation->front();
    if (!std::isfinite(mean)) continue;
    verdict.facts.push_back({"Rotation left at the end", spoken(mean, "rad"),
                             fmt::format("mean of the last tenth; it still swings by {}", spoken((most - least) / 2, "rad"))});
  }
}

void say_energy(const Built& built, const RunResult& run, Verdict& verdict) {
  const double scale = run.energy_scale;
  const double created = scale > 0 ? run.energy_created / scale : 0, lost = scale > 0 ? run.energy_lost / scale : 0;
  verdict.facts.push_back({"Energy created by the computation", percent(created),
                           fmt::format("of {}; limit {}", spoken(scale, "J"), percent(built.plan.created_limit))});
  std::string text =
      created > built.plan.created_limit
          ? fmt::format("The computation created {} of the energy put in ({} at {}): these results are not to be used.", percent(created),
                        spoken(run.energy_created, "J"), spoken(run.energy_created_time, "s"))
          : fmt::format("The energy balance closes: the computation created at most {} of the energy put in.", percent(created));
  const Energies& end = run.final_energy;
  if (scale > 0) {
    if (end.damping > 1e-6 * scale) text += fmt::format(" Damping took {}.", percent(end.damping / scale));
    if (end.interface_dissipated > 1e-6 * scale) text += fmt::format(" The interface took {}.", percent(end.interface_dissipated / scale));
    if (std::abs(end.impact) > 1e-6 * scale) text += fmt::format(" Impacts took {}.", percent(end.impact / scale));
    if (lost > 0.001 && lost > created) text += fmt::format(" {} vanished by numerical damping.", percent(lost));
  }
  verdict.paragraphs.push_back(std::move(text));
}

}  // namespace

std::string_view to_string(Verdict::Level level) {
  switch (level) {
    case Verdict::Level::none:
      return "none";
    case Verdict::Level::uplift:
      return "uplift";
    case Verdict::Level::overturned:
      return "overturned";
    case Verdict::Level::failed:
      return "failed";
  }
  return "";
}

const std::vector<double>* find_column(const RunResult& result, Request::Kind kind, int of) {
  const int index = find_index(result, kind, of);
  return index < 0 || static_cast<std::size_t>(index) + 1 >= result.table.size() ? nullptr
                                                                                 : &result.table[static_cast<std::size_t>(index) + 1];
}

const Peak* find_peak(const RunResult& result, Request::Kind kind, int of) {
  const int index = find_index(result, kind, of);
  return index < 0 || static_cast<std::size_t>(index) >= result.peaks.size() ? nullptr : &result.peaks[static_cast<std::size_t>(index)];
}

Verdict judge(const Built& built, const RunResult& run, const RunResult* bonded) {
  Verdict verdict;
  if (run.status == RunStatus::failed) {
    verdict.level = Verdict::Level::failed;
    verdict.headline = "The run failed: " + run.reason;
    verdict.paragraphs.push_back(
        fmt::format("What was computed up to {} is shown and marked; it is not a result.", spoken(run.end_time, "s")));
  } else if (run.status == RunStatus::overturned) {
    verdict.level = Verdict::Level::overturned;
    verdict.headline =
        fmt::format("It overturns: at {} the rotation passes {}", spoken(run.end_time, "s"), spoken(built.plan.rotation_limit, "rad"));
    verdict.paragraphs.push_back("Beyond this rotation the small-displacement model says nothing; the run ended there.");
  } else if (run.max_uplifted_ratio.value > 0) {
    verdict.level = Verdict::Level::uplift;
    verdict.headline = fmt::format("The base uplifts: up to {} of its area, by up to {}", percent(run.max_uplifted_ratio.value),
                                   spoken(run.max_opening.value, "m"));
  } else {
    verdict.headline = built.facts.empty() ? "A linear run without an interface" : "The base does not uplift";
  }
  if (run.status == RunStatus::interrupted) verdict.headline += fmt::format(" (interrupted at {})", spoken(run.end_time, "s"));
  if (run.status == RunStatus::failed && run.counts.steps == 0) return verdict;
  say_uplift(built, run, verdict);
  say_forces(built, run, verdict);
  if (bonded) say_beside_bonded(built, run, *bonded, verdict);
  say_residual(built, run, verdict);
  say_energy(built, run, verdict);
  for (const std::string& note : run.notes) verdict.paragraphs.push_back(note);
  return verdict;
}

}  // namespace uplift
