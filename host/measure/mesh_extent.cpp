#include "host/measure/mesh_extent.h"

#include <algorithm>

namespace emax {

MeshExtent::MeshExtent(MeshView mesh, const Normalization& normalization) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto corners = mesh.corners(i);
    for (std::size_t k = 0; k < 3; ++k) {
      lower = lower.cwiseMin(corners[k]);
      upper = upper.cwiseMax(corners[k]);
      longest_edge = std::max(longest_edge, (corners[(k + 1) % 3] - corners[k]).norm());
      farthest = std::max(farthest, (corners[k] - normalization.origin).norm());
    }
  }
}

void MeshExtent::join(const MeshExtent& other) {
  lower = lower.cwiseMin(other.lower);
  upper = upper.cwiseMax(other.upper);
  longest_edge = std::max(longest_edge, other.longest_edge);
  farthest = std::max(farthest, other.farthest);
}

}  // namespace emax
