#pragma once
#include <memory>
#include <span>

#include "uplift/base/catalog.h"
#include "uplift/motion/motion.h"

namespace uplift {

/// One step between a record as read and the motion that drives a model. It gives back the motion with other values (and, where it says so,
/// another step or length) and one more sentence in Motion::processing, with its numbers; everything else of the motion is kept.
/// Throws InputError, with the place of the step in the case file, when the motion does not fit it (a corner beyond the Nyquist frequency,
/// a time beyond the end, a quantity that only an acceleration has).
class Processing {
 public:
  virtual ~Processing() = default;
  virtual Motion apply(Motion motion) const = 0;
};

std::span<const Entry<Processing>* const> process_catalog();
std::span<const PartInfo* const> motion_processes();

}  // namespace uplift
