// The interface problem alone: a rigid footing on three points is pushed into the ground on one side. Every method solves
//     opening = free opening - C C^T p        opening >= 0, p <= 0, p opening = 0
// and says how well; the closed form is beside it.
#include <cstdio>
#include <uplift.hpp>

namespace {

// Two motions of the footing, with a compliance of 1e-9 m/N upwards and 4e-10 m/N of the edges by rotation: C has a row for each point,
// sqrt(1e-9) and the arm of the rotation, -1, 0 or 1, times sqrt(4e-10).
const char* const problem = R"({
  "format": "uplift interface problem 1",
  "factor": [[3.1622776601683795e-5, -2e-5], [3.1622776601683795e-5, 0], [3.1622776601683795e-5, 2e-5]],
  "free_opening": [-1e-3, 0.5e-3, 2e-3],
  "blocks": [{"name": "underside", "points": 3, "components": 1, "area": [1, 1, 1], "behaviour": {"type": "unilateral"}}]
})";

}  // namespace

int main() {
  std::puts(uplift::solve_problem(problem).c_str());
  // only the first point stays closed: p_1 = free opening / F_11 with F_11 = 1e-9 + 4e-10
  const double force = -1e-3 / 1.4e-9;
  std::printf("closed form: force %.6g N, openings 0, %.6g, %.6g m\n", force, 0.5e-3 - 1e-9 * force, 2e-3 - (1e-9 - 4e-10) * force);
}
