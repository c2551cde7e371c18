#include <dlfcn.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "data_support.h"
#include "property/oracle_models.h"
#include "ran_support.h"
#include "simple_meshes.h"
#include "text_support.h"
#include "unit/elements/solid_support.h"
#include "uplift/base/file.h"
#include "uplift/dynamics/bulk.h"
#include "uplift/elements/bulk_laws/drucker_prager.h"
#include "uplift/elements/solid_nonlinear.h"
#include "uplift/mesh/cut.h"

// What a run costs in operations that can be counted: factorisations, back-solves, allocations.
namespace {

std::atomic<long> allocations{0};
std::atomic<bool> counting{false};

}  // namespace

// Every allocation of the program passes here: operator new calls malloc, and so does Eigen.
extern "C" void* malloc(std::size_t size) {
  using Malloc = void* (*)(std::size_t);
  static const Malloc next = reinterpret_cast<Malloc>(dlsym(RTLD_NEXT, "malloc"));
  if (counting.load(std::memory_order_relaxed)) allocations.fetch_add(1, std::memory_order_relaxed);
  return next(size);
}

namespace uplift::whole::counters_test {
namespace {

struct Work {
  long allocated = 0;
  RunResult result;
};

Work run_counted(const Whole& whole) {
  Work work;
  allocations = 0;
  counting = true;
  work.result = whole.run();
  counting = false;
  work.allocated = allocations;
  return work;
}

Part springs(double k) {
  return {"springs", {{"K_n", k}}};
}

Whole footing(const Part& law, const std::string& method, const std::string& impact, double damping = 0, bool slides = false) {
  Oscillator data;
  data.behaviour = law;
  data.points = 40;
  data.damping = damping;
  data.slides = slides;
  Whole whole = make(data);
  choose(whole, {method}, {impact});
  whole.plan.requests = {request(Request::Kind::displacement, 3, "top"), request(Request::Kind::moment, 0, "moment"),
                         request(Request::Kind::uplifted_ratio, 0, "lifted"), request(Request::Kind::residual, 0, "residual")};
  whole.plan.created_limit = 1e30;
  return whole;
}

/// Two interfaces of several points and six coordinates, or leaves with many: `left` and `right` are their behaviours.
Whole beam(const Part& left, const Part& right, const std::string& method, const std::string& impact) {
  Bridge data;
  data.left = left;
  data.right = right;
  data.damping = 0.02;
  Whole whole = make(data);
  choose(whole, {method}, {impact});
  whole.plan.created_limit = 1e30;
  whole.plan.rotation_limit = 1e30;
  return whole;
}
Whole leaves(const Part& behaviour, const std::string& method, const std::string& impact) {
  Leaves data;
  data.behaviour = behaviour;
  Whole whole = make(data);
  choose(whole, {method}, {impact});
  whole.plan.created_limit = 1e30;
  whole.plan.rotation_limit = 1e30;
  return whole;
}

/// 500 steps more, with the output table of the same size: what is allocated more is allocated by steps.
long allocated_by_steps(Whole& whole, const Part& rule = {"average_acceleration"}, long steps_before = 500) {
  const auto run = [&](long steps) {
    whole.plan.stages = {settle(), march(1e-3, steps, true, rule)};
    const Work work = run_counted(whole);
    if (steps < 100) return work.allocated;
    EXPECT_EQ(work.result.status, RunStatus::completed) << work.result.reason;
    EXPECT_EQ(work.result.counts.retries, 0);
    EXPECT_GT(work.result.max_uplifted_ratio.value, 0.2);
    return work.allocated;
  };
  run(10);  // what is allocated once and kept, by the libraries too
  return run(steps_before + 500) - run(steps_before);
}

TEST(Counters, CountingCounts) {
  counting = true;
  allocations = 0;
  std::vector<double>* list = new std::vector<double>(1000);
  const Vector vector = Vector::Zero(1000);
  counting = false;
  EXPECT_EQ(allocations, 3);
  EXPECT_EQ(vector.size(), static_cast<Eigen::Index>(list->size()));
  delete list;
}

TEST(Counters, NoAllocationAfterTheFirstStep) {
  const Part sdm{"sdm", {{"K_n", 2e8}, {"F_u", 0.0}, {"G_f", 1000.0}, {"F_c", -1e3}, {"tangential", "none"}}};
  const Part tough{"sdm", {{"K_n", 2e8}, {"F_u", 2e4}, {"G_f", 20.0}, {"F_c", -1e3}, {"tangential", "none"}}};
  const Part rubbing{"springs", {{"K_n", 2e8}, {"tangential", "coulomb"}, {"friction", 0.3}}};
  for (const double damping : {0.0, 0.02}) {
    for (const Part& law : {sdm, tough, springs(2e8)})
      for (const std::string rule : {"average_acceleration", "hht"}) {
        Whole whole = footing(law, "newton", "none", damping);
        EXPECT_EQ(allocated_by_steps(whole, {rule}), 0) << law.type << ", " << rule;
      }
    for (const std::string impact : {"none", "project", "project_hold", "reflect", "propagate"}) {
      Whole whole = footing({"unilateral"}, "lagrange", impact, damping);
      EXPECT_EQ(allocated_by_steps(whole), 0) << "lagrange, " << impact;
    }
    Whole penalty = footing({"unilateral"}, "penalty", "none", damping);
    EXPECT_EQ(allocated_by_steps(penalty), 0) << "penalty";
    Whole friction = footing(rubbing, "newton", "none", damping, true);
    EXPECT_EQ(allocated_by_steps(friction), 0) << "friction";
    for (const std::string impact : {"none", "project", "project_hold", "reflect", "propagate"}) {
      Whole augmented = footing({"unilateral"}, "augmented_lagrangian", impact, damping);
      EXPECT_EQ(allocated_by_steps(augmented), 0) << "augmented Lagrangian, " << impact;
    }
    for (const std::string method : {"lagrange", "augmented_lagrangian", "penalty"}) {
      Whole sliding = footing({"coulomb", {{"friction", 0.3}}}, method, "project_hold", damping, true);
      EXPECT_EQ(allocated_by_steps(sliding), 0) << "sliding, " << method;
    }
  }
}

/// Room for the records of floors is taken when a stage begins; the accelerations of the balance need none.
TEST(Counters, NoAllocationOfFloors) {
  for (const std::string rule : {"average_acceleration", "hht"}) {
    Whole whole = footing(springs(2e8), "newton", "none", 0.02);
    FloorRequest floor;
    floor.name = "floor";
    floor.node = 1;
    whole.plan.floors = {floor};
    EXPECT_EQ(allocated_by_steps(whole, {rule}), 0) << rule;
    EXPECT_GT(whole.run().floors.front().acceleration.size(), 500U);
  }
}

/// Updates of yielding solids use the room that the first one took: elastic ones, those on the cone and those at the apex.
TEST(Counters, NoAllocationOfYieldingSolids) {
  DruckerPragerParameters law;
  law.elastic = {5e7, 0.3, 1900};
  law.cohesion = 1e4;
  law.friction = 0.5;
  law.dilation = 0.1;
  for (const Cell cell : {Cell::quad4, Cell::hex8, Cell::tet10}) {
    std::vector<int> nodes;
    auto positions = std::make_shared<std::vector<Vec3>>();
    for (int a = 0; a < info(cell).nodes; ++a) nodes.push_back(a), positions->push_back(local_node(cell, a));
    const NonlinearSolid solid(cell, nodes, positions, SolidSection{}, std::make_shared<const DruckerPrager>(law));
    std::vector<double> natural(static_cast<std::size_t>(solid.num_history()), 0.0), old = natural, now = natural;
    NonlinearSolid::Scratch scratch;
    Inelastic yielded;
    Vector force, wave(solid.unknowns());
    for (Index i = 0; i < wave.size(); ++i) wave[i] = std::sin(2.0 * static_cast<double>(i + 1));
    for (std::size_t a = 0; a < positions->size(); ++a)  // sheared
      wave[solid.dimension() * static_cast<Index>(a)] += 3 * (*positions)[a].y();
    ASSERT_TRUE(solid.respond(wave * 1e-2, natural, old, scratch, &force, nullptr).converged);
    ASSERT_TRUE(solid.has_yielded(old));
    solid.find_inelastic(old, scratch, yielded);
    for (const double size : {0.0, 1e-6, 3e-3, 3e-2, -3e-2}) {
      const Vector displacement = size * wave;
      allocations = 0;
      counting = true;
      const bool good = solid.respond(displacement, old, now, scratch, &force, nullptr).converged;
      solid.find_inelastic(now, scratch, yielded);
      if (cell != Cell::tet10) solid.dissipated(wave, old, displacement, now);
      counting = false;
      EXPECT_TRUE(good);
      EXPECT_EQ(allocations, 0) << info(cell).name << ", " << size;
    }
  }
}

TEST(Counters, NoAllocationOfSeveralInterfaces) {
  const Part sdm{"sdm", {{"K_n", 3e8}, {"F_u", 2e4}, {"G_f", 20.0}, {"F_c", -1e3}, {"tangential", "open_free"}}};
  const Part elastic{"springs", {{"K_n", 3e8}, {"tangential", "none"}}};
  const Part unilateral{"unilateral"}, coulomb{"coulomb", {{"friction", 0.3}}};
  // fewer: a note about the shorter run alone
  // after 2500 steps every point has been closed: the list of active rows has its final length
  const auto allocated = [](Whole& whole) { return allocated_by_steps(whole, {"average_acceleration"}, 2500); };
  for (const std::string method : {"lagrange", "augmented_lagrangian", "penalty"}) {
    for (const Part& cone : {unilateral, coulomb}) {
      for (const Part& other : {cone, sdm, elastic}) {
        Whole whole = beam(other, cone, method, "project_hold");
        EXPECT_LE(allocated(whole), 0) << method << ", beam on " << other.type << " and " << cone.type;
      }
      Whole whole = leaves(cone, method, "project_hold");
      EXPECT_LE(allocated(whole), 0) << method << ", leaves, " << cone.type;
    }
  }
  for (const Part& law : {sdm, elastic}) {
    Whole two = beam(law, law, "newton", "none");
    EXPECT_EQ(allocated(two), 0) << "newton, beam on " << law.type;
    Whole many = leaves(law, "newton", "none");
    EXPECT_EQ(allocated(many), 0) << "newton, leaves on " << law.type;
  }
}

TEST(Counters, SmallBulkNeedsOneFactorisationAndNoBackSolve) {
  for (const double damping : {0.0, 0.02}) {
    Whole whole = footing(springs(2e8), "newton", "none", damping);
    whole.plan.stages = {march(1e-3, 2000)};
    for (const bool accelerations : {false, true}) {
      if (accelerations) whole.plan.requests.push_back(request(Request::Kind::acceleration, 3, "top"));
      const RunResult result = whole.run();
      ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
      // the matrix of the step; for accelerations the mass matrix, and the stiffness of what has no mass
      EXPECT_EQ(result.counts.factorisations, accelerations ? 3 : 1);
      EXPECT_EQ(result.counts.back_solves, 0);
    }
  }
}

// Claim: with the filters of energy decay a step in which no point changes its branch is linear and its first guess exact, so that Newton's
// method needs no more iterations than with the trapezoidal rule, in a joint that is damaged too.
TEST(Counters, FilteredStepsNeedNoMoreIterations) {
  const std::string rocking = read_file(support::source_folder() + "/bench/cases/footing_sdm.toml");
  const RunResult plain = support::run_text(rocking).result,
                  filtered = support::run_text(support::replaced(rocking, "step = 1e-3", "step = 1e-3\nscheme = \"energy_decay\"")).result;
  ASSERT_EQ(plain.status, RunStatus::completed) << plain.reason;
  ASSERT_EQ(filtered.status, RunStatus::completed) << filtered.reason;
  EXPECT_LE(filtered.counts.iterations, plain.counts.iterations);
}

/// A clamped beam of 40 elements above its footing: 120 unknowns, so that the inverse is not kept.
Whole tower(int elements, double damping) {
  Whole whole;
  ModelBuilder builder;
  const int base = builder.add_node("base", {0, 0}, here);
  builder.add_element(std::make_unique<PointMass>(base, 1e4, 7500.0), here);
  int below = base;
  for (int i = 1; i <= elements; ++i) {
    const double y0 = 10.0 * (i - 1) / elements, y1 = 10.0 * i / elements;
    const int node = builder.add_node("n" + std::to_string(i), {0, y1}, here);
    builder.add_element(std::make_unique<Beam>(below, node, Vec2{0, y0}, Vec2{0, y1}, concrete_beam()), here);
    below = node;
  }
  builder.fix(base, ux, here);
  builder.add_load("weight", {{3 * base + 1, -2e5}}, nullptr, true, here);
  builder.add_load("push", {{3 * below, 1.5e4}}, function({"harmonic", {{"frequency", 0.6}}}), false, here);
  InterfaceSpec spec;
  spec.name = "footing";
  Footing plan;
  plan.body = base;
  plan.width = 2;
  plan.points = 40;
  spec.points = footing_points(plan, here);
  behave(springs(1e8), spec, whole);
  builder.add_interface(std::move(spec), here);
  if (damping > 0) builder.set_damping(rayleigh(0.5, damping, 10, damping));
  whole.model = builder.finish();
  choose(whole, {"newton"}, {"none"});
  whole.plan.requests = {request(Request::Kind::displacement, 3 * below, "top")};
  return whole;
}

TEST(Counters, LargeBulkNeedsOneFactorisationAndTwoBackSolvesAStep) {
  for (const double damping : {0.0, 0.02}) {
    Whole whole = tower(40, damping);
    ASSERT_GT(whole.model.free(), small_bulk);
    const auto run = [&](long steps) {
      whole.plan.stages = {march(1e-3, steps)};
      const Work work = run_counted(whole);
      EXPECT_EQ(work.result.status, RunStatus::completed) << work.result.reason;
      EXPECT_EQ(work.result.counts.retries, 0);
      return work;
    };
    run(10);
    const Work first = run(1000), second = run(2000);
    EXPECT_GT(first.result.max_uplifted_ratio.value, 0.1);
    EXPECT_EQ(second.result.counts.factorisations, 1);  // the matrix of the step: nobody asks for accelerations
    EXPECT_EQ(second.result.counts.factorisations, first.result.counts.factorisations);
    EXPECT_LE(second.result.counts.back_solves - first.result.counts.back_solves, 2 * 1000);
    EXPECT_EQ(second.allocated, first.allocated);
  }
}

/// Factors of halved steps are kept: however often a step is halved, each size is factorised once.
TEST(Counters, OneFactorisationPerStepSize) {
  Oscillator data;
  data.behaviour = {"sdm", {{"K_n", 5e9}, {"F_u", 5e4}, {"G_f", 50.0}, {"F_c", -1e3}, {"tangential", "none"}}};
  Whole whole = make(data);
  choose(whole, {"newton", {{"most_iterations", 4.0}}}, {"none"});
  whole.plan.stages = {march(5e-3, 2000)};
  const RunResult result = whole.run();
  ASSERT_GT(result.counts.retries, 10);
  EXPECT_LE(result.counts.factorisations, 2 + whole.plan.stages.front().halvings + 1);
}

/// A cut makes of each cell two parts (the nodes of their pieces), a section (its corners) and the nodes of drawings: nothing else needs
/// memory of its own, neither the clipping nor the search for nodes and faces that cells share.
TEST(Counters, AllocationsOfACutCell) {
  const auto allocated = [](Cell cell, const Vec3& normal, int cells) {
    const std::vector<double> across = uniform_lines(0, cells, cells), up = uniform_lines(0, 1, 1);
    Mesh mesh = info(cell).dimension == 2 ? rectangle(across, up, cell) : box(across, across, up, cell);
    std::vector<CutPlane> planes{{{"volume"}, {normal, 0.3 * normal[info(cell).dimension - 1]}, {{{}, "above"}}}};
    const std::vector<Where> where(1);
    allocations = 0;
    counting = true;
    const std::size_t faces = cut(mesh, planes, where).front().size();
    counting = false;
    return std::pair<long, long>{allocations, static_cast<long>(faces)};
  };
  const auto a_cell = [&](Cell cell, const Vec3& normal, int cells) {
    const auto [few, of_few] = allocated(cell, normal, cells);
    const auto [many, of_many] = allocated(cell, normal, 2 * cells);
    EXPECT_GT(of_many, of_few);
    return static_cast<double>(many - few) / static_cast<double>(of_many - of_few);
  };
  // 1 for each part, 1 for the section, 1 for each place in drawings: in the plane one on either side of each cut edge, in space too, one
  // edge a cell; growing lists and cells at the boundary, of which there are fewer, add up to one more
  EXPECT_LE(a_cell(Cell::quad4, Vec3::UnitY(), 400), 2 + 1 + 2 + 0.2);
  EXPECT_LE(a_cell(Cell::hex8, Vec3::UnitZ(), 40), 2 + 1 + 2 + 1);
  EXPECT_LE(a_cell(Cell::quad4, Vec3(1e-5, 1, 0).normalized(), 400), 2 + 1 + 2 + 0.2);
  EXPECT_LE(a_cell(Cell::hex8, Vec3(1e-4, 2e-4, 1).normalized(), 40), 2 + 1 + 2 + 1);
}

}  // namespace
}  // namespace uplift::whole::counters_test
