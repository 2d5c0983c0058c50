#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "host/geometry/scan_estimate.h"
#include "host/geometry/triangle_mesh.h"
#include "host/parameters/parameter.h"
#include "host/tiles/cloud_partition.h"
#include "host/tiles/part_plan.h"

namespace emax {

// Medians of the estimates of at most eight parts, evenly spread over their order, once they are
// thinned() with this side. Zeros where they are smaller than three points.
ScanEstimate estimate_scan(const CloudPartition& cloud, double thin = 0);

// Normalised lengths; 0: none.
struct Coarseness {
  double thin = 0;      // the side of thinned()
  double simplify = 0;  // the deviation of collapse_by_quadrics(), in each part
};

struct TiledReconstruction {
  TriangleMesh mesh;
  double spacing = 0;        // the median of the points' own, in the cloud's unit
  std::uint64_t points = 0;  // that it was made of
};

// The surface of a cloud in parts by implicit moving least squares (Imls), with the memory of the
// result and what `run` takes for each part. Files of the parts are put into the folder of the
// cloud's; steps whose files are there are not repeated.
//
// 1. Every part, with a halo of some tens of spacings, is looked at as a cloud of its own.
// 2. The signs of the normals of neighbouring parts are compared at the points that both know
//    (consistent_signs()).
// 3. Every part is contoured in its cubes of one lattice, with all points that have a say there. So
//    vertices at seams have the same bits on both sides, and are joined.
//
// So the surface is that of the whole cloud, triangle by triangle, where the neighbourhoods of
// points are narrower than the halo and no two points compete for a place in them by equal
// distances. The bytes depend on the cloud, the parts and the values. About 300 bytes a point in
// files, O(n log n) time. Simplified, it is so within each part but for the vertices at seams,
// which stay. `advanced`: called with the share of the work that is done.
TiledReconstruction reconstruct_in_tiles(const CloudPartition& cloud, const ParameterValues& values,
                                         const ScanEstimate& estimate, const Coarseness& coarseness,
                                         const RunParts& run,
                                         const std::function<void(double)>& advanced = nullptr);

}  // namespace emax
