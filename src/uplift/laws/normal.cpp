#include "uplift/laws/normal.h"

namespace uplift {
namespace {

void keep(const double* now, int count, int i, int points, double* history) {
  if (history != nullptr)
    for (int h = 0; h < count; ++h) history[h * points + i] = now[h];
}

}  // namespace

void PointLaw::respond(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const {
  double now[most_history];
  for (int i = 0; i < batch.points; ++i) {
    const Point point = advance(batch.step, from[i], to[i], {old, batch.points, i}, now);
    response.traction[i] = point.end;
    if (response.slope != nullptr) response.slope[i] = point.end_slope;
    keep(now, num_history(), i, batch.points, response.now);
  }
}

void PointLaw::mean(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const {
  double now[most_history];
  for (int i = 0; i < batch.points; ++i) {
    const Point point = advance(batch.step, from[i], to[i], {old, batch.points, i}, now);
    response.traction[i] = point.mean;
    if (response.slope != nullptr) response.slope[i] = point.mean_slope;
    if (response.end != nullptr) response.end[i] = point.end;
    if (response.next != nullptr) response.next[i] = 0.5 * point.end_slope;
    keep(now, num_history(), i, batch.points, response.now);
  }
}

void PointLaw::energy(const Batch& batch, const double* opening, const double* history, double* stored, double* dissipated) const {
  for (int i = 0; i < batch.points; ++i) {
    const PointEnergy energy = energy_at(opening[i], {history, batch.points, i});
    if (stored != nullptr) stored[i] = energy.stored;
    if (dissipated != nullptr) dissipated[i] = energy.dissipated;
  }
}

Surface PointLaw::surface(double step, double from, double to, Memory old) const {
  double now[most_history];
  const Point point = advance(step, from, to, old, now);
  return {point.end, point.openness, point.damage};
}

}  // namespace uplift
