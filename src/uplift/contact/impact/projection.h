#pragma once
#include "uplift/contact/impact/impact.h"

// The projection that the impact rules share. The velocity v of the displacement solve already contains the push -weight M^-1 B^T p of the
// contact force p < 0 of the step; it is taken out first, so that the whole impulse of a contact has to be compressive, not its correction
// alone:
//     w = v + weight M^-1 B_A^T p     v' = argmin |v' - w|_M^2 / 2
//     (B v' + s)_i >= 0 on normal rows of A, = 0 on sticking tangential rows
// s is the rate at which prescribed motions alone open the rows.
// Where all total impulses are compressive this is the equality projection of v (eq 4 of the paper). At the two corners of a rocking block
// it gives Housner's restitution, where the equality would stop the block dead. In the coordinates of the spread, M^-1 B^T = X C^T:
//     v' = w + X y     minimise |y|^2/2     B w + s + C y >= 0
namespace uplift {

/// Which active rows take part.
enum class Select {
  all,
  held  // those that the last projection left at rest: the rows of a second projection, of the acceleration
};

/// How the active normal rows are held.
enum class Hold {
  inequality,  // as above
  equality     // eq 4 as printed: B_A v' + s = 0, whatever the sign of the impulses; what reflections are made of
};

/// Prepares the rows of A in the scratch; false when there are none.
bool select_rows(const Impact&, Hold, ImpactScratch&);
/// Projects a rate (velocity or acceleration) of the free unknowns in the metric of M, without changing it: the correction is X (push + y).
/// `moved` is s of the same order, null: zero. scratch.rate holds B v' + s, scratch.impulse the total impulse (of an equality: the
/// correction's), scratch.target B w + s.
void project_rate(const Impact&, const Vector& rate, const Vector* moved, double weight, Select, ImpactScratch&);
/// rate += factor * X (push + y); uses up the push.
void correct(const Impact&, double factor, Vector& rate, ImpactScratch&);
/// impulse += factor * (total impulse - weight p): what the correction itself put in. Where it is empty, nothing is asked for.
void add_impulse(const Impact&, double factor, Vector& impulse, const ImpactScratch&);
/// result = B v + s, on a range of rows at least.
void row_rates(const Impact&, const Vector& v, const Vector* moved, Index first, Index count, Vector& result);

}  // namespace uplift
