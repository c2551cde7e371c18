#pragma once
#include <string>
#include <utility>

#include "uplift/base/error.h"
#include "uplift/motion/processing/processing.h"

namespace uplift {

/// What the processing steps share: they know where they stand in the case file, for errors that only the motion brings to light.
class ProcessStep : public Processing {
 protected:
  explicit ProcessStep(const Values& values) : where_(values.where()), path_(values.path()) {}

  [[noreturn]] void refuse(const std::string& key, const std::string& wanted, const std::string& found) const {
    throw InputError(where_, key.empty() || path_.empty() ? path_ + key : path_ + "." + key, wanted, found);
  }
  /// Refuses velocities and displacements.
  void need_acceleration(const Motion& motion) const {
    if (motion.kind != MotionKind::acceleration) refuse("", "a motion given as acceleration", std::string(to_string(motion.kind)));
  }

 private:
  Where where_;
  std::string path_;
};

}  // namespace uplift
