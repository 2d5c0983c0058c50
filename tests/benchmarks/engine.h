#pragma once

#include "host/engine/error_engine.h"

namespace emax::benchmarks {

// The engine that is measured: the one place that knows its classes.
using EngineMesh = PreparedMesh;
using Engine = ErrorEngine;

inline EngineMesh engine_mesh(MeshView mesh, const PreparedCloud& cloud,
                              const EngineTarget& target = engine_targets().front(),
                              std::size_t threads = 1) {
  return {mesh, cloud.normalization(), target, threads};
}

inline std::size_t memory_bytes(const EngineMesh& mesh) { return mesh.memory_bytes(); }

// Every point once, neighbours after each other.
inline std::vector<std::uint32_t> neighbour_order(const PreparedCloud& cloud) {
  std::vector<std::uint32_t> order;
  for (const PointGroup& group : cloud.groups()) {
    order.insert(order.end(), group.points.begin(), group.points.end());
  }
  return order;
}

}  // namespace emax::benchmarks
