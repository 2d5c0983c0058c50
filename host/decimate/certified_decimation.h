#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/decimate/bounded_decimation.h"
#include "host/geometry/mesh_validity.h"
#include "host/geometry/stored_mesh.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/surface_distance.h"

namespace emax {

// A decimated mesh within all bounds, with its proofs.
struct CertifiedDecimation {
  TriangleMesh mesh;      // as stored
  CertifiedError points;  // excluded: points too far both at the start and in the end
  MeshValidity validity;
  std::optional<SurfaceDistance> mesh_to_reference;  // if two-sided
  std::optional<SurfaceDistance> reference_to_mesh;  // if two-sided
  bool interrupted = false;
  int repairs = 0;  // how often a result missed a bound and was made again
};

// The points that a decimation is proven for, wherever they are, by their numbers.
class ProvenCloud {
 public:
  virtual ~ProvenCloud() = default;

  // The certificate of the points, which names them by their numbers. `excluded` ascends.
  virtual CertifiedError certify(const ExactMesh& mesh,
                                 std::span<const std::uint32_t> excluded) const = 0;
  // Of these points, which ascend, those farther than `epsilon` from the mesh; of all where none
  // are named.
  virtual std::vector<std::uint32_t> beyond(
      const ExactMesh& mesh, double epsilon,
      std::optional<std::span<const std::uint32_t>> points) const = 0;
};

// Of a cloud in memory, which must outlive this, by the indices in it.
class ProvenPoints final : public ProvenCloud {
 public:
  explicit ProvenPoints(std::span<const Point> points) : points_(points) {}

  CertifiedError certify(const ExactMesh& mesh,
                         std::span<const std::uint32_t> excluded) const override;
  std::vector<std::uint32_t> beyond(
      const ExactMesh& mesh, double epsilon,
      std::optional<std::span<const std::uint32_t>> points) const override;

 private:
  std::span<const Point> points_;
};

struct CertifiedDecimationSettings {
  DecimationSettings decimation;
  Storage storage = Storage::kExact;  // the mesh is checked as it is stored in this way
  // Called with a mesh that is certified before the work ends (DecimationSettings::early).
  std::function<void(const CertifiedDecimation&)> early = nullptr;
};

// Runs BoundedDecimator and checks its result with code that it does not share: the certificate,
// the certified distances of the surfaces in both directions and exact validity, on the mesh as
// stored. The decimator keeps all of these with every edit, so a miss is the storage format's
// rounding or a defect. The mesh is then decimated again under smaller bounds; after the last
// attempt the reference itself is the result. As many pairs of triangles may meet as in the
// reference. After an interrupt it gives the mesh reached so far, certified too. Throws Error as
// BoundedDecimator does, and where the storage cannot keep the mesh within epsilon.
CertifiedDecimation decimate_certified(const TriangleMesh& reference, std::span<const Point> cloud,
                                       const CertifiedDecimationSettings& settings);

// The same with another decimator of that reference and cloud, such as DecimationSequence::cut.
using Decimate = std::function<DecimatedMesh(const DecimationSettings&)>;
CertifiedDecimation decimate_certified(const TriangleMesh& reference, const ProvenCloud& cloud,
                                       const CertifiedDecimationSettings& settings,
                                       const Decimate& decimate);

}  // namespace emax
