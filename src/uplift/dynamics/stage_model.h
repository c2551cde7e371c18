#pragma once
#include "uplift/dynamics/condensed.h"

namespace uplift {

/// What a stage moves. All must stay alive.
struct StageModel {  // of values that stay alive: no temporaries
  const Model& model;
  const Bulk& bulk;
  const Sparse& b;    // of all interfaces: rows x free
  const Vector& gap;  // rows: initial gaps, without those of prescribed motions [m]
};

/// How its interfaces behave, and by which method they are solved.
struct ContactChoice {
  const Behaviours& laws;
  const ContactMethod& method;
};

}  // namespace uplift
