#pragma once

#include <Eigen/Core>
#include <span>

#include "host/geometry/triangle_mesh.h"
#include "host/parameters/parameter.h"
#include "host/reconstruct/local_cloud.h"

namespace emax {

// Greedy projection triangulation of the points, with their normals: all points as vertices in the
// order of the cloud, and triangles as they come, turned either way. `values`: those of Gp3.
TriangleMesh greedy_projection(const LocalCloud& cloud, std::span<const Eigen::Vector3f> normals,
                               const ParameterValues& values);

}  // namespace emax
