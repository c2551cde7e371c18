#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/case/drawn_parts.h"
#include "uplift/io/report/report.h"
#include "uplift/io/results/thin_history.h"
#include "uplift/io/text/json_writer.h"

// The parts of the reports' documents; used by the files of the reports alone.
namespace uplift {

void write_choices(JsonWriter& json, const Case& read, const BuiltCase& built);
/// Floor spectra, where there are any.
bool has_floors(const ReportInput& input);
void write_floor_charts(JsonWriter& json, const ReportInput& input);
/// Facts and paragraphs of the verdict, in the words of the terminal.
void write_sentences(JsonWriter& json, const ReportInput& input);
/// Uplifted share over time of every interface; empty for walls and without a dynamic stage.
void write_uplifted_shares(JsonWriter& json, const ReportInput& input);
void write_tables(JsonWriter& json, const ReportInput& input);
void write_charts(JsonWriter& json, const ReportInput& input);
void write_model(JsonWriter& json, const Case& read, const BuiltCase& built);
/// Of the drawn nodes of the model the one at which a load on a surface beside a cut is shown, next to one of the faces of this surface;
/// none for a group of the mesh.
std::optional<int> node_on_free_surface(const Case& read, const BuiltCase& built, const std::string& name, const std::vector<int>& drawn);
void write_animations(JsonWriter& json, const ReportInput& input);
/// The member "uplifted": share of the area in every frame, by interface.
void write_uplifted(JsonWriter& json, const Model& model, const std::vector<const Frame*>& frames);
/// Uplifted share of the area of all interfaces.
double uplifted_share(const Model& model, const Frame& frame);
/// The frames of a run in space: displacements of these nodes of the model, rotations of footings, openings and pressures of interfaces.
void write_space_animation(JsonWriter& json, const DrawnParts& parts, const ReportRun& run, const std::vector<int>& nodes);
/// The same two for a model in space: the members "space" and "spaceAnimations".
void write_space(JsonWriter& json, const ReportInput& input);

/// Of a curve that is drawn: as many as a wide page shows.
inline constexpr std::size_t points_per_curve = 1500;
struct Axis {
  std::string label, unit;
  bool log = false;
};
struct Curve {
  std::string label, run;  // run: label of the run, decides the colour; empty: none
  std::vector<double> x, y;
  bool dash = false, failed = false;
};
struct Chart {
  std::string id, section, title, caption;
  Axis x, y;
  std::vector<Curve> curves;
};
/// Nothing without curves. `origin`: where a figure comes from whose case does not state it.
void write_chart(JsonWriter& json, const Chart& chart, std::string_view origin = {});
/// Of several bases, the first four have figures of their own: their titles end with the name of the base, "Base moment of i1",
/// "Gap along the base i1". `id_of`: the identity of a figure of a base.
std::string title_of(std::string_view title, const BuiltCase& built, std::size_t number);
std::size_t bases_shown(const BuiltCase& built);
std::string id_of(std::string_view id, std::size_t base);

/// What an axis of a loop shows: a column times a factor, and where `other_factor` is not 0 another column of the same owner.
struct LoopAxis {
  Request::Kind column;
  int of;  // full unknown or interface
  double factor = 1;
  Request::Kind other{};
  double other_factor = 0;
};
/// Adds the curve of two columns against each other where a run recorded both.
void add_loop(Chart& chart, const ReportRun& run, const LoopAxis& x, const LoopAxis& y);
/// The same of all runs, with the same numbers of unknowns.
Chart loop_chart(Chart chart, const std::vector<ReportRun>& runs, const LoopAxis& x, const LoopAxis& y);
/// What the case states for single figures ([[figure]]): origin and caption, by figure.
void write_figures(JsonWriter& json, const Case& read);

/// A column of a table of the report.
struct TableColumn {
  const char *key, *label, *unit, *kind;
  int digits;
};
void write_column(JsonWriter& json, const TableColumn& column);

/// The traction law of the first interface driven through openings and closings, with its largest opening so far (figure 3 of the paper);
/// without curves for a cone.
Chart law_chart(const ReportRun& run);

/// The bases before and after: gap and pressure along each of the first four, plane models with pictures.
std::vector<Chart> rest_charts(const ReportRun& run);
/// Moment, rotation, vertical and horizontal force of a foundation against each other, with what limits them.
std::vector<Chart> foundation_charts(const std::vector<ReportRun>& runs, std::size_t interface);
/// Eccentricity and safeties of the first four bases over time.
std::vector<Chart> safety_charts(const std::vector<ReportRun>& runs);

}  // namespace uplift
