#pragma once
#include <cstddef>

// What Newton's method asks of a step, in one pass over the points of an interface that only opens and closes: openings from the
// coordinates z, path-averaged forces and slopes of the law, and their sums C^T p and C^T k C. A law offers it for the points whose memory
// stays (NormalLaw::fused); everything else goes through `mean`, in passes one after another.
namespace uplift {

/// The arrays of one interface with one component, n numbers each, and what is asked for. With t the path-averaged traction and k its
/// slope,
///     opening = free + C z      force = scale area t      slope = scale area k
/// Units as in InterfaceProblem: openings m, forces N, tractions Pa, z sqrt(J), C m/sqrt(J), areas m2.
struct FusedEvaluation {
  std::ptrdiff_t points = 0;
  std::ptrdiff_t columns = 0;  // R, number of coordinates: 1 to 3
  // given
  const double *z = nullptr, *factor = nullptr;  // R; C, column-major
  std::ptrdiff_t stride = 0;                     // between the columns of C
  const double *free = nullptr, *from = nullptr, *old = nullptr, *area = nullptr;
  double scale = 1;
  const double *coefficient = nullptr, *lag = nullptr;  // joint filter (laws/filter.h); null: none
  // made
  double *opening = nullptr, *force = nullptr, *slope = nullptr, *now = nullptr;
  double *end = nullptr, *next = nullptr;        // as in LawResponse [Pa], [Pa/m]
  double *pull = nullptr, *stiffness = nullptr;  // C^T force [sqrt(J)] (R); C^T slope C (R x R)
  double* end_pull = nullptr;                    // C^T (scale area end) [sqrt(J)] (R)
  double* plain = nullptr;                       // with a joint filter: path average of the law alone [Pa]
  double* stored = nullptr;                      // energy of the law at the end [J]
};

}  // namespace uplift
