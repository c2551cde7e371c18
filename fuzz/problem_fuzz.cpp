// Any bytes as a stored interface problem: one whose parts fit together, or an InputError. See README.md.
#include <cstddef>
#include <cstdint>
#include <string>

#include "uplift/base/error.h"
#include "uplift/contact/problem.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto require = [](bool condition) {
    if (!condition) __builtin_trap();
  };
  try {
    const uplift::StoredProblem stored = uplift::load_problem({reinterpret_cast<const char*>(data), size}, "fuzz.json");
    const uplift::InterfaceProblem& problem = stored.problem;
    int rows = 0;
    for (const uplift::Block& block : problem.model->blocks) {
      require((block.law == nullptr) != (block.cone == nullptr) && block.first == rows && block.area.size() == block.batch.points);
      rows += block.rows();
    }
    require(rows == problem.rows() && problem.model->factor.rows() == rows);
    require(problem.free_opening.size() == rows && problem.from.size() == rows);
  } catch (const uplift::InputError&) {
  }
  return 0;
}
