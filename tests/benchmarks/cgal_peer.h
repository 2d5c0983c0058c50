#pragma once

#include <memory>
#include <string>

#include "sw_model/base/mesh_view.h"

namespace emax::benchmarks {

// CGAL's AABB-tree over a mesh in double.
class CgalPeer {
 public:
  enum class Mode {
    kKdTree,  // its kd-tree of hints ("accelerated distance queries")
    kHints    // the last point's nearest point as the hint instead
  };

  // Converts points and triangles to CGAL's; no tree yet. `order` names every point once,
  // neighbours after each other, as the queries take them.
  CgalPeer(std::span<const Point> cloud, std::span<const std::uint32_t> order, MeshView mesh);
  ~CgalPeer();

  void build(Mode mode);
  // The greatest of all points' squared distances; after build() in either mode.
  double greatest_squared_distance() const;

  static std::string version();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace emax::benchmarks
