#pragma once

#include <span>
#include <vector>

#include "host/engine/error_engine.h"

namespace emax {

// The greatest d^2 and its point for each of several meshes. Each is prepared and searched by one
// thread, as many at a time as the options have threads: nothing waits within a mesh, and a thread
// begins with what settled the points on its mesh before. The same bits for any number of threads.
// Throws Error as PreparedMesh does, std::invalid_argument for no threads.
std::vector<EmaxResult> e_max_of_each(const PreparedCloud& cloud, std::span<const MeshView> meshes,
                                      const EngineOptions& options = {});

}  // namespace emax
