#include <cstddef>

#include "host/report/report_page.h"

// The bytes of the file EMAX_REPORT_TEMPLATE, as the assembler reads them.
asm(".pushsection .rodata\n"
    ".hidden emax_report_template_begin\n.hidden emax_report_template_end\n"
    ".globl emax_report_template_begin\n.globl emax_report_template_end\n"
    "emax_report_template_begin:\n.incbin \"" EMAX_REPORT_TEMPLATE
    "\"\n"
    "emax_report_template_end:\n"
    ".popsection\n");

extern "C" {
[[gnu::visibility("hidden")]] extern const char emax_report_template_begin[];
[[gnu::visibility("hidden")]] extern const char emax_report_template_end[];
}

namespace emax {

std::string_view report_template() {
  return {emax_report_template_begin,
          static_cast<std::size_t>(emax_report_template_end - emax_report_template_begin)};
}

}  // namespace emax
