// The interface problem of a raft with friction: what every contact method costs a step. A raft of 20 x 20 node pairs (1200 rows) under an
// eccentric tower rocks, uplifts and slips on soil, all of 8-node bricks; horizontal and oblique harmonic push that grows.
// Constraint methods are given the same problems (those of the run by Lagrange multipliers), so that their answers are compared; traction
// laws make runs of their own.
// Usage: bench_raft_contact [steps [node pairs along an edge [run ...]]], runs: lagrange springs sdm penalty
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <string>

#include "uplift/contact/compliance.h"
#include "uplift/contact/method.h"
#include "uplift/elements/solid.h"
#include "uplift/linear/solver.h"

namespace uplift {
namespace {

/// Time of this thread [s]: others on the machine do not count.
double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

using Numbers = std::vector<std::pair<std::string, double>>;
Values part(std::span<const PartInfo* const> catalog, const std::string& type, const Numbers& numbers, bool friction = false) {
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{type, {}, ""});
  for (const auto& [name, number] : numbers) table->entries.emplace_back(name, Raw{number, {}, ""});
  if (friction) table->entries.emplace_back("tangential", Raw{std::string("coulomb"), {}, ""});
  return check_part(Raw{table, {}, ""}, catalog);
}

/// Soil, raft and tower: free unknowns only, and the openings of the raft's node pairs.
struct System {
  Sparse stiffness, mass, b;
  Vector weight, push;
  std::vector<double> area;
  Index free = 0;
};

System raft_on_soil(int pairs) {
  const int cells = pairs - 1, margin = 3, depth = 6, wide = cells + 2 * margin;
  auto nodes = std::make_shared<std::vector<Vec3>>();
  std::vector<int> first_free;  // of a node; -1: fixed
  Index unknowns = 0;
  const auto add_node = [&](double x, double y, double z, bool fixed) {
    nodes->push_back(Vec3(x, y, z));
    first_free.push_back(fixed ? -1 : static_cast<int>(unknowns));
    unknowns += fixed ? 0 : 3;
    return static_cast<int>(nodes->size()) - 1;
  };
  const auto grid = [&](int nx, int ny, int nz, const Vec3& origin, double height, bool soil) {
    std::vector<int> ids;
    for (int k = 0; k <= nz; ++k)
      for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i)
          ids.push_back(add_node(origin.x() + i, origin.y() + j, origin.z() + k * height,
                                 soil && (k == 0 || i == 0 || j == 0 || i == nx || j == ny)));
    return ids;
  };
  struct Brick {
    std::array<int, 8> nodes;
    ElasticMaterial material;
  };
  std::vector<Brick> bricks;
  const auto fill = [&](const std::vector<int>& ids, int nx, int ny, int nz, const ElasticMaterial& material) {
    const auto id = [&](int i, int j, int k) { return ids[static_cast<std::size_t>((k * (ny + 1) + j) * (nx + 1) + i)]; };
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
          bricks.push_back({{id(i, j, k), id(i + 1, j, k), id(i + 1, j + 1, k), id(i, j + 1, k), id(i, j, k + 1), id(i + 1, j, k + 1),
                             id(i + 1, j + 1, k + 1), id(i, j + 1, k + 1)},
                            material});
  };
  const std::vector<int> soil = grid(wide, wide, depth, Vec3(0, 0, -depth), 1, true);
  fill(soil, wide, wide, depth, {200e6, 0.3, 2000});
  const std::vector<int> raft = grid(cells, cells, 1, Vec3(margin, margin, 0), 1, false);
  fill(raft, cells, cells, 1, {30e9, 0.2, 2500});
  // tower: eccentric, its lowest nodes are those of the raft's top
  const int side = std::max(2, cells / 3), at = (cells - side) / 2 + 1, storeys = 8;
  const double storey = 2;
  std::vector<int> tower;
  for (int k = 0; k <= storeys; ++k)
    for (int j = 0; j <= side; ++j)
      for (int i = 0; i <= side; ++i)
        tower.push_back(k == 0 ? raft[static_cast<std::size_t>((pairs + at + j) * pairs + at + i)]
                               : add_node(margin + at + i, margin + at + j, 1 + k * storey, false));
  fill(tower, side, side, storeys, {10e9, 0.2, 2500});

