#include "uplift/run/run_state.h"

#include <algorithm>
#include <string_view>

#include "uplift/base/archive.h"
#include "uplift/model/numbering.h"

namespace uplift {

// ---- numbers of the linear algebra ----

template <class Archive, SameAs<Vector> T>
void list_parts(Archive& archive, T& vector) {
  if constexpr (Archive::reads) {
    std::size_t size = archive.count(sizeof(double));
    vector.resize(static_cast<Index>(size));
    for (double& value : vector) archive(value);
  } else {
    archive(static_cast<std::size_t>(vector.size()));
    for (const double& value : vector) archive(value);
  }
}

template <class Archive, SameAs<Vec3> T>
void list_parts(Archive& archive, T& vector) {
  archive(vector[0], vector[1], vector[2]);
}

template <class Archive, SameAs<Place> T>
void list_parts(Archive& archive, T& place) {
  archive(place[0], place[1], place[2]);
}

template <class Archive, SameAs<Sparse> T>
void list_parts(Archive& archive, T& matrix) {
  if constexpr (Archive::reads) {
    std::vector<Index> at;
    std::vector<double> values;
    Index rows = 0, columns = 0;
    archive(rows, columns, at, values);
    const Index count = std::ssize(values);
    const bool fits = rows >= 0 && columns >= 0 && std::ssize(at) == 2 * count;
    std::vector<Eigen::Triplet<double>> entries;
    for (Index i = 0; fits && i < count; ++i) {
      const Index row = at[static_cast<std::size_t>(2 * i)], column = at[static_cast<std::size_t>(2 * i + 1)];
      if (row < 0 || row >= rows || column < 0 || column >= columns) continue;
      entries.emplace_back(static_cast<int>(row), static_cast<int>(column), values[static_cast<std::size_t>(i)]);
    }
    matrix.resize(fits ? rows : 0, fits ? columns : 0);
    matrix.setFromTriplets(entries.begin(), entries.end());
  } else {
    std::vector<Index> at;
    std::vector<double> values;
    for (Index column = 0; column < matrix.outerSize(); ++column)
      for (Sparse::InnerIterator entry(matrix, column); entry; ++entry) {
        at.push_back(entry.row()), at.push_back(entry.col());
        values.push_back(entry.value());
      }
    archive(matrix.rows(), matrix.cols(), at, values);
  }
}

// ---- what a stage hands on ----

template <class Archive, SameAs<Energies> T>
void list_parts(Archive& archive, T& e) {
  archive(e.kinetic, e.strain, e.stored, e.interface_dissipated, e.damping, e.impact, e.external, e.residual, e.algorithmic, e.filter,
          e.plastic, e.friction, e.stop);
  static_assert(sizeof(Energies) == 13 * sizeof(double));
}

template <class Archive, SameAs<Kick> T>
void list_parts(Archive& archive, T& kick) {
  archive(kick.step, kick.acceleration, kick.force);
}

template <class Archive, SameAs<StageHandover> T>
void list_parts(Archive& archive, T& handover) {
  archive(handover.energies, handover.initial_energy, handover.largest_external, handover.acceleration, handover.kick);
}

template <class Archive, SameAs<FilterMemory> T>
void list_parts(Archive& archive, T& memory) {
  archive(memory.gain, memory.step, memory.displacement, memory.velocity, memory.opening, memory.coefficient, memory.stored);
}

template <class Archive, SameAs<State> T>
void list_parts(Archive& archive, T& state) {
  archive(state.time, state.displacement, state.velocity, state.acceleration, state.opening, state.force, state.mean_force, state.history,
          state.bulk_history, state.filter, state.load_factor);
}

template <class Archive, SameAs<StepCounts> T>
void list_parts(Archive& archive, T& counts) {
  archive(counts.steps, counts.retries, counts.iterations, counts.cycles, counts.deepest);
}

template <class Archive, SameAs<MarchState> T>
void list_parts(Archive& archive, T& march) {
  archive(march.state, march.handover, march.counts, march.start_time, march.origin, march.sizes);
}

template <class Archive, SameAs<SecondOrder> T>
void list_parts(Archive& archive, T& second_order) {
  archive(second_order.stiffness, second_order.axial);
}

// ---- what was recorded ----

template <class Archive, SameAs<InterfaceSystems> T>
void list_parts(Archive& archive, T& systems) {
  archive(systems.factored, systems.iterated);
}

template <class Archive, SameAs<LinearCounts> T>
void list_parts(Archive& archive, T& counts) {
  archive(counts.factorisations, counts.analyses, counts.back_solves, counts.residual, counts.notice, counts.remark, counts.systems);
}

template <class Archive, SameAs<Counts> T>
void list_parts(Archive& archive, T& c) {
  archive(c.steps, c.load_steps, c.retries, c.iterations, c.cycles, c.factorisations, c.back_solves, c.systems);
}

template <class Archive, SameAs<Peak> T>
void list_parts(Archive& archive, T& peak) {
  archive(peak.name, peak.unit, peak.value, peak.time);
}

template <class Archive, SameAs<CombinedPeak> T>
void list_parts(Archive& archive, T& peak) {
  archive(peak.value, peak.time, peak.least[0], peak.least[1], peak.most[0], peak.most[1], peak.known);
}

template <class Archive, SameAs<FloorRecord> T>
void list_parts(Archive& archive, T& record) {
  archive(record.step, record.acceleration);
}

template <class Archive, SameAs<EnvelopeRequest::Section> T>
void list_parts(Archive& archive, T& section) {
  archive(section.along, section.position);
}

template <class Archive, SameAs<ForceRange> T>
void list_parts(Archive& archive, T& range) {
  archive(range.most, range.most_time, range.least, range.least_time, range.met);
}

template <class Archive, SameAs<BeamEnvelope> T>
void list_parts(Archive& archive, T& envelope) {
  archive(envelope.beam, envelope.components, envelope.sections, envelope.ranges);
}

template <class Archive, SameAs<Equilibrium::Sum> T>
void list_parts(Archive& archive, T& sum) {
  archive(sum.force, sum.moment);
}

template <class Archive, SameAs<Equilibrium::Instant> T>
void list_parts(Archive& archive, T& at) {
  archive(at.time, at.inertia, at.damping, at.internal, at.joint, at.second_order, at.applied, at.reactions, at.residual,
          at.largest_reaction);
}

template <class Archive, SameAs<Equilibrium> T>
void list_parts(Archive& archive, T& equilibrium) {
  archive(equilibrium.instants, equilibrium.residual, equilibrium.time);
}

template <class Archive, SameAs<Resultant> T>
void list_parts(Archive& archive, T& r) {
  archive(r.axial, r.shear, r.moment, r.shear_1, r.shear_2, r.moment_1, r.moment_2, r.torsion);
  static_assert(sizeof(Resultant) == 8 * sizeof(double));
}

template <class Archive, SameAs<BasePose> T>
void list_parts(Archive& archive, T& pose) {
  archive(pose.slip_1, pose.slip_2, pose.settlement, pose.tilt_1, pose.tilt_2, pose.max_opening, pose.open_area);
  static_assert(sizeof(BasePose) == 7 * sizeof(double));
}

template <class Archive, SameAs<StepRecord::Instant> T>
void list_parts(Archive& archive, T& at) {
  archive(at.axial, at.shear_1, at.shear_2, at.moment_1, at.moment_2, at.open_area, at.torsion, at.pressure);
  static_assert(sizeof(StepRecord::Instant) == 8 * sizeof(double));
}

template <class Archive, SameAs<StepRecord::Reached> T>
void list_parts(Archive& archive, T& reached) {
  archive(reached.value, reached.time);
}

template <class Archive, SameAs<Interval> T>
void list_parts(Archive& archive, T& interval) {
  archive(interval.from, interval.to);
}

template <class Archive, SameAs<StepRecord::Extremes> T>
void list_parts(Archive& archive, T& e) {
  archive(e.max_opening, e.max_pressure, e.tension_area, e.penetration, e.max_slip, e.full_loss, e.least_opening, e.impulse, e.step_shear,
          e.step_moment, e.step_compression, e.step_pressure, e.bearing_utilisation, e.sliding_utilisation, e.bearing_capacity);
}

template <class Archive, SameAs<StepRecord> T>
void list_parts(Archive& archive, T& steps) {
  archive(steps.rest, steps.rest_poses, steps.tail, steps.time, steps.instants, steps.extremes);
}

template <class Archive, SameAs<Frame> T>
void list_parts(Archive& archive, T& frame) {
  archive(frame.time, frame.displacement, frame.opening, frame.pressure, frame.uplifted);
}

/// All but the columns, which are those of the plan.
template <class Archive, class T>
void list_recorded(Archive& archive, T& r) {
  archive(r.table, r.peaks, r.combined, r.floors, r.envelopes, r.frames);
}

template <class Archive, SameAs<Recorded> T>
void list_parts(Archive& archive, T& recorded) {
  list_recorded(archive, recorded);
}

template <class Archive, SameAs<RunResult> T>
void list_parts(Archive& archive, T& r) {
  list_recorded(archive, r);
  archive(r.name, r.label, r.group, r.status, r.reason, r.expected_to_fail, r.counts, r.wall, r.step_seconds, r.end_time, r.load_steps,
          r.equilibrium, r.steps, r.step_means);
  archive(r.max_uplifted_ratio, r.max_opening, r.max_base_moment, r.max_base_shear, r.max_pressure, r.max_step_pressure, r.time_uplifted,
          r.first_uplift, r.full_loss);
  archive(r.energy_created, r.energy_created_time, r.energy_lost, r.energy_lost_time, r.energy_scale, r.max_penetration, r.final_energy,
          r.problem, r.not_unique, r.notes);
}

template <class Archive, SameAs<RunState> T>
void list_parts(Archive& archive, T& run) {
  archive(run.stage, run.step, run.march);
  archive(run.state, run.handover, run.marched, run.held, run.second_order, run.static_energies, run.static_stages, run.unloaded_energy,
          run.initial_scale, run.round_off_energy);
  archive(run.result, run.load_steps, run.next_check, run.recorded_until, run.peak_frame, run.peak_uplift, run.linear);
}

void renumber(const std::vector<int>& number, RunState& run) {
  for (State* state : {&run.state, &run.march.state})
    for (Vector* vector :
         {&state->displacement, &state->velocity, &state->acceleration, &state->filter.displacement, &state->filter.velocity})
      renumber(number, *vector);
  renumber(number, run.march.handover.kick.acceleration);
  if (run.handover) renumber(number, run.handover->kick.acceleration);
  renumber(number, run.held);
}

namespace {

constexpr std::string_view magic = "uplift run state 9\n";

}  // namespace

std::string write_run_state(const RunState& state) {
  ArchiveWriter content;
  content(state);
  return sealed(magic, content.bytes());
}

std::optional<RunState> read_run_state(const std::string& bytes, std::string& why) {
  const std::optional<std::string_view> content = unsealed(magic, bytes, why);
  if (!content) return {};
  std::optional<RunState> state(std::in_place);
  ArchiveReader reader(*content);
  reader(*state);
  why = "it was written by another version of the program";
  if (reader.failed() || !reader.at_end()) return {};
  why.clear();
  return state;
}

}  // namespace uplift
