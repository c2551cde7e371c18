#include "uplift/io/fields/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "uplift/base/archive.h"
#include "uplift/base/text.h"
#include "uplift/io/fields/run_frames.h"

namespace uplift {
namespace {

constexpr long usual_frames = 100;
constexpr std::int64_t most_vtu = 200'000'000;  // bytes: beyond, the mesh in every file and base64 cost too much

long steps_of(const Stage& stage) {
  return std::max(1L, std::lround(stage.duration / stage.step));
}

bool is_static(const RunPlan& plan, std::size_t stage) {
  return stage < plan.stages.size() && plan.stages[stage].type == Stage::Type::statics;
}
bool is_dynamic(const RunPlan& plan, std::size_t stage) {
  return stage < plan.stages.size() && plan.stages[stage].type == Stage::Type::dynamics;
}

/// Every how many steps; 0: not at all.
long every_of(const CaseFields& fields, const RunPlan& plan) {
  if (fields.every) return *fields.every;
  if (fields.events) return 0;
  long steps = 0;
  for (const Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics) steps += steps_of(stage);
  return std::max(1L, (steps + usual_frames - 1) / usual_frames);
}

long frames_of(const CaseFields& fields, const RunPlan& plan) {
  const long every = every_of(fields, plan);
  long frames = 0;
  bool moving = false;
  for (std::size_t s = 0; s < plan.stages.size(); ++s) {
    if (is_static(plan, s) && !is_dynamic(plan, s + 1)) ++frames;
    if (!is_dynamic(plan, s)) continue;
    if (!moving && every > 0) ++frames;  // its beginning
    frames += every > 0 ? (steps_of(plan.stages[s]) + every - 1) / every : 1;
    moving = true;
  }
  return frames + (fields.events && moving ? 3 : 0);
}

FieldPrecision precision_of(const CaseFields& fields) {
  return fields.float32 ? FieldPrecision::float32 : FieldPrecision::float64;
}

FieldForecast forecast(const CaseFields& fields, const RunFrames& frames, const RunPlan& plan) {
  const FieldPrecision precision = precision_of(fields);
  const auto of = [&](FieldFormat format) {
    return FieldForecast{format, frames_of(fields, plan), size_per_frame(format, frames.blocks(), frames.empty(), precision)};
  };
  if (fields.format) return of(*fields.format == CaseFields::Format::vtu ? FieldFormat::vtu : FieldFormat::xdmf);
  const FieldForecast vtu = of(FieldFormat::vtu);
  return vtu.bytes() <= most_vtu ? vtu : of(FieldFormat::xdmf);
}

/// The disk must have room before the run starts, not only hours later.
void check_room(const CaseFields& fields, std::int64_t bytes, const std::string& folder) {
  std::error_code error;
  const std::filesystem::space_info disk = std::filesystem::space(folder, error);
  if (!error && disk.available < static_cast<std::uintmax_t>(bytes))
    throw InputError(fields.where(), fields.path(), "room for " + format_bytes(static_cast<double>(bytes)) + " of fields",
                     format_bytes(static_cast<double>(disk.available)) + " on the disk");
}

}  // namespace

std::optional<FieldForecast> field_forecast(const Case& read, const BuiltCase& built) {
  const std::optional<CaseFields>& fields = read.input->output.fields;
  if (!fields) return std::nullopt;
  return forecast(*fields, RunFrames(*fields, read, built), built.plan);
}

FieldRun::FieldRun(const Case& read, const BuiltCase& built, ResultFolder& folder) : plan_(built.plan), folder_(folder) {
  const CaseFields& fields = *read.input->output.fields;
  frames_ = std::make_unique<const RunFrames>(fields, read, built);
  every_ = every_of(fields, plan_);
  events_ = fields.events;
  const FieldForecast wanted = forecast(fields, *frames_, plan_);
  const std::string stem = "fields/" + plan_.name, data = folder.place(stem + ".h5");
  // the journal of a run with checkpoints holds every frame once more, in float64
  const int times = !read.input->output.checkpoint ? 1 : precision_of(fields) == FieldPrecision::float32 ? 3 : 2;
  check_room(fields, times * wanted.bytes(), std::filesystem::path(data).parent_path().string());
  if (wanted.format == FieldFormat::vtu)
    vtu_.emplace(stem, frames_->blocks(), precision_of(fields), into(folder));
  else
    xdmf_.emplace(stem, frames_->blocks(), precision_of(fields), Hdf5Writer::create(data));
  list_ = stem + (vtu_ ? ".pvd" : ".xdmf");
}

FieldRun::~FieldRun() = default;

void FieldRun::see(const Snapshot& snapshot) {
  if (!snapshot.stepper) return see_static(snapshot);
  if (events_) see_events(snapshot);
  if (!snapshot.last && (every_ == 0 || snapshot.step % every_ != 0)) return;
  Vector acceleration;
  snapshot.stepper->acceleration(acceleration);
  write(snapshot.state, &acceleration, section_forces(snapshot, &acceleration), snapshot.state.time);
}

void FieldRun::see_static(const Snapshot& snapshot) {
  if (is_dynamic(plan_, snapshot.stage + 1) && snapshot.so_far.status == RunStatus::completed) return;
  std::size_t later = snapshot.stage;
  bool first = true;
  for (std::size_t s = 0; s < snapshot.stage; ++s) first = first && is_static(plan_, s);
  if (first) {
    while (is_static(plan_, later + 1)) ++later;
    return write(snapshot.state, nullptr, section_forces(snapshot, nullptr),
                 snapshot.state.time - static_cast<double>(later - snapshot.stage));
  }
  double step = 0;
  for (std::size_t s = 0; s < snapshot.stage; ++s)
    if (is_dynamic(plan_, s)) step = plan_.stages[s].step;
  write(snapshot.state, nullptr, section_forces(snapshot, nullptr), snapshot.state.time + step / 2);
}

void FieldRun::see_events(const Snapshot& snapshot) {
  if (snapshot.so_far.first_uplift >= 0 && !std::exchange(uplifted_, true)) {
    Vector acceleration;
    snapshot.stepper->acceleration(acceleration);
    write(snapshot.state, &acceleration, section_forces(snapshot, &acceleration), snapshot.state.time);
  }
  keep(gap_, snapshot.so_far.max_opening.value, snapshot);
  keep(pressure_, snapshot.so_far.max_pressure.value, snapshot);
}

void FieldRun::keep(Kept& kept, double value, const Snapshot& snapshot) {
  if (!(value > kept.largest)) return;
  kept.largest = value;
  kept.state = snapshot.state;
  snapshot.stepper->acceleration(kept.acceleration);
  kept.section_forces = section_forces(snapshot, &kept.acceleration);
  kept.frame.reset();
}

FieldFrame FieldRun::frame_of(const Kept& kept) const {
  return kept.frame ? *kept.frame : frames_->of(kept.state, &kept.acceleration, kept.section_forces, kept.state.time);
}

std::vector<double> FieldRun::section_forces(const Snapshot& snapshot, const Vector* acceleration) {
  std::vector<double> values;
  if (frames_->section_forces().empty()) return values;
  if (meter_ == nullptr || metered_ != snapshot.stage) {
    meter_ = std::make_unique<const ForceMeter>(ForceModel(snapshot.forces), frames_->section_forces());
    metered_ = snapshot.stage;
  }
  const Vector still = Vector::Zero(snapshot.state.displacement.size());
  meter_->measure(acceleration ? StepBalance::of_state(snapshot.state, *acceleration) : StepBalance::at_rest(snapshot.state, still),
                  values);
  return values;
}

void FieldRun::write(const State& state, const Vector* acceleration, const std::vector<double>& section_forces, double time) {
  if (!disk_refused_ && !times_.contains(time)) write(frames_->of(state, acceleration, section_forces, time));
}

void FieldRun::write(const FieldFrame& frame) {
  if (disk_refused_ || times_.contains(frame.time)) return;
  std::optional<FieldTrouble> trouble;
  try {
    trouble = vtu_ ? vtu_->write(frame) : xdmf_->write(frame);
  } catch (const InputError&) {
    return stop_writing();
  }
  if (!trouble) {
    times_.insert(frame.time);
    if (journal_) journal_->append(frame);
    return;
  }
  if (left_out_++ == 0) trouble_ = fmt::format("{} at t = {:.6g} s", trouble->reason, frame.time);
}

void FieldRun::stop_writing() {
  disk_refused_ = true;
  if (journal_) journal_->fail();
  folder_.note_failure(list_, "the system refused a part of its data (a full disk, or a file that is too large)");
}

FieldRun::Memory FieldRun::memory() {
  ArchiveWriter rest;
  rest(uplifted_, left_out_, trouble_);
  for (const Kept* kept : {&gap_, &pressure_}) {
    rest(kept->largest);
    if (kept->largest > 0) rest(frame_of(*kept));
  }
  return {journal_->sync(), rest.bytes()};
}

void FieldRun::resume(const Memory& memory, const std::string& journal) {
  std::string why;
  read_journal(
      journal, memory.frames, [this](const FieldFrame& frame) { write(frame); }, why);
  ArchiveReader rest(memory.rest);
  rest(uplifted_, left_out_, trouble_);
  for (Kept* kept : {&gap_, &pressure_}) {
    rest(kept->largest);
    if (kept->largest > 0) rest(kept->frame.emplace());
  }
}

void FieldRun::finish(RunResult& result) {
  for (const Kept* kept : {&gap_, &pressure_})
    if (kept->largest > 0) write(frame_of(*kept));
  try {
    if (vtu_) vtu_->finish();
    if (xdmf_ && !disk_refused_) xdmf_->finish(into(folder_));
  } catch (const InputError&) {
    stop_writing();
  }
  if (left_out_ > 0)
    result.notes.push_back(fmt::format("{} of the fields {} left out: {}", left_out_ == 1 ? "a frame" : fmt::format("{} frames", left_out_),
                                       left_out_ == 1 ? "was" : "were", trouble_));
}

}  // namespace uplift
