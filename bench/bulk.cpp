// What the linear bulk of a block on soil takes beside what was predicted: memory, factorisation, back-solve, interface blocks, impulses
// and modes. One line per size; each size is measured in a process of its own, because peaks of memory do not go down. Usage: bench_bulk
// [cells of the soil along one side ...]   3D: 8-node bricks; negative: plane strain, 4-node quads.
// With BULK_MODES in the environment 20 modes, too.
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>

#include "tests/two_boxes.h"
#include "uplift/base/declare.h"
#include "uplift/dynamics/cost.h"
#include "uplift/dynamics/split_response.h"
#include "uplift/math/symmetric_pair.h"

namespace uplift {
namespace {

/// Processor time of this process [s]: what it would take on a machine of its own.
double now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// "VmHWM:" (peak) or "VmRSS:" of this process [bytes].
double status(const std::string& word) {
  std::ifstream file("/proc/self/status");
  std::string line;
  while (std::getline(file, line))
    if (line.starts_with(word)) return 1024 * std::atof(line.c_str() + word.size());
  return 0;
}

template <class Work>
double seconds(const Work& work) {
  const double start = now();
  work();
  return now() - start;
}

template <class Work>
double median_ms(int times, const Work& work) {
  std::vector<double> all;
  for (int k = 0; k < times; ++k) all.push_back(1e3 * seconds(work));
  std::sort(all.begin(), all.end());
  return all[all.size() / 2];
}

Model model_of(const TwoBoxesPlan& plan) {
  TwoBoxes boxes = two_boxes(plan);
  Model model;
  const Index n = boxes.stiffness.rows();
  model.expansion.resize(n, n);
  model.expansion.setIdentity();
  model.damping.resize(n, n);
  Interface base;
  base.batch.components = plan.slips ? 2 : 1;
  base.batch.points = static_cast<int>(boxes.b.rows()) / base.batch.components;
  base.b = std::move(boxes.b);
  model.interfaces.push_back(std::move(base));
  model.stiffness = std::move(boxes.stiffness);
  model.mass = std::move(boxes.mass);
  return model;
}

void measure(int cells, bool with_modes) {
  TwoBoxesPlan plan;
  plan.dimension = cells > 0 ? 3 : 2;
  const int side = std::abs(cells);
  plan.soil = {side, side, side / 3};
  plan.block_width = side / 5;
  plan.block_height = side / 3;
  plan.size = 60.0 / side;
  const Model model = model_of(plan);
  const auto solver = solver_catalog()[0]->make(Values());
  const double resting = status("VmRSS:"), before = status("VmHWM:");
  BulkCost cost;
  const double t_predict = seconds([&] { cost = predict_bulk(model, *solver, {.impacts = true}); });
  const double predicted_peak = status("VmHWM:");
  fmt::print(
      "{} unknowns, {} rows touch {} | model at rest {:.0f} MB (peak while assembled {:.0f} MB), prediction in {:.2f} s (peak {:.0f} MB)\n",
      model.free(), model.interfaces[0].rows(), cost.touched, 1e-6 * resting, 1e-6 * before, t_predict, 1e-6 * predicted_peak);
  fmt::print(
      "  predicted: factor {:.1f} MB ({:.3g} operations), of M {:.1f} MB, interface {:.1f} MB, all {:.0f} MB; {:.2f} s, back-solve {:.2f} "
      "ms\n",
      1e-6 * cost.step.bytes, cost.step.operations, 1e-6 * cost.mass.bytes, 1e-6 * cost.interface_bytes, 1e-6 * cost.bytes,
      cost.factor_seconds, 1e3 * cost.solve_seconds);

  const Sparse b = stack_interfaces(model);
  LinearCounts counts;
  const Bulk bulk(model, nullptr);
  std::unique_ptr<BulkFactor> factor;
  const double t_step = seconds([&] {
    const Sparse matrix = model.stiffness + 1e6 * model.mass;
    factor = std::make_unique<BulkFactor>(matrix, &b, false, *solver, model, counts);
  });
  std::unique_ptr<Accelerator> accelerator;
  const double t_mass = seconds([&] { accelerator = std::make_unique<Accelerator>(model, bulk, &b, *solver, counts); });
  const SymmetricPair pair(model.stiffness, model.mass);
  const double after_factor = status("VmHWM:");
  std::unique_ptr<SplitResponse> response;
  Spread spread;
  const double t_response = seconds([&] { response = std::make_unique<SplitResponse>(*factor, b, counts); });
  const double t_spread = seconds([&] { spread = accelerator->spread(b); });
  Vector right = Vector::Ones(model.free()), x = Vector::Zero(model.free());
  BulkWork work(counts);
  const double solve = median_ms(11, [&] { factor->solve(right, x, work); });
  const Vector z = Vector::Ones(spread.factor.cols());
  const double impulse = median_ms(11, [&] { spread.add(1, z, x); });
  const double matrices = 12.0 * static_cast<double>(model.stiffness.nonZeros() + model.mass.nonZeros());
  const double factors = cost.step.bytes + cost.mass.bytes, peak = status("VmHWM:");
  fmt::print(
      "  measured: {:.2f} s (M {:.2f}, step {:.2f}), blocks {:.2f} s (step {:.2f}, M {:.2f}), back-solve {:.2f} ms, impulse {:.2f} ms; "
      "peak {:.0f} MB "
      "(with the factors {:.0f}) = {:.2f} x factors + matrices ({:.0f} MB)\n",
      t_mass + t_step, t_mass, t_step, t_response + t_spread, t_response, t_spread, solve, impulse, 1e-6 * peak, 1e-6 * after_factor,
      (peak - matrices) / factors, 1e-6 * matrices);
  fmt::print("  dense spread of impulses would be {:.0f} MB; residual of the trial {:.1e}\n",
             8e-6 * static_cast<double>(model.free()) * static_cast<double>(spread.factor.cols()), counts.residual);
  if (with_modes) {
    std::vector<Mode> found;
    const double t_modes = seconds([&] { found = modes(model.stiffness, model.mass, 20); });
    fmt::print("  20 modes in {:.2f} s: {:.4g} to {:.4g} Hz\n", t_modes, found.front().frequency, found.back().frequency);
  }
}

}  // namespace
}  // namespace uplift

int main(int count, char** words) {
  std::vector<int> sizes;
  const bool with_modes = getenv("BULK_MODES") != nullptr;
  for (int i = 1; i < count; ++i) sizes.push_back(std::atoi(words[i]));
  if (sizes.empty()) sizes = {-120, -240, 20, 32};
  for (const int size : sizes) {
    std::fflush(stdout);
    if (const pid_t child = fork(); child == 0) {
      uplift::measure(size, with_modes);
      std::fflush(stdout);
      _exit(0);
    } else {
      waitpid(child, nullptr, 0);
    }
  }
}
