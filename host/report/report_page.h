#pragma once

#include <string>
#include <string_view>

#include "host/report/report_data.h"

namespace emax {

// The page of `--report`: one HTML file that needs no other. It is the template of
// host/report/page/ with the report in the place of this comment: JSON, geometry and picture.
inline constexpr std::string_view kReportMarker = "<!--emax:report-->";

// The template that is built into the program.
std::string_view report_template();

// No text of the report ends its element: names of files may hold anything. Throws std::logic_error
// where the template does not hold the marker exactly once.
std::string report_page(const ReportData& report,
                        std::string_view page_template = report_template());

}  // namespace emax
