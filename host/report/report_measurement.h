#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "host/report/report_data.h"
#include "sw_model/certify/certificate.h"

namespace emax {

struct ReportWishes {
  bool page = true, picture = false;  // which pictures are drawn
  std::string unit;                   // of the cloud, for the legends; empty where it is not known
};

// Measures all that a report shows of a cloud and a mesh, the pictures included. `excluded`:
// indices of the cloud. The reach of the legend is epsilon or, without one, the greatest distance.
// The same bytes for any number of threads. At least one point is not excluded. Throws as ExactMesh
// does. About O(points log triangles).
ReportMeasurement measure_for_report(const PointCloud& cloud, MeshView mesh,
                                     const std::vector<std::uint32_t>& excluded,
                                     std::optional<double> epsilon, const ReportWishes& wishes,
                                     std::size_t threads);

}  // namespace emax
