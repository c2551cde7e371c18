#pragma once
#include <memory>
#include <string_view>

#include "uplift/model/model.h"

namespace uplift {

/// Functions of time that follow the one of a time load: those of a free field, and the wave at its foot.
class WaveFunctions : public TimeFunctions {
 public:
  /// The name of that load.
  virtual std::string_view load() const = 0;
  /// What they are where that load follows another function; from rest, in equal steps [s].
  virtual std::shared_ptr<const TimeFunctions> under(std::shared_ptr<const TimeFunction> function, double step, double duration) const = 0;
};

}  // namespace uplift
