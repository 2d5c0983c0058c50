#pragma once

#include <vector>

#include "host/app/facts.h"
#include "host/decimate/plane_parts.h"
#include "host/files/mesh_file.h"
#include "host/report/result_json.h"

namespace emax {

// The planes of a scan that triangles of a result lie on, the one with most points first.
struct ResultRegions {
  TriangleGroups groups;  // one for each region
  std::vector<ResultRegion> regions;
};

// A triangle is of a plane if its corners are within `apart` of it; of several, of the first.
// O(triangles * planes).
ResultRegions regions_of(const TriangleMesh& mesh, const PlaneParts& parts, double apart);

// What lies on a plane: `apart` of regions_of() for a mesh of that extent, which its file rounds.
double beside_plane(const TriangleMesh& extent, Storage storage, double epsilon);

// Prints how much of the result lies on planes, and the greatest of them.
void print(Facts& facts, const ResultRegions& result, const PlaneParts& parts);

}  // namespace emax
