#pragma once

#include <string>

namespace emax {

// --report and --picture of a command; empty: not asked for.
struct ReportOptions {
  std::string report, picture;

  bool any() const { return !report.empty() || !picture.empty(); }
};

// Call this before long work. Throws Error as check_output() does.
void check_report_outputs(const ReportOptions& options);

}  // namespace emax
