#pragma once
#include "uplift/dynamics/condensed.h"

namespace uplift {

/// What a stage moves. It refers to values that must stay alive: no temporaries.
struct StageModel {
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