  System system;
  system.free = unknowns;
  std::vector<Triplet> k_entries, m_entries, b_entries;
  Matrix k, m;
  for (const Brick& brick : bricks) {
    SolidSection section;
    section.material = brick.material;
    const Solid solid(Cell::hex8, brick.nodes, nodes, section);
    solid.form({&k, &m, nullptr});
    for (int r = 0; r < 24; ++r)
      for (int c = 0; c < 24; ++c) {
        const int row = first_free[static_cast<std::size_t>(brick.nodes[static_cast<std::size_t>(r / 3)])];
        const int column = first_free[static_cast<std::size_t>(brick.nodes[static_cast<std::size_t>(c / 3)])];
        if (row < 0 || column < 0) continue;
        k_entries.emplace_back(row + r % 3, column + c % 3, k(r, c));
        m_entries.emplace_back(row + r % 3, column + c % 3, m(r, c));
      }
  }
  for (auto [matrix, entries] : {std::pair{&system.stiffness, &k_entries}, std::pair{&system.mass, &m_entries}}) {
    matrix->resize(unknowns, unknowns);
    matrix->setFromTriplets(entries->begin(), entries->end());
  }
  const int n = pairs * pairs;
  for (int j = 0; j < pairs; ++j)
    for (int i = 0; i < pairs; ++i) {
      const int below = soil[static_cast<std::size_t>((depth * (wide + 1) + j + margin) * (wide + 1) + i + margin)];
      const int above = raft[static_cast<std::size_t>(j * pairs + i)];
      for (int c = 0; c < 3; ++c) {
        b_entries.emplace_back(c * n + j * pairs + i, first_free[static_cast<std::size_t>(above)] + c, 1.0);
        b_entries.emplace_back(c * n + j * pairs + i, first_free[static_cast<std::size_t>(below)] + c, -1.0);
      }
      system.area.push_back((i == 0 || i == cells ? 0.5 : 1.0) * (j == 0 || j == cells ? 0.5 : 1.0));
    }
  system.b.resize(3 * n, unknowns);
  system.b.setFromTriplets(b_entries.begin(), b_entries.end());

  Vector down = Vector::Zero(unknowns);
  const int first_structure = first_free[static_cast<std::size_t>(raft.front())];
  for (Index i = first_structure + 2; i < unknowns; i += 3) down[i] = -9.81;
  system.weight = system.mass * down;
  system.push = Vector::Zero(unknowns);
  const double total = -system.weight.sum(), level = static_cast<double>((side + 1) * (side + 1));
  for (int j = 0; j <= side; ++j)
    for (int i = 0; i <= side; ++i) {
      const int node = tower[static_cast<std::size_t>((storeys * (side + 1) + j) * (side + 1) + i)];
      system.push[first_free[static_cast<std::size_t>(node)]] = 0.8 * total / level;
      system.push[first_free[static_cast<std::size_t>(node)] + 1] = 0.45 * total / level;
    }
  return system;
}

/// Times and ends of the solves of one method.
struct Record {
  explicit Record(std::string method_name) : name(std::move(method_name)) {}
  std::string name;
  std::vector<double> times;
  long iterations = 0, cycles = 0, changes = 0;
  int failures = 0;
  double worst_yardstick = 0, worst_difference = 0;
  std::string why;
  std::vector<Status> before;
  InterfaceSolution solution;
  std::unique_ptr<MethodWork> work;

