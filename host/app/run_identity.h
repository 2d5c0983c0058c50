#pragma once

#include <string>

#include "host/app/commands.h"
#include "host/app/scan.h"
#include "host/optimize/optimize.h"

namespace emax {

// What the bytes of a result depend on: program, libraries and the processor's arithmetic in
// libraries, the cloud's bytes, the problem and the search. Neither jobs nor device, which change
// nothing, nor what ends a run, which another command may choose anew; of the budget, on which the
// search depends too, RunLog::give_budget() keeps count.
RunSettings run_settings(const OptimizeOptions& options, const OptimizeSettings& settings,
                         const std::string& cloud_sha256, double epsilon);

// What run_settings() leaves open until the bound has been made: reference and outliers.
inline constexpr const char* kBoundSetting = "reference.sha256";
std::string checksum(const DecimationBound& bound);

// "starts in FOLDER" or "continues in FOLDER: 37 of 150 evaluations are there".
std::string describe(const RunLog& log, std::uint64_t budget);

}  // namespace emax
