#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "sw_model/base/mesh_view.h"
#include "sw_model/model/normalization.h"

namespace emax::benchmarks {

// Embree's point query over a mesh, in normalised binary32 (Embree flushes subnormal numbers, and
// so do the queries here while they run). Its library walks the tree; the distance to a triangle,
// Ericson's form, is for the user to give.
class EmbreePeer {
 public:
  // Converts points and triangles to Embree's; no tree yet. `order` names every point once,
  // neighbours after each other.
  EmbreePeer(std::span<const Point> cloud, std::span<const std::uint32_t> order, MeshView mesh,
             const Normalization& normalization);
  ~EmbreePeer();

  void build();  // a scene of medium quality, compact

  enum class Mode {
    kCloudOrder,
    kNeighbours,  // points in `order`
    kHints        // and the last point's triangle as the bound to begin with
  };
  // The greatest of all points' squared distances, each exact; after build().
  float greatest_squared_distance(Mode mode);
  // The same number, but a point is left as soon as any triangle is within the greatest distance so
  // far, which exact queries of every 256th point begin: Embree's tree under our own algorithm.
  float greatest_with_early_stop();

  // Squared distances as the last greatest_squared_distance found them, in cloud order.
  std::span<const float> squared_distances() const;

  static std::string version();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace emax::benchmarks
