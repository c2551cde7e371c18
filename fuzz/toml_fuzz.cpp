// Any bytes as a case file: a tree of values, or an InputError. See README.md.
#include <cstddef>
#include <cstdint>

#include "uplift/base/error.h"
#include "uplift/io/text/toml.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    uplift::read_toml_text({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
  } catch (const uplift::InputError&) {
  }
  return 0;
}
