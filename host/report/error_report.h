#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/geometry/mesh_topology.h"
#include "host/report/error_statistics.h"
#include "sw_model/certify/surface_distance.h"

namespace emax {

// The distances that `emax error` reports beyond their certified maximum. Lengths are in the
// cloud's unit.
struct FarPoint {
  std::uint32_t point;  // the file's index
  Point position;
  double distance;         // certified
  std::uint32_t triangle;  // the nearest triangle
};

// From every point of the cloud to the mesh, including excluded points.
struct CloudErrors {
  ErrorStatistics statistics;
  std::vector<FarPoint> worst;  // the farthest first
};

// From the whole of one surface to another.
struct SurfaceErrors {
  SurfaceDistance distance;    // over the whole surface, certified
  ErrorStatistics statistics;  // over samples of equal area, or over the points of a cloud
};

// Between the mesh and a reference.
struct ReferenceErrors {
  std::string name;
  bool is_cloud;                         // or a surface
  std::size_t size;                      // points, or triangles
  std::optional<MeshTopology> topology;  // of a surface
  SurfaceErrors from_mesh;
  std::optional<SurfaceErrors> to_mesh;  // nothing if the reference is the cloud
};

struct ErrorReport {
  double width = 0;
  std::optional<double> limit;
  CloudErrors cloud;
  std::optional<ReferenceErrors> reference;
};

// Lines for a terminal.
std::string to_text(const ErrorReport& report);

}  // namespace emax
