#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "host/app/measured_mesh.h"
#include "host/app/scan_pieces.h"
#include "host/engine/error_engine.h"
#include "host/measure/mesh_extent.h"
#include "host/report/point_store.h"

namespace emax {

// What a point's distances are from the parts of a mesh so far.
struct LeastDistance {
  double upper = std::numeric_limits<double>::infinity();  // end of the exact distance
  std::uint32_t squared_bits = kNothingMet;                // of the kernel
  std::uint32_t triangle = 0;                              // the first that has `upper`
};

struct PartwiseOptions {
  bool brute_force = false;
  std::uint64_t memory = 0;  // bytes for the distances of the points; more go into a file
  std::function<bool()> interrupted = nullptr;
  std::function<void(double)> advance = nullptr;  // told the share that is measured
};

// The distances of a scan's points from a mesh in parts: part by part the points are measured by
// the kernel and by the oracle, and the least are kept. They have the bits of the whole mesh,
// because both are minima over its triangles. 16 bytes a point.
class PartwiseDistances {
 public:
  // Reads the mesh twice, and the points once for each part and once more. The scan and the mesh
  // must outlive this. Throws Error as these do, and Interrupted.
  PartwiseDistances(const ScanPieces& scan, const MeasuredMesh& mesh,
                    const PartwiseOptions& options);

  std::vector<LeastDistance> of(const ScanPieces::Piece& piece) const;
  LeastDistance of(std::uint64_t index) const;
  // The lower end of a point's distance, whose upper end is known. Reads the mesh again.
  double lower_end(const Point& p, double upper) const;

  const ScanPieces& scan() const { return scan_; }
  const MeshExtent& extent() const { return extent_; }
  std::uint64_t triangles() const { return triangles_; }
  double kernel_seconds() const { return kernel_seconds_; }  // on all threads

 private:
  class Part;
  // What the points have from some triangles bounds what they have from all.
  void bound(const MeshPart& sample, const PartwiseOptions& options);
  void measure(const MeshPart& part, const PartwiseOptions& options);

  const ScanPieces& scan_;
  const MeasuredMesh& mesh_;
  PointStore<LeastDistance> store_;
  MeshExtent extent_;
  std::uint64_t triangles_ = 0;
  bool is_begun_ = false;  // something is stored
  double kernel_seconds_ = 0;
};

}  // namespace emax
