#include "uplift/case/schema/sections.h"
#include "uplift/cli/commands.h"
#include "uplift/cli/console.h"

namespace uplift::cli {

int schema() {
  say(to_json_schema(case_section()));
  return Exit::done;
}

}  // namespace uplift::cli
