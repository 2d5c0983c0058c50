#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/report/error_statistics.h"
#include "sw_model/surface_distance.h"

namespace emax {

// What `emax error` says of distances, beyond their certified maximum. Lengths in the cloud's unit.
struct FarPoint {
  std::uint32_t point;  // the file's index
  Point position;
  double distance;         // certified
  std::uint32_t triangle;  // the nearest
};

// From every point of the cloud to the mesh, excluded ones too.
struct CloudErrors {
  ErrorStatistics statistics;
  std::vector<FarPoint> worst;  // the farthest first
};

// From the mesh to a reference.
struct SurfaceErrors {
  std::string reference;
  bool is_cloud;               // or a surface
  std::size_t reference_size;  // points, or triangles
  SurfaceDistance distance;    // over the whole surface, certified
  ErrorStatistics statistics;  // over samples of equal area
};

struct ErrorReport {
  double width = 0;
  std::optional<double> limit;
  CloudErrors cloud;
  std::optional<SurfaceErrors> surface;
};

// Lines for a terminal.
std::string to_text(const ErrorReport& report);

}  // namespace emax
