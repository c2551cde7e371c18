// Any bytes as a case in JSON: a tree of values, or an InputError. See README.md.
#include <cstddef>
#include <cstdint>

#include "uplift/base/error.h"
#include "uplift/io/text/json_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    uplift::read_json_text({reinterpret_cast<const char*>(data), size}, "fuzz.json");
  } catch (const uplift::InputError&) {
  }
  return 0;
}
