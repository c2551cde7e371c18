#include <fmt/format.h>

#include <algorithm>

#include "uplift/io/report/parts.h"

// Envelopes of section forces along the beams.
namespace uplift {
namespace {

struct Figure {
  const char *component, *title, *caption, *unit;
};

std::vector<Figure> figures(Space space) {
  if (space.dimension == 2)
    return {{"moment", "Bending moment",
             "Largest and smallest bending moment of every section over all steps. Positive: tension on the "
             "right of the direction in which the beam runs.",
             "N m"},
            {"shear", "Shear force",
             "Largest and smallest shear force of every section over all steps. Positive: what lies beyond the "
             "section pushes to the left of the direction in which the beam runs.",
             "N"},
            {"axial", "Axial force", "Largest and smallest axial force of every section over all steps. Tension is positive.", "N"}};
  return {{"moment", "Bending moment", "Largest bending moment of every section over all steps, of both axes together.", "N m"},
          {"shear", "Shear force", "Largest shear force of every section over all steps, of both axes together.", "N"},
          {"axial", "Axial force", "Largest and smallest axial force of every section over all steps. Tension is positive.", "N"}};
}

/// Along an upright beam its height, else the distance from its beginning.
bool upright(const BeamEnvelope& envelope, int up) {
  const auto& [least, most] = std::ranges::minmax(envelope.sections, {}, [up](const auto& section) { return section.position[up]; });
  return std::abs(most.position[up] - least.position[up]) > 0.5 * envelope.sections.back().along;
}

Chart chart_of(const Figure& figure, std::size_t which, const std::vector<ReportRun>& runs) {
  const BeamEnvelope& first = runs.front().result->envelopes[which];
  const Space space = runs.front().built->model.space;
  const bool height = upright(first, space.up()), magnitude = space.dimension == 3 && std::string_view(figure.component) != "axial";
  Chart chart{fmt::format("beam_{}_{}", figure.component, which + 1),
              "beams",
              fmt::format("{}: {}", figure.title, first.beam),
              figure.caption,
              {figure.title, figure.unit},
              {height ? "Height" : "Distance along the beam", "m"},
              {}};
  for (const ReportRun& run : runs) {
    if (which >= run.result->envelopes.size()) continue;
    const BeamEnvelope& envelope = run.result->envelopes[which];
    const auto k = static_cast<std::size_t>(std::ranges::find(envelope.components, figure.component) - envelope.components.begin());
    for (const bool most : {true, false}) {
      if (magnitude && !most) continue;
      Curve curve;
      curve.label = run.result->label + (run.say_group ? ", " + run.result->group : "");
      if (!magnitude) curve.label += most ? ", largest" : ", smallest";
      curve.run = run.result->label;
      curve.dash = run.spec->bonded;
      curve.failed = run.result->status == RunStatus::failed;
      for (std::size_t s = 0; s < envelope.sections.size(); ++s) {
        curve.x.push_back(most ? envelope.at(s, k).most : envelope.at(s, k).least);
        curve.y.push_back(height ? envelope.sections[s].position[space.up()] : envelope.sections[s].along);
      }
      chart.curves.push_back(std::move(curve));
    }
  }
  return chart;
}

}  // namespace

std::vector<Chart> beam_charts(const std::vector<ReportRun>& runs) {
  std::vector<Chart> charts;
  for (std::size_t k = 0; k < runs.front().result->envelopes.size(); ++k)
    for (const Figure& figure : figures(runs.front().built->model.space)) charts.push_back(chart_of(figure, k, runs));
  return charts;
}

}  // namespace uplift
