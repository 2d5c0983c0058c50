#pragma once

#include <span>
#include <vector>

#include "host/engine/error_engine.h"

namespace emax {

// The greatest d^2 and its point for each of several meshes. One thread prepares and searches each
// mesh, and as many meshes run at a time as the options have threads. A thread's engine keeps the
// triangles that settled points on its previous mesh. The bits are the same for any number of
// threads. Throws Error as PreparedMesh does, std::invalid_argument for no threads.
std::vector<EmaxResult> e_max_of_each(const PreparedCloud& cloud, std::span<const MeshView> meshes,
                                      const EngineOptions& options = {});

}  // namespace emax
