#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tests/benchmarks/bisection/cloud_error.h"
#include "tests/benchmarks/decimation/scans.h"

namespace emax::benchmarks {

// What is told of a result: triangles, both distances in percent of the width, validity, the
// distance to the true surface where it is known, and of a sharp scan the greatest distance from
// its sharp edges to those of the result. Throws Error when CGAL's e_max is not the
// engine's.
nlohmann::json measures(const std::string& what, const DecimationScan& scan, CloudError& error,
                        const TriangleMesh& mesh);

}  // namespace emax::benchmarks
