#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "host/engine/error_engine.h"
#include "host/engine/prepared_cloud.h"
#include "host/measure/mesh_extent.h"
#include "sw_model/base/mesh_view.h"

namespace emax {

// The distance in the cloud's unit for a squared distance of the kernel.
double in_file_units(const Normalization& normalization, std::uint32_t squared_bits);

// The kernel's distance of every point to the mesh, in cloud order and the cloud's unit: the square
// roots of the values of brute force, to the bit, with any number of threads. Throws as
// PreparedMesh does, and Interrupted when `interrupted` returns true.
std::vector<double> point_distances(const PreparedCloud& cloud, MeshView mesh,
                                    const std::function<bool()>& interrupted = nullptr,
                                    std::size_t threads = 1);

// The same with a given engine and mesh. The engine must be for this cloud.
std::vector<double> point_distances(const PreparedCloud& cloud, ErrorEngine& engine,
                                    const PreparedMesh& mesh);

// The greatest difference between such a distance of at most `distance` and the true one, in the
// cloud's unit (docs/numerics.md).
double point_distance_margin(const Normalization& normalization, const MeshExtent& mesh,
                             double distance);

}  // namespace emax
