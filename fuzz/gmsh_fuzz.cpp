// Any bytes as a .msh file: a mesh whose parts fit together, or an InputError. See README.md.
#include "fuzz_support.h"
#include "uplift/io/mesh/gmsh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    uplift::require_consistent(uplift::read_gmsh({reinterpret_cast<const char*>(data), size}, "fuzz.msh"));
  } catch (const uplift::InputError&) {
  }
  return 0;
}
