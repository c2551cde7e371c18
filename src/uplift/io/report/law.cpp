#include <algorithm>
#include <cmath>

#include "uplift/io/report/parts.h"
#include "uplift/laws/external.h"

// The interface law as a curve: figure 3 of the paper, for any traction law.
namespace uplift {
namespace {

/// Opening [m] that shows the law: twice that over which it softens, else what the run reached.
double shown_opening(const LawScales& scales, double reached) {
  if (scales.opening > 0) return 2 * scales.opening;
  return reached > 0 ? reached : 1e-3;
}

/// Largest compression [m] that is driven: comparable to the tensile branch, and through the closure branch.
double shown_closing(const InterfaceLaw& law, double opening) {
  double stiffness = 0;
  law.closed_stiffness(1, &stiffness);
  const LawScales scales = law.scales();
  const double stress = 2 * std::max(scales.closure, scales.strength);
  return stress > 0 && stiffness > 0 ? std::min(stress / stiffness, opening) : 0.1 * opening;
}

}  // namespace

Chart law_chart(const ReportRun& run) {
  Chart chart{"law",
              "law",
              "Interface law",
              "Normal traction while the interface opens and closes three times, each time farther. Dashed: largest opening so far.",
              {"Opening", "m"},
              {"Traction", "Pa"},
              {}};
  if (run.built->model.interfaces.empty()) return chart;
  const Interface& interface = run.built->model.interfaces.front();
  if (!interface.law || interface.footprint) return chart;
  const Values& values = *run.built->behaviours.front();
  if (is_external(values)) return chart;  // its function belongs to the caller, who may be gone
  const double opening = shown_opening(interface.law->scales(), run.result->max_opening.value),
               closing = shown_closing(*interface.law, opening);
  const Batch batch{1, 1, 0};
  std::vector<double> old(static_cast<std::size_t>(interface.law->num_history(1)), 0.0), now(old);
  Curve path{run.built->model.interfaces.front().behaviour, "", {0.0}, {}, false, false};
  double at = 0, traction = 0;
  interface.law->respond(batch, &at, &at, old.data(), {&traction, nullptr, now.data()});
  path.y.push_back(traction);
  const auto drive = [&](double to, int pieces) {
    const double from = at;
    for (int i = 1; i <= pieces; ++i) {
      // Points crowd at both ends of a leg, where the stiff branches are.
      const double next = from + (to - from) * (0.5 - 0.5 * std::cos(3.14159265358979 * i / pieces));
      interface.law->respond(batch, &at, &next, old.data(), {&traction, nullptr, now.data()});
      old = now;
      at = next;
      path.x.push_back(at);
      path.y.push_back(traction);
    }
  };
  std::vector<double> reached;
  for (const double share : {0.25, 0.6, 1.0}) {
    drive(share * opening, 200);
    reached.push_back(at);
    drive(-closing, 200);
  }
  const auto [least, most] = std::minmax_element(path.y.begin(), path.y.end());
  const double bottom = *least, top = *most;
  chart.curves.push_back(std::move(path));
  for (std::size_t i = 0; i < reached.size(); ++i)
    chart.curves.push_back({"largest opening, cycle " + std::to_string(i + 1),
                            "",
                            {reached[i], reached[i]},
                            {0.25 * bottom, top > 0 ? top : -0.25 * bottom},
                            true,
                            false});
  return chart;
}

}  // namespace uplift
