#pragma once

#include <filesystem>
#include <string>

#include "benchmark_problems.h"

namespace emax::benchmark {

// A search as `emax optimize` makes it, as one of the test functions: `name` is a scan ("bunny" or
// "building"), epsilon in percent of the width, and a decimator: "bunny 0.321 schroeder". Greedy
// projection; one-sided for Schroeder's decimation, two-sided for the bounded one; of the building
// 0.5 % of the points may be excluded. Evaluations run in one worker, whose program lies beside the
// running one; optimum is 0. Throws Error for another name and when a scan is missing in `data`.
BenchmarkProblem real_problem(const std::string& name, const std::filesystem::path& data);

}  // namespace emax::benchmark
