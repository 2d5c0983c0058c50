#include <cstddef>

#include "host/report/report_page.h"

// The bytes of the file EMAX_REPORT_TEMPLATE, as the assembler reads them.
asm(".pushsection .rodata\n"
    ".hidden kReportTemplateBegin\n.hidden kReportTemplateEnd\n"
    ".globl kReportTemplateBegin\n.globl kReportTemplateEnd\n"
    "kReportTemplateBegin:\n.incbin \"" EMAX_REPORT_TEMPLATE
    "\"\n"
    "kReportTemplateEnd:\n"
    ".popsection\n");

extern "C" {
[[gnu::visibility("hidden")]] extern const char kReportTemplateBegin[];
[[gnu::visibility("hidden")]] extern const char kReportTemplateEnd[];
}

namespace emax {

std::string_view report_template() {
  return {kReportTemplateBegin,
          static_cast<std::size_t>(kReportTemplateEnd - kReportTemplateBegin)};
}

}  // namespace emax
