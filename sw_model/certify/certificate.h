#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "sw_model/base/mesh_view.h"
#include "sw_model/base/point_numbers.h"
#include "sw_model/certify/exact_distance.h"

namespace emax {

// What is proven of a mesh: every kept point of the cloud lies within `e_max_upper` of it. In the
// coordinates and the unit of the input, rounded outward (docs/numerics.md).
struct CertifiedError {
  double e_max_upper = 0;
  double e_max_lower = 0;       // e_max is at least this; the two differ by rounding alone
  std::size_t worst_point = 0;  // lowest index of a kept point that attains e_max_upper
  std::size_t points = 0;       // number of kept points

  std::vector<std::uint32_t> excluded;     // as given
  std::vector<double> excluded_distances;  // rounded outward, in the order of `excluded`
  double e_max_upper_all = 0;              // over the kept and the excluded

  bool within(double epsilon) const { return e_max_upper <= epsilon; }
};

// The greatest distance from a point of the cloud to the mesh, by the oracle of exact_distance.h:
// this number alone permits writing a result. The same to the bit for any number of threads.
//
// Points are taken along a space-filling curve, so that a triangle near one of them is often near
// enough to the next to show that it cannot be the worst.
//
// Throws Error naming the point that is not finite or beyond 1e150, or where nothing is left to
// certify, and as ExactMesh does; std::invalid_argument for an excluded index that does not exist
// or comes twice; std::logic_error while flush mode is on. About O(points log triangles).
CertifiedError certify(std::span<const Point> cloud, const ExactMesh& mesh,
                       std::span<const std::uint32_t> excluded = {}, std::size_t threads = 1);
CertifiedError certify(std::span<const Point> cloud, MeshView mesh,
                       std::span<const std::uint32_t> excluded = {}, std::size_t threads = 1);

// What pieces of a cloud add to its certificate.
struct CertificatePart {
  double upper = -1;  // the greatest distance of a kept point; -1: there is none
  std::uint64_t worst_point = 0;
  Point at = Point::Zero();                                // of the worst point
  std::uint64_t points = 0;                                // kept
  std::vector<std::pair<std::uint32_t, double>> excluded;  // number and distance of each
};

// The same of a cloud that comes in pieces, in any order: certify() is one piece.
class PiecewiseCertificate {
 public:
  PiecewiseCertificate();  // of points whose distances are known
  // The mesh must outlive the certificate.
  explicit PiecewiseCertificate(const ExactMesh& mesh);
  ~PiecewiseCertificate();
  PiecewiseCertificate(const PiecewiseCertificate&) = delete;
  PiecewiseCertificate& operator=(const PiecewiseCertificate&) = delete;

  // `excluded`: those of the points that do not count, by their indices in the piece. Several
  // threads may add pieces at a time. Throws as certify(), which names points by their numbers.
  void add(std::span<const Point> piece, const PointNumbers& numbers,
           std::span<const std::uint32_t> excluded = {}, std::size_t threads = 1);
  // The same of points of which these are the upper ends of the distances, one for each.
  void add_known(std::span<const Point> piece, const PointNumbers& numbers,
                 std::span<const double> uppers, std::span<const std::uint32_t> excluded = {});
  // What the pieces so far add, and the same of pieces that were added to another certificate of
  // this mesh, in another process perhaps.
  CertificatePart part() const;
  void add(const CertificatePart& part);
  // Once all pieces are there. Points are given by their numbers, the excluded ascending. Throws
  // Error where nothing is left to certify.
  CertifiedError finish();
  // The same where the distances are known: `lower_end` gives that of the worst point, which is
  // given with its upper end.
  CertifiedError finish(const std::function<double(const Point&, double)>& lower_end);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace emax
