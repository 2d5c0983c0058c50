#pragma once

#include <memory>
#include <string>

#include "sw_model/mesh_view.h"

namespace emax::benchmarks {

// CGAL's AABB-tree over a mesh in double, with its kd-tree of hints ("accelerated" queries).
class CgalPeer {
 public:
  // Converts points and triangles to CGAL's; no tree yet.
  CgalPeer(std::span<const Point> cloud, MeshView mesh);
  ~CgalPeer();

  void build();
  // The greatest of all points' squared distances; after build().
  double greatest_squared_distance() const;

  static std::string version();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace emax::benchmarks