  bool solve(const ContactMethod& method, const InterfaceProblem& problem) {
    const double start = now();
    if (work == nullptr) work = method.make_work();
    const Outcome outcome = method.solve(problem, *work, solution);
    times.push_back(1e3 * (now() - start));
    iterations += outcome.iterations;
    cycles += outcome.cycles;
    if (!outcome.converged) {
      ++failures;
      if (why.empty()) why = fmt::format("step {}: {}", times.size(), outcome.why);
      return false;
    }
    worst_yardstick = std::max(worst_yardstick, contact_residual(problem, solution));
    for (std::size_t i = 0; i < std::min(before.size(), solution.status.size()); ++i) changes += before[i] != solution.status[i];
    before = solution.status;
    return true;
  }
  void print() {
    const double steps = static_cast<double>(times.size());
    double sum = 0;
    for (const double t : times) sum += t;
    std::sort(times.begin(), times.end());
    fmt::print(
        "{:22} mean {:8.2f} median {:8.2f} 95 % {:8.2f} worst {:8.2f} ms; iterations {:5.2f} cycles {} changes {:4.1f} a step; "
        "residual {:.1e} difference {:.1e}; failed {} of {} {}\n",
        name, sum / steps, times[times.size() / 2], times[times.size() * 95 / 100], times.back(), static_cast<double>(iterations) / steps,
        cycles, static_cast<double>(changes) / steps, worst_yardstick, worst_difference, failures, times.size(), why);
    std::fflush(stdout);
  }
};

/// The march: trapezoidal midpoint form with path averages for traction laws, damped Newmark (gamma = 0.6) for constraints.
class March {
 public:
  March(const System& system, bool average) : system_(system), average_(average) {
    gamma_ = average ? 0.5 : 0.6;
    beta_ = 0.25 * (gamma_ + 0.5) * (gamma_ + 0.5);
    damping_ = 0.002 * system.stiffness + 0.2 * system.mass;
    const Sparse effective = system.stiffness + (gamma_ / (beta_ * step)) * damping_ + (1 / (beta_ * step * step)) * system.mass;
    solver_ = make_part(solver_catalog(), part(linear_solvers(), "cholmod", {}));
    factor_ = solver_->factorise(effective).factor;
    compliance_ = spread_through(*factor_, system.b).factor;
    for (Vector* v : {&u_, &v_, &a_}) v->setZero(system.free);
  }
  static constexpr double step = 0.005;

  InterfaceProblem frame(const InterfaceLaw* law, const Cone* cone) const {
    ContactModel model;
    Block block;
    block.name = "raft";
    block.batch = Batch{static_cast<int>(system_.area.size()), 3, 0};
    block.law = law;
    block.cone = cone;
    block.area = ConstMap(system_.area.data(), static_cast<Index>(system_.area.size()));
    model.blocks.push_back(block);
    model.factor = compliance_;
    model.average = average_;
    model.scale = average_ ? 2 : 1;
    model.step = step;
    return problem_of(std::make_shared<const ContactModel>(std::move(model)));
  }

  void predict(InterfaceProblem& problem) {
    const double t0 = time_, t1 = time_ + step;
    const Vector f0 = load(t0), f1 = load(t1);
    if (average_)
      right_ = f0 + f1 - 2 * (system_.stiffness * u_) + (4 / step) * (system_.mass * v_);
    else
      right_ = f1 - system_.stiffness * u_ + system_.mass * (v_ / (beta_ * step) + (1 / (2 * beta_) - 1) * a_).eval() -
               damping_ * ((1 - gamma_ / beta_) * v_ + step * (1 - gamma_ / (2 * beta_)) * a_).eval();
    factor_->solve(right_, free_);
    problem.free_opening = system_.b * (u_ + free_);
    problem.from = system_.b * u_;
  }

  void correct(const Vector& force) {
    Matrix du;
    factor_->solve(Matrix(right_ - system_.b.transpose() * force), du);
    const Vector d = du.col(0), v0 = v_;
    u_ += d;
    if (average_) {
      v_ = (2 / step) * d - v0;
    } else {
      const Vector a0 = a_;
      a_ = (d - step * v0) / (beta_ * step * step) - (1 / (2 * beta_) - 1) * a0;
      v_ = v0 + step * ((1 - gamma_) * a0 + gamma_ * a_);
    }
    time_ += step;
  }

 private:
  Vector load(double t) const {
    const double begun = 0.4, ramp = std::min(1.0, t / 0.3), rise = std::clamp((t - begun) / 1.0, 0.0, 1.0);
    const double swing = t > begun ? std::sin(2 * std::numbers::pi * 1.5 * (t - begun)) : 0;
    return ramp * system_.weight + rise * swing * system_.push;
  }

