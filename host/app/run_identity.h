#pragma once

#include <string>

#include "host/app/commands.h"
#include "host/app/scan.h"
#include "host/optimize/optimize.h"

namespace emax {

// The values that the bytes of a result depend on: the program, the libraries and the processor's
// arithmetic in them, the cloud's bytes, the problem and the search. Jobs and device are left out,
// because they change nothing. So are the limits that end a run, because another command may choose
// new ones. The search also depends on the budget, which RunLog::give_budget() records.
RunSettings run_settings(const OptimizeOptions& options, const OptimizeSettings& settings,
                         const std::string& cloud_sha256, double epsilon);

// Those of them that say which program makes the results: equal ones promise the same bytes.
RunSettings program_identity();

// The setting that run_settings() leaves open until the bound has been made: reference and
// outliers.
inline constexpr const char* kBoundSetting = "reference.sha256";
std::string checksum(const DecimationBound& bound);

// "starts in FOLDER" or "continues in FOLDER: 37 of 150 evaluations are there".
std::string describe(const RunLog& log, std::uint64_t budget);

}  // namespace emax
