#pragma once

#include <vector>

#include "host/app/facts.h"
#include "host/decimate/plane_parts.h"
#include "host/files/mesh_file.h"
#include "host/report/result_json.h"

namespace emax {

// The planes of a scan that triangles of a result lie on, the one with most points first; then the
// cylinders and spheres, likewise.
struct ResultRegions {
  TriangleGroups groups;  // one for each region
  std::vector<ResultRegion> regions;
};

// A triangle is of a shape if its corners are within `apart` of it, and its middle within twice
// `epsilon`; of several, of the first. O(triangles * shapes).
ResultRegions regions_of(const TriangleMesh& mesh, const PlaneParts& parts, double apart,
                         double epsilon);

// What lies on a shape: `apart` of regions_of() for a mesh of that extent, which its file rounds.
double beside_shape(const TriangleMesh& extent, Storage storage, double epsilon);

// Prints how much of the result lies on shapes, and the greatest of them.
void print(Facts& facts, const ResultRegions& result, const PlaneParts& parts);

}  // namespace emax
