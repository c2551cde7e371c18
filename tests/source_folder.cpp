#include "data_support.h"

// The only source of the tests whose compilation depends on where the repository lies, so that a compiler cache serves every clone.
namespace uplift::support {

std::string source_folder() {
  return UPLIFT_SOURCE_DIR;
}

}  // namespace uplift::support
