#pragma once
#include <cholmod.h>

#include "uplift/linear/solver.h"

// What the two factorisations by CHOLMOD share.
namespace uplift {

/// CHOLMOD's settings and scratch memory: one object per thread that works.
struct Common {
  Common() {
    cholmod_start(&common);
    common.print = 0;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_NESDIS;
    common.postorder = 1;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
  }
  ~Common() { cholmod_finish(&common); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
  cholmod_common common;
};

/// Solution and scratch of one back-solve, kept for the next one of the same size.
struct Workspace {
  Common settings;
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;
  ~Workspace() {
    for (cholmod_dense** matrix : {&x, &y, &e}) cholmod_free_dense(matrix, &settings.common);
  }
};

/// A dense column as CHOLMOD sees it; only read.
cholmod_dense dense_view(const double* values, Index rows, Index columns);

/// A lower triangle as CHOLMOD sees it; only read.
cholmod_sparse sparse_view(Sparse& lower);

/// Square roots of the pivots, in the order of the factorisation.
Vector pivots(const cholmod_factor& factor);

/// First unknown whose pivot is not positive beyond round-off; -1 when all are.
int broken_unknown(const cholmod_factor& factor, const Sparse& a);

}  // namespace uplift
