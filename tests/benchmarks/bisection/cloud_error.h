#pragma once

#include <span>
#include <string>

#include "host/engine/error_engine.h"
#include "host/geometry/triangle_mesh.h"

namespace emax::benchmarks {

// e_max of any tool's mesh, in the cloud's unit: what decides whether it passes.
class CloudError {
 public:
  // A fault that the tests must see.
  enum class Fault { kNone, kSkipsPoints };

  // The cloud outlives it.
  explicit CloudError(std::span<const Point> cloud, Fault fault = Fault::kNone);

  // Infinity for a mesh that has no triangles or cannot be measured.
  double operator()(const TriangleMesh& mesh);

  // Throws Error unless another library's e_max of the same mesh is this one, but for roundings.
  void confirm(const std::string& what, double measured, double other) const;

 private:
  PreparedCloud cloud_;
  ErrorEngine engine_;
};

}  // namespace emax::benchmarks
