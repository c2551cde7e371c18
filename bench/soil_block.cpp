// A block on soil (block_on_soil.h): what a condensed step costs beside one back-solve, and what the factor and the preparation cost; 500
// steps of 2 ms (in space 150).
// Usage: bench_soil_block [plane|space|friction] [element sizes in m ...]; friction: in space, Coulomb friction of 0.7, 1e10 Pa/m, coarse
// soil around a fine foundation
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>

#include "bench/block_on_soil.h"
#include "uplift/contact/method.h"
#include "uplift/dynamics/statics.h"
#include "uplift/dynamics/step.h"

namespace uplift {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int steps_of(Setup kind) {
  return kind.space.dimension == 2 ? 500 : 150;  // the pulse and the first uplift
}

void measure(double size, Setup kind) {
  double start = now();
  const auto lap = [&start] {
    const double seconds = now() - start;
    start = now();
    return seconds;
  };
  const Model model = block_on_soil(size, kind);
  const double t_model = lap();
  const Bulk bulk(model, nullptr);
  const Sparse b = stack_interfaces(model);
  const Vector gap = Vector::Zero(b.rows());
  const auto method = make_part(method_catalog(), part(contact_methods(), "newton", {}));
  const auto impact = make_part(impact_catalog(), part(impact_rules(), "none", {}));
  const auto solver = make_part(solver_catalog(), part(linear_solvers(), "cholmod", {}));
  const Behaviours behaviours(model, *method, nullptr);
  LinearCounts counts;
  State state;
  state.displacement = state.velocity = state.acceleration = Vector::Zero(model.free());
  state.opening = state.force = state.mean_force = Vector::Zero(b.rows());
  state.history.setZero(behaviours.history);
  const StaticOutcome rest = solve_statics({model, bulk, b, gap}, {behaviours, *method}, *solver, {.steps = 1}, state, counts);
  if (!rest.converged) {
    fmt::print("{}\n", rest.why);
    return;
  }
  const double t_static = lap();
  StepOptions options;
  options.step = 2e-3;
  options.scheme = *make_part(scheme_catalog(), part(schemes(), "average_acceleration", {}));
  Stepper stepper({model, bulk, b, gap}, {behaviours, *method}, *impact, *solver, options, counts);
  stepper.start(state);
  stepper.advance();
  const double t_first = lap();
  std::vector<double> steps;
  double open = 0;
  for (int k = 1; k < steps_of(kind); ++k) {
    const double begin = now();
    if (!stepper.advance()) {
      fmt::print("step {}: {}\n", k, stepper.why());
      return;
    }
    steps.push_back(now() - begin);
    open = std::max(open, uplifted_ratio(model.interfaces[0], stepper.state().opening.data(), 1e-9));
  }
  std::sort(steps.begin(), steps.end());

  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);

  // one back-solve of the same matrix, in the same run
  const Sparse matrix = bulk.stiffness_matrix + 4 / (options.step * options.step) * bulk.mass_matrix;
  const BulkFactor factor(matrix, &b, bulk.small, *solver, model, counts);
  std::vector<double> solves;
  BulkWork work(counts);
  Vector x = Vector::Zero(model.free());
  const Vector right = Vector::Ones(model.free());
  for (int k = 0; k < 50; ++k) {
    const double begin = now();
    factor.solve(right, x, work);
    solves.push_back(now() - begin);
  }
  std::sort(solves.begin(), solves.end());
  const Energies& e = stepper.energies();
  const double step = steps[steps.size() / 2], solve = solves[solves.size() / 2];
  fmt::print(
      "{:7} nodes {:7} unknowns {:4} points | model {:6.2f} s, gravity {:6.2f} s, factor {:6.2f} s | step {:7.2f} ms (least {:.2f}), "
      "back-solve {:7.2f} ms, ratio {:.2f} | factor {:.1f} MB, peak {:.0f} MB | iterations/step {:.2f}, uplift {:.0f} %, residual {:.1e}\n",
      model.nodes.size(), model.free(), b.rows(), t_model, t_static, t_first, 1e3 * step, 1e3 * steps.front(), 1e3 * solve, step / solve,
      8e-6 * factor.split()->nonzeros(), 1.024e-3 * static_cast<double>(usage.ru_maxrss),
      static_cast<double>(stepper.counts().iterations) / steps_of(kind), 100 * open,
      e.residual / std::max(stepper.largest_external(), e.kinetic));
}

}  // namespace
}  // namespace uplift

int main(int count, char** words) {
  const std::string_view word = count > 1 ? words[1] : "";
  const bool named = word == "plane" || word == "space" || word == "friction";
  const uplift::Setup kind{{word == "space" || word == "friction" ? 3 : 2}, word == "friction"};
  std::vector<double> sizes;
  for (int i = named ? 2 : 1; i < count; ++i) sizes.push_back(std::atof(words[i]));
  if (sizes.empty())
    sizes = kind.space.dimension == 2 ? std::vector<double>{1.0, 0.39, 0.195}
            : kind.friction           ? std::vector<double>{0.5}
                                      : std::vector<double>{2.5, 1.67};
  for (const double size : sizes) uplift::measure(size, kind);
}
