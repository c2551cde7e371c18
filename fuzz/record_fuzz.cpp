// Any bytes as a record of ground motion: motions with a step > 0 and finite values, or an InputError. See README.md.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "uplift/base/error.h"
#include "uplift/motion/formats/read.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // without options, and with those that a bare column of numbers needs
  for (const uplift::RecordOptions& options : {uplift::RecordOptions{}, uplift::RecordOptions{.unit = "g", .step = 0.01}}) {
    try {
      for (const uplift::Motion& motion : uplift::read_motions_from({reinterpret_cast<const char*>(data), size}, "fuzz.txt", options)) {
        if (!(motion.step > 0) || !std::isfinite(motion.step) || motion.values.size() < 2) __builtin_trap();
        for (const double value : motion.values)
          if (!std::isfinite(value)) __builtin_trap();
      }
    } catch (const uplift::InputError&) {
    }
  }
  return 0;
}
