#include "uplift/io/results/motions_json.h"

#include <numbers>
#include <utility>

#include "uplift/io/results/words.h"
#include "uplift/motion/formats/convert.h"

namespace uplift {
namespace {

void write_motion(ResultWriter& out, const Motion& motion) {
  out.text("name", motion.name, "name of the record in the case");
  out.text("file", motion.file, "file; empty for a generated motion");
  out.text("sha256", motion.sha256, "hash of the file");
  out.text("format", motion.format, "format of the file, or generator");
  out.text("event", motion.event, "earthquake, where the file names it");
  out.text("station", motion.station, "station, where the file names it");
  out.text("component", motion.component, "component, where the file names it");
  std::optional<double> azimuth;
  if (motion.azimuth) azimuth = *motion.azimuth * 180 / std::numbers::pi;
  out.number("azimuth_degrees", azimuth, "degree", "direction of a horizontal component, clockwise from north");
  out.word("quantity", to_string(motion.kind), {"acceleration", "velocity", "displacement"}, "recorded quantity");
  out.text("unit", motion.unit, "unit of the numbers in the file");
  out.number("factor", motion.factor, "1", "factor from the numbers of the file to SI units");
  out.texts("repairs", motion.repairs, "irregularities of the file that were corrected when it was read");
  out.texts("processing", motion.processing, "processing steps in their order");
  out.number("step", motion.step, "s", "time step");
  out.count("count", static_cast<long>(motion.values.size()), "number of values");
  out.number("duration", motion.duration(), "s", "duration");
  const Motion acceleration = out.is_schema() ? Motion() : converted(motion, MotionKind::acceleration);
  const MotionPeak peak = out.is_schema() ? MotionPeak() : peak_of(acceleration);
  write_peak(out, "pga", {"", "m/s2", peak.value, peak.time}, "m/s2", "peak ground acceleration after processing");
}

/// One value of every quantity: keys are those of the table.
void write_values(ResultWriter& out, const char* key, const char* meaning, const MotionTable& table, const std::vector<double>& values) {
  out.object(key, meaning, [&] {
    for (std::size_t k = 0; k < values.size(); ++k)
      out.when(true).number(table.quantities[k].key, values[k], table.quantities[k].unit, table.quantities[k].label);
  });
}

}  // namespace

void write_motions(ResultWriter& out, const Histories& motions) {
  out.list("motions", "recorded and generated motions", motions,
           [&](const std::shared_ptr<const MotionHistory>& history) { write_motion(out, history ? *history->motion() : Motion()); });
}

void write_over_motions(ResultWriter& out, const std::vector<MotionTable>& tables) {
  out.list("over_motions", "largest magnitudes of each variant over the motions of the comparison", tables, [&](const MotionTable& given) {
    MotionTable table = given;
    if (out.is_schema()) {  // with all quantities that there can be
      table.quantities = motion_quantities();
      table.rows.resize(1);
      for (std::vector<double>* each : {&table.rows.front().peaks, &table.envelope, &table.mean, &table.spread})
        each->resize(table.quantities.size());
    }
    out.text("run", table.run, "label of the variant");
    out.text("damping", table.damping, "label of the damping; empty where there is only one");
    out.count("counted", table.counted, "completed runs: those of envelope, mean and spread");
    out.object("units", "units of the quantities", [&] {
      for (const MotionTable::Quantity& quantity : table.quantities) out.when(true).constant(quantity.key, quantity.unit, quantity.label);
    });
    out.list("motions", "the runs of the variant", table.rows, [&](const MotionTable::Row& each) {
      const MotionTable::Row& row = out.is_schema() ? table.rows.front() : each;
      out.text("motion", row.motion, "label of the motion");
      out.word("status", to_string(row.status), run_status_words(), "outcome of the run");
      write_values(out, "peaks", "largest magnitudes", table, row.peaks);
    });
    write_values(out, "envelope", "largest of the completed runs", table, table.envelope);
    write_values(out, "mean", "mean of the completed runs", table, table.mean);
    write_values(out, "spread", "standard deviation of the sample of the completed runs", table, table.spread);
  });
}

}  // namespace uplift
