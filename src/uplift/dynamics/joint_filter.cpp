#include "uplift/dynamics/joint_filter.h"

#include "uplift/math/lanes.h"

namespace uplift {

JointFilter::JointFilter(const Model& model, const Behaviours& behaviours, const Scheme& scheme)
    : blocks_(blocks_of(model, behaviours).blocks), pole_(scheme.pole), gain_(scheme.gain) {
  Eigen::Index rows = 0;
  int slopes = 0;
  for (const Block& block : blocks_) {
    Part part{.first = block.first,
              .first_slope = slopes,
              .points = block.batch.points,
              .components = block.batch.components,
              .area = block.area,
              .inverse_area = {}};
    part.inverse_area = part.area.cwiseInverse();
    if (block.law != nullptr) block.law->closed_stiffness(part.components, part.stiffness);
    rows += block.rows();
    slopes += block.slopes();
    parts_.push_back(std::move(part));
  }
  input_.gain = gain_;
  input_.coefficient.setZero(rows);
  input_.lag.setZero(rows);
}

void JointFilter::look(const State& now, Vector& tangent) const {
  tangent.setZero(now.opening.size());
  for (const Block& block : blocks_) {
    if (block.law == nullptr) continue;
    const int n = block.batch.points, components = block.batch.components;
    Vector traction(block.rows()), end(block.rows()), slope(block.rows() * components), next(block.rows() * components),
        memory(block.law->num_history(components) * n);
    const double* at = now.opening.data() + block.first;
    next.setZero();
    block.law->mean(block.batch, at, at, now.history.data() + block.first_history,
                    {.traction = traction.data(), .slope = slope.data(), .now = memory.data(), .end = end.data(), .next = next.data()});
    for (int c = 0; c < components; ++c) tangent.segment(block.first + c * n, n) = 2 * next.segment((c * components + c) * n, n);
  }
}

const JointFilterInput& JointFilter::begin(const State& now, double shrink) {
  const FilterMemory& memory = now.filter;
  for (const Part& part : parts_) {
    const int normal = part.first + (part.components - 1) * part.points;
    const double* contact = memory.tangent.data() + normal;
    for (int c = part.components - 1; c >= 0; --c) {
      const int first = part.first + c * part.points;
      const bool is_normal = first == normal;
      const double *tangent = memory.tangent.data() + first, *filtered = memory.opening.data() + first,
                   *before = memory.coefficient.data() + first;
      double *coefficient = input_.coefficient.data() + first, *lag = input_.lag.data() + first;
      const double gain = gain_, closed = 0.5 * part.stiffness[part.components - 1], stuck = 0.5 * part.stiffness[c];
      for_lanes(part.points, [&](const auto& at) {
        const Lanes zero = 0, slope = at(tangent);
        const LaneMask touches = at(contact) >= closed;
        const Lanes here = is_normal ? choose(touches, gain * slope, Lanes(-1))
                                     : choose(touches || (slope >= stuck && slope > zero), Lanes(2 * gain * stuck), zero);
        const LaneMask acts = here > zero, grows = acts && at(before) < here;
        Lanes remembered = shrink * at(filtered);
        if (any_of(grows)) remembered *= std::experimental::sqrt(choose(grows, at(before) / choose(grows, here, Lanes(1)), Lanes(1)));
        at.put(coefficient, here);
        at.put(lag, choose(acts, remembered, zero));
      });
    }
  }
  return input_;
}

void JointFilter::end(const InterfaceProblem& problem, const InterfaceSolution& solution, const State& now, State& next) {
  const double loss = 0.5 * (1 + pole_), store = 0.5 / (1 - pole_), pole = pole_, keep = 1 - pole_;
  Lanes dissipated = 0, storage = 0;
  for (const Part& part : parts_) {
    const double *area = part.area.data(), *inverse_area = part.inverse_area.data();
    for (int c = 0; c < part.components; ++c) {
      const int n = part.points, first = part.first + c * n;
      const double *coefficient = input_.coefficient.data() + first, *lag = input_.lag.data() + first,
                   *plain = solution.plain.data() + first, *force = solution.force.data() + first, *to = solution.opening.data() + first,
                   *from = now.opening.data() + first, *before = now.filter.coefficient.data() + first,
                   *filtered = now.filter.opening.data() + first,
                   *slope = solution.next_slope.data() + part.first_slope + (c * part.components + c) * n;
      double *coefficient_next = next.filter.coefficient.data() + first, *filtered_next = next.filter.opening.data() + first,
             *tangent = next.filter.tangent.data() + first;
      const double scale = 1 / problem.model->scale;
      for_lanes(n, [&](const auto& at) {
        const Lanes zero = 0, one = 1, increment = at(to) - at(from), ahead = increment - at(lag), weight = at(area, 1.0),
                    here = at(coefficient);
        const Lanes added = scale * at(force) * at(inverse_area) - at(plain), wanted = here * ahead;
        const LaneMask acts = here > zero, less = acts && added * wanted < (1 - 1e-6) * wanted * wanted;
        Lanes kept = choose(acts, here, zero);  // theta c
        if (any_of(less)) kept *= choose(less, larger(added / choose(less, wanted, one), zero), one);
        const Lanes stored_before = at(before) * at(filtered) * at(filtered), stored_used = kept * at(lag) * at(lag);
        dissipated +=
            weight * (loss * kept * ahead * ahead + store * (stored_before - stored_used) + choose(acts, zero, added * increment));
        const Lanes filtered_now = choose(acts, pole * at(lag) + keep * increment, zero);
        storage += weight * store * kept * filtered_now * filtered_now;
        at.put(coefficient_next, kept);
        at.put(filtered_next, filtered_now);
        at.put(tangent, 2 * at(slope));
      });
    }
  }
  dissipated_ = sum(dissipated), storage_ = sum(storage);
}

}  // namespace uplift
