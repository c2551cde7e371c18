// A block on soil, in plane strain and in space: what a condensed step costs beside one back-solve, and what the factor and the preparation
// cost. Soil 60 (x 60) x 20 m, E = 200 MPa, nu = 0.3, rho = 2000 kg/m3; block 10 (x 10) x 20 m, E = 20 GPa, nu = 0.2, rho = 2500 kg/m3;
// 4-node quads or 8-node bricks with incompatible modes; tensionless frictionless base, 2e10 Pa/m; bottom fixed, sides on rollers; gravity,
// then a half-sine of 3 MN/m (30 MN) and 0.1 s on the block's top; 500 steps of 2 ms (in space 150).
// Usage: bench_soil_block [plane|space|friction] [element sizes in m ...]; friction: in space, Coulomb friction of 0.7, 1e10 Pa/m, coarse
// soil around a fine foundation
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <set>

#include "uplift/contact/method.h"
#include "uplift/dynamics/statics.h"
#include "uplift/dynamics/step.h"
#include "uplift/elements/discrete.h"
#include "uplift/elements/solid.h"
#include "uplift/interface/face_joint.h"
#include "uplift/mesh/soil_box.h"
#include "uplift/model/builder.h"

namespace uplift {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class HalfSine final : public TimeFunction {
 public:
  double value(double t) const override { return t < duration ? std::sin(omega * t) : 0; }
  double rate(double t) const override { return t < duration ? omega * std::cos(omega * t) : 0; }
  double acceleration(double t) const override { return -omega * omega * value(t); }

 private:
  static constexpr double duration = 0.1, omega = std::numbers::pi / duration;
};

Values part(std::span<const PartInfo* const> catalog, std::string type, const std::vector<std::pair<std::string, double>>& numbers,
            const char* tangential = nullptr) {
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{std::move(type), {}, ""});
  if (tangential != nullptr) table->entries.emplace_back("tangential", Raw{std::string(tangential), {}, ""});
  for (const auto& [name, number] : numbers) table->entries.emplace_back(name, Raw{number, {}, ""});
  return check_part(Raw{table, {}, ""}, catalog);
}

struct Setup {
  Space space;
  bool friction = false;
};

Model block_on_soil(double size, Setup kind) {
  const Space space = kind.space;
  SoilBox box;
  box.dimension = space.dimension;
  box.cell = space.dimension == 2 ? Cell::quad4 : Cell::hex8;
  box.block.size = size;
  box.soil.size = kind.friction ? 8 * size : size;  // many node pairs on a bulk of the wanted size
  box.soil.layers = {{20, kind.friction ? 3 * size : size}};
  box.block.height = 20;
  Mesh mesh = soil_box(box, {});
  const std::vector<OpenedSurface> opened = split(mesh, {"interface"}, {"soil_1"}, {});
  const auto coordinates = std::make_shared<const std::vector<Vec3>>(mesh.nodes);

  ModelBuilder builder(space);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) builder.add_node(fmt::format("mesh.{}", i + 1), mesh.nodes[i], {});
  const auto add_solids = [&](const char* group, const ElasticMaterial& material) {
    SolidSection section;
    section.material = material;
    for (const CellId id : mesh.groups.at(group).cells)
      builder.add_element(std::make_unique<Solid>(mesh.type(id), mesh.cell(id), coordinates, section), {});
  };
  add_solids("soil_1", {200e6, 0.3, 2000});
  add_solids("block", {20e9, 0.2, 2500});
  std::set<std::pair<int, Dof>> held;
  const auto fix = [&](const char* group, std::initializer_list<Dof> dofs) {
    for (const int node : nodes_of(mesh, mesh.groups.at(group)))
      for (const Dof dof : dofs)
        if (space.has(dof) && held.emplace(node, dof).second) builder.fix(node, dof, {});
  };
  fix("soil_bottom", {ux, uy, uz});
  fix("soil_left", {ux});
  fix("soil_right", {ux});
  if (space.dimension == 3) fix("soil_front", {uy}), fix("soil_back", {uy});
  const std::vector<int> top = nodes_of(mesh, mesh.groups.at("block_top"));
  std::vector<std::pair<int, double>> pattern;
  double shares = 0;  // of the top that belong to a node: a half along each edge
  for (const int node : top) {
    double share = 1;
    for (int k = 0; k < space.up(); ++k)
      if (std::abs(std::abs(mesh.nodes[static_cast<std::size_t>(node)][k]) - 5) < 1e-6) share /= 2;
    pattern.emplace_back(space.at(node, ux), share);
    shares += share;
  }
  for (auto& [unknown, value] : pattern) value *= (space.dimension == 2 ? 3e6 : 30e6) / shares;
  builder.add_load("pulse", pattern, std::make_shared<HalfSine>(), false, {});
  builder.set_gravity(-9.81 * space.axis(space.up()), {});
  // nothing else holds the block sideways under gravity on a frictionless base; 0.02 Hz is far below everything that happens in a second
  if (!kind.friction) {
    builder.add_element(std::make_unique<Spring>(Connection{{top.front()}, Place(1, 0), space}, 1e4), {});
    if (space.dimension == 3)
      for (const int node : {top.front(), top.back()})
        builder.add_element(std::make_unique<Spring>(Connection{{node}, Place(0, 1), space}, 1e4), {});
  }
  InterfaceSpec base;
  base.name = "base";
  base.components = kind.friction ? 3 : 1;
  base.points = face_points(mesh, opened[0].faces, FaceQuadrature::nodal, 1, 0);
  using Numbers = std::vector<std::pair<std::string, double>>;
  const Numbers smooth{{"K_n", 2e10}}, rough{{"K_n", 2e10}, {"K_t", 1e10}, {"friction", 0.7}};
  base.law =
      make_part(law_catalog(), part(interface_behaviours(), "springs", kind.friction ? rough : smooth, kind.friction ? "coulomb" : "none"));
  base.behaviour = "springs";
  builder.add_interface(std::move(base), {});
  return builder.finish();
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
  const StaticOutcome rest = solve_statics(model, bulk, b, gap, behaviours, *method, *solver, {.steps = 1}, state, counts);
  if (!rest.converged) {
    fmt::print("{}\n", rest.why);
    return;
  }
  const double t_static = lap();
  StepOptions options;
  options.step = 2e-3;
  options.scheme = *make_part(scheme_catalog(), part(schemes(), "average_acceleration", {}));
  Stepper stepper(model, bulk, b, gap, behaviours, *method, *impact, *solver, options, counts);
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
