#include "uplift/io/report/report.h"

// The page of the report (web/dist/report.html, built and committed by the web part) is linked into the program as it stands: users need no
// other file. CMake defines UPLIFT_REPORT_PAGE with its path when it is there.
#ifdef UPLIFT_REPORT_PAGE
asm(".pushsection .rodata\n"
    ".globl uplift_report_page_begin\n"
    ".hidden uplift_report_page_begin\n"
    ".globl uplift_report_page_end\n"
    ".hidden uplift_report_page_end\n"
    "uplift_report_page_begin:\n"
    ".incbin \"" UPLIFT_REPORT_PAGE
    "\"\n"
    "uplift_report_page_end:\n"
    ".byte 0\n"
    ".popsection\n");

extern "C" {
extern const char uplift_report_page_begin[];
extern const char uplift_report_page_end[];
}

namespace uplift {
std::string_view report_template() {
  return {uplift_report_page_begin, static_cast<std::size_t>(uplift_report_page_end - uplift_report_page_begin)};
}
}  // namespace uplift
#else
namespace uplift {
std::string_view report_template() {
  return {};
}
}  // namespace uplift
#endif