  const System& system_;
  bool average_;
  double gamma_, beta_, time_ = 0;
  Sparse damping_;
  std::unique_ptr<const LinearSolver> solver_;
  std::unique_ptr<const Factor> factor_;
  Matrix compliance_, free_, right_;
  Vector u_, v_, a_;
};

std::unique_ptr<const ContactMethod> method(const std::string& name) {
  return make_part(method_catalog(), part(contact_methods(), name, {}));
}

void run_cones(const System& system, int steps) {
  const auto cone = make_part(cone_catalog(), part(interface_behaviours(), "coulomb", {{"friction", 0.4}}));
  March march(system, false);
  InterfaceProblem problem = march.frame(nullptr, cone.get());
  Record lagrange("lagrange"), augmented("augmented_lagrangian");
  const auto exact = method("lagrange"), other = method("augmented_lagrangian");
  double open = 0, slipping = 0;
  for (int k = 0; k < steps; ++k) {
    march.predict(problem);
    if (!lagrange.solve(*exact, problem)) break;
    if (std::getenv("UPLIFT_BENCH_LAGRANGE_ONLY") == nullptr && other != nullptr && augmented.solve(*other, problem))
      augmented.worst_difference = std::max(
          augmented.worst_difference, (augmented.solution.z - lagrange.solution.z).norm() / std::max(lagrange.solution.z.norm(), 1e-300));
    for (const Status status : lagrange.solution.status) open += status == Status::open, slipping += status == Status::slip;
    march.correct(lagrange.solution.force);
  }
  const double all = static_cast<double>(steps) * static_cast<double>(system.area.size());
  fmt::print("open {:.1f} %, slipping {:.1f} % of all points and steps\n", 100 * open / all, 100 * slipping / all);
  lagrange.print();
  if (!augmented.times.empty()) augmented.print();
}

void run_law(const System& system, int steps, const std::string& name) {
  std::unique_ptr<const InterfaceLaw> law;
  std::unique_ptr<const ContactMethod> chosen = method(name == "penalty" ? "penalty" : "newton");
  const auto cone = make_part(cone_catalog(), part(interface_behaviours(), "coulomb", {{"friction", 0.4}}));
  March march(system, true);
  InterfaceProblem problem = march.frame(nullptr, cone.get());
  if (name == "penalty") law = chosen->substitute(*cone, flexibility(*problem.model, problem.model->blocks[0]));
  if (name == "springs")
    law = make_part(law_catalog(), part(interface_behaviours(), "springs", {{"K_n", 2e9}, {"K_t", 1e9}, {"friction", 0.4}}, true));
  if (name == "sdm")
    law =
        make_part(law_catalog(), part(interface_behaviours(), "sdm",
                                      {{"K_n", 2e9}, {"F_u", 1e4}, {"G_f", 5.0}, {"F_c", -300.0}, {"K_t", 1e9}, {"friction", 0.4}}, true));
  problem = march.frame(law.get(), nullptr);
  Record record(name);
  for (int k = 0; k < steps; ++k) {
    march.predict(problem);
    if (!record.solve(*chosen, problem)) break;
    problem.old = record.solution.now;
    march.correct(record.solution.force);
  }
  record.print();
}

}  // namespace
}  // namespace uplift

int main(int argc, char** argv) {
  using namespace uplift;
  const int steps = argc > 1 ? std::atoi(argv[1]) : 400, pairs = argc > 2 ? std::atoi(argv[2]) : 20;
  std::vector<std::string> runs(argv + std::min(argc, 3), argv + argc);
  if (runs.empty()) runs = {"lagrange", "springs", "sdm", "penalty"};
  const System system = raft_on_soil(pairs);
  fmt::print("{} unknowns, {} interface rows, {} steps of {} s\n", system.free, system.b.rows(), steps, March::step);
  for (const std::string& name : runs) name == "lagrange" ? run_cones(system, steps) : run_law(system, steps, name);
}
