// The error of a mesh against a cloud, fast: the kernel's numbers, as the hardware gives them.
//
//   #include <emax/measure.h>
//
//   emax::ErrorMeter meter(cloud, 4);              // 4 threads
//   const emax::Measurement error = meter.e_max(mesh);
//   std::cout << error.e_max << " at point " << error.worst_point << '\n';
//
// Links with emax::measure. What is promised to somebody else is proven by emax/certify.h; this is
// for searching, plotting and comparing. Source: section 4; arithmetic: docs/numerics.md.
#pragma once

#include <emax/error.h>
#include <emax/surface.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace emax {
inline namespace v1 {

struct Measurement {
  double e_max;                // the greatest distance from a point of the cloud to the mesh
  std::size_t worst_point;     // the lowest index of a point that has it
  std::uint32_t squared_bits;  // its square in normalised units, binary32: equal on every device

  bool operator==(const Measurement&) const = default;
};

// Measures meshes against one cloud. The numbers are those of brute force on the kernel, bit for
// bit, with any number of threads, and differ from the true ones by at most margin(). What settled
// the points on one mesh is remembered and makes a like mesh faster. One caller at a time.
class EMAX_API ErrorMeter {
 public:
  // Copies the cloud: O(n log^2 n) once, about 60 bytes a point. Throws Error where the coordinates
  // are no cloud and for no threads.
  explicit ErrorMeter(Coordinates cloud, std::size_t threads = 1);
  ~ErrorMeter();
  ErrorMeter(ErrorMeter&&) noexcept;
  ErrorMeter& operator=(ErrorMeter&&) noexcept;

  // Each throws Error for an argument that is no mesh, and for vertices farther from the cloud than
  // 2^32 times its extent. O(n log triangles) in practice.

  Measurement e_max(SurfaceSpan mesh);
  // The distance that a share of the points is within: nearest rank, 0 < share <= 1.
  double quantile(SurfaceSpan mesh, double share);
  // Of every point, in the order of the cloud.
  std::vector<double> distances(SurfaceSpan mesh);

  // The greatest difference between a distance given here and the true one. O(vertices).
  double margin(SurfaceSpan mesh, double distance) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// e_max of several meshes against one cloud, as many at a time as there are threads. Throws Error
// likewise.
EMAX_API std::vector<Measurement> e_max_of_each(Coordinates cloud,
                                                std::span<const SurfaceSpan> meshes,
                                                std::size_t threads = 1);

}  // namespace v1
}  // namespace emax
