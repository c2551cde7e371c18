#pragma once
#include "uplift/dynamics/contact_rows.h"

// Under constraints the acceleration at the beginning of a dynamic stage and the contact forces belong to each other.
namespace uplift {

/// Points whose faces part from the first instant on press no longer, whatever the stage before says.
void release_parting(const std::vector<Block>& blocks, const Sparse& b, const SupportMotion& motion, State& state);

/// Contact forces and acceleration of the state, from its acceleration without contact: those of the stage before hold another load; a
/// stage without one before it may begin on closed points, which press from the first instant on.
void hold_initial_acceleration(const std::vector<Block>& blocks, ContactRows& rows, State& state);

}  // namespace uplift
