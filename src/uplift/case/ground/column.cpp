#include "uplift/case/ground/column.h"

#include <algorithm>
#include <cmath>

#include "uplift/dynamics/step.h"
#include "uplift/elements/discrete.h"
#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"

namespace uplift {
namespace {

/// One layer of the column: unknowns (horizontal, vertical) of each node.
class ColumnElement final : public Element {
 public:
  ColumnElement(std::vector<int> nodes, const ColumnLayer& layer) : nodes_(std::move(nodes)), layer_(layer) {}
  std::span<const int> nodes() const override { return nodes_; }
  int unknowns_per_node() const override { return 2; }

  void form(Local local) const override {
    const Index count = static_cast<Index>(nodes_.size()), n = 2 * count;
    for (Matrix* matrix : {local.stiffness, local.mass, local.damping})
      if (matrix) matrix->setZero(n, n);
    const ElasticMaterial& material = layer_.section.material;
    const double modulus[] = {material.shear(), material.constrained()}, half = (layer_.high - layer_.low) / 2;
    const Cell cell = layer_.quadratic ? Cell::line3 : Cell::line2;
    const CellRule rule = cell_rule(cell, 4);
    for (std::size_t p = 0; p < rule.point.size(); ++p) {
      const CellShape shape = cell_shape(cell, rule.point[p]);
      const double weight = rule.weight[p] * half;
      for (std::size_t a = 0; a < nodes_.size(); ++a)
        for (std::size_t b = 0; b < nodes_.size(); ++b)
          for (int k = 0; k < 2; ++k) {
            const Index i = 2 * static_cast<Index>(a) + k, j = 2 * static_cast<Index>(b) + k;
            if (local.stiffness) (*local.stiffness)(i, j) += weight * modulus[k] * shape.slope[a][0] * shape.slope[b][0] / (half * half);
            const double mass = weight * material.density * shape.value[a] * shape.value[b];
            if (local.mass && layer_.section.mass == SolidSection::Mass::consistent) (*local.mass)(i, j) += mass;
            if (local.mass && layer_.section.mass == SolidSection::Mass::lumped) (*local.mass)(i, i) += mass;
          }
    }
  }

 private:
  std::vector<int> nodes_;
  ColumnLayer layer_;
};

/// Horizontal and vertical along x and y.
Model column_model(const std::vector<ColumnLayer>& layers, const ColumnWave& wave, const BulkDamping& damping,
                   std::vector<double>& heights) {
  ModelBuilder builder;
  const auto add_node = [&](double height) {
    heights.push_back(height);
    return builder.add_node(std::to_string(heights.size()), Vec2(0, height), {});
  };
  int last = add_node(layers.front().low);
  const int foot = last;
  for (const ColumnLayer& layer : layers) {
    const int middle = layer.quadratic ? add_node((layer.low + layer.high) / 2) : -1, next = add_node(layer.high);
    auto element =
        std::make_unique<ColumnElement>(layer.quadratic ? std::vector<int>{last, next, middle} : std::vector<int>{last, next}, layer);
    element->beta = layer.beta;
    builder.add_element(std::move(element), {});
    last = next;
  }
  const ElasticMaterial& rock = layers.front().section.material;
  const double impedance[] = {rock.density * rock.s_wave_speed(), rock.density * rock.p_wave_speed()};
  for (int k = 0; k < 2; ++k) {
    Connection ground;
    ground.nodes = {foot};
    ground.direction = k == 0 ? Vec2(1, 0) : Vec2(0, 1);
    builder.add_element(std::make_unique<Dashpot>(ground, impedance[k]), {});
  }
  const Space plane = builder.space();
  builder.add_load("wave", {{plane.at(foot, ux), 2 * impedance[0] * wave.shear}, {plane.at(foot, uy), 2 * impedance[1] * wave.compression}},
                   wave.velocity, false, {});
  builder.set_damping(damping);
  return builder.finish();
}

}  // namespace

FreeField::FreeField(std::vector<ColumnLayer> layers, ColumnWave wave, BulkDamping damping, const std::vector<Stage>& stages,
                     std::shared_ptr<const LinearSolver> solver)
    : layers_(std::move(layers)), wave_(std::move(wave)), damping_(std::move(damping)), solver_(std::move(solver)) {
  march(stages);
}

std::shared_ptr<const TimeFunctions> FreeField::under(std::shared_ptr<const TimeFunction> velocity, double step, double duration) const {
  ColumnWave wave = wave_;
  wave.velocity = std::move(velocity);
  Stage stage;
  stage.step = step;
  stage.duration = duration;
  return std::make_shared<const FreeField>(layers_, wave, damping_, std::vector<Stage>{stage}, solver_);
}

void FreeField::march(const std::vector<Stage>& stages) {
  const Model model = column_model(layers_, wave_, damping_, heights_);
  const Bulk bulk(model, nullptr);
  const Sparse b = stack_interfaces(model);
  const Vector gap;
  const NoContact method;
  const NoImpact impact;
  const Behaviours laws(model, method, nullptr);
  LinearCounts counts;
  State state;
  state.displacement = state.velocity = state.acceleration = Vector::Zero(model.free());
  std::optional<StageHandover> handover;
  const Stage* before = nullptr;
  for (const Stage& stage : stages) {
    if (stage.type == Stage::Type::statics || !why_.empty()) continue;
    StepOptions options;
    options.scheme = stage.scheme;
    options.step = stage.step;
    options.path_average = stage.scheme.filtered();
    Stepper stepper({model, bulk, b, gap}, {laws, method}, impact, *solver_, options, counts);
    if (handover) handover->acceleration = before->scheme == stage.scheme;
    stepper.start(std::move(state), handover ? &*handover : nullptr);
    keep(model, stepper.state());
    const long steps = std::max(1L, std::lround(stage.duration / stage.step));
    for (long step = 0; step < steps && why_.empty(); ++step) {
      if (!stepper.advance()) why_ = stepper.why();
      keep(model, stepper.state());
    }
    state = stepper.whole_state();
    handover = stepper.handover();
    before = &stage;
  }
}

void FreeField::keep(const Model& model, const State& state) {
  const Vector u = model.full(state.displacement, 0, state.time), v = model.full(state.velocity, 1, state.time);
  const Index n = static_cast<Index>(heights_.size());
  const int each = model.space.unknowns();
  Vector both(4 * n);
  for (Index i = 0; i < n; ++i) {
    both.segment<2>(2 * i) = v.segment<2>(each * i);
    both.segment<2>(2 * (n + i)) = u.segment<2>(each * i);
  }
  if (!times_.empty() && state.time <= times_.back()) return;  // the end of the stage before
  times_.push_back(state.time);
  states_.push_back(std::move(both));
}

void FreeField::values(double time, Vector& values) const {
  const auto after = std::ranges::upper_bound(times_, time);
  if (after == times_.begin() || times_.size() == 1) {
    values = states_.front();
    return;
  }
  const auto i = std::min(static_cast<std::size_t>(after - times_.begin()), times_.size() - 1);
  const double step = times_[i] - times_[i - 1], share = std::min((time - times_[i - 1]) / step, 1.0);
  const Index n = 2 * static_cast<Index>(heights_.size());
  const Vector &from = states_[i - 1], &to = states_[i];
  values = from + share * (to - from);
  // u = u0 + integral of v, and the rest of u1 evenly: nothing is left with the trapezoidal rule
  values.tail(n) += (step * share * (share - 1) / 2) * (to.head(n) - from.head(n));
}

}  // namespace uplift
