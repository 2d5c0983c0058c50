// The error of a mesh against a cloud, measured fast with the kernel's numbers, as the hardware
// gives them.
//
//   #include <emax/measure.h>
//
//   emax::ErrorMeter meter(cloud, 4);              // 4 threads
//   const emax::Measurement error = meter.e_max(mesh);
//   std::cout << error.e_max << " at point " << error.worst_point << '\n';
//
// Links with emax::measure. These numbers are for searching, plotting and comparing; emax/certify.h
// proves a bound. Source: section 4; arithmetic: docs/numerics.md.
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
  std::uint32_t squared_bits;  // e_max^2 in normalised units, binary32: equal on every device

  bool operator==(const Measurement&) const = default;
};

// Measures meshes against one cloud. The numbers are those of brute force on the kernel, bit for
// bit, with any number of threads. They differ from the true distances by at most margin(). The
// meter remembers which triangles settled the points on one mesh, which makes a similar mesh
// faster. One caller at a time.
class EMAX_API ErrorMeter {
 public:
  // Copies the cloud: O(n log^2 n) once, about 60 bytes a point. Throws Error if the coordinates
  // are not a cloud, or for no threads.
  explicit ErrorMeter(Coordinates cloud, std::size_t threads = 1);
  ~ErrorMeter();
  ErrorMeter(ErrorMeter&&) noexcept;
  ErrorMeter& operator=(ErrorMeter&&) noexcept;

  // Each function throws Error for an argument that is not a mesh, and for vertices farther from
  // the cloud than 2^32 times its extent. O(n log triangles) in practice.

  Measurement e_max(SurfaceSpan mesh);
  // The distance that a share of the points does not exceed: nearest rank, 0 < share <= 1.
  double quantile(SurfaceSpan mesh, double share);
  // The distance of every point, in the order of the cloud.
  std::vector<double> distances(SurfaceSpan mesh);

  // The greatest difference between a distance measured here and the true one. O(vertices).
  double margin(SurfaceSpan mesh, double distance) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// e_max of several meshes against one cloud, as many at a time as there are threads. Throws Error
// as e_max() does.
EMAX_API std::vector<Measurement> e_max_of_each(Coordinates cloud,
                                                std::span<const SurfaceSpan> meshes,
                                                std::size_t threads = 1);

}  // namespace v1
}  // namespace emax
