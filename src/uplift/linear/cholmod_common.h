#pragma once
#include <cholmod.h>

#include "uplift/linear/solver.h"
#include "uplift/linear/supernodal.h"

// What the two factorisations by CHOLMOD share.
namespace uplift {

/// CHOLMOD's settings and scratch memory: one object per thread that works. Two orders are analysed and the one with the smaller factor is
/// taken: nested dissection, the better one for soil and solids, and minimum degree, the better one for frames. The second analysis takes
/// about a tenth of the first in the plane and 0.5 to 1 of it in space.
struct Common {
  Common();
  ~Common() { cholmod_finish(&common); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
  cholmod_common common;
};

/// cholmod_analyze, one at a time in the process: METIS draws from the generator of the C library, which all threads share, and what it
/// draws decides the order of elimination and with it the round-off of every result.
cholmod_factor* analyse(cholmod_sparse& matrix, Common& settings);

/// Solution and scratch of one back-solve, kept for the next one of the same size.
struct Workspace {
  Common settings;
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;
  Vector column;  // of our own loops
  ~Workspace() {
    for (cholmod_dense** matrix : {&x, &y, &e}) cholmod_free_dense(matrix, &settings.common);
  }
};

/// A dense column as CHOLMOD sees it; only read.
cholmod_dense dense_view(const double* values, Index rows, Index columns);

/// An upper triangle as CHOLMOD sees it; only read. (A lower one would be copied twice in the factorisation.)
cholmod_sparse sparse_view(Sparse& upper);

/// The supernodes of a finished factor.
Supernodes supernodes(const cholmod_factor& factor);

/// Whether every entry of the upper triangle of a matrix has a place in a supernodal factor, so that its analysis serves the matrix too.
bool has_room(const cholmod_factor& factor, const Sparse& a);

/// What the numbers will take, after the analysis of a matrix with `entries` entries in one triangle.
FactorCost cost_of(const cholmod_factor& analysed, const cholmod_common& common, Index entries);
/// Why the numbers are not made: what they take does not fit into the memory that is left. Empty when it does, and BLAS is ready then; a
/// small factor is not asked.
std::string refusal(const FactorCost& cost);
/// Why there is no analysis.
std::string why_not_analysed(const cholmod_common& common);

/// Square roots of the pivots, in the order of the factorisation.
Vector pivots(const cholmod_factor& factor);

/// First unknown whose pivot is not positive beyond round-off; -1 when all are.
int broken_unknown(const cholmod_factor& factor, const Sparse& a);

}  // namespace uplift
