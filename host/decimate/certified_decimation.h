#pragma once

#include <functional>
#include <optional>
#include <span>

#include "host/decimate/bounded_decimation.h"
#include "host/geometry/mesh_validity.h"
#include "host/geometry/stored_mesh.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/surface_distance.h"

namespace emax {

struct CertifiedDecimationSettings {
  DecimationSettings decimation;
  Storage storage = Storage::kExact;  // what is judged is the mesh as this keeps it
};

// A decimated mesh and what is proven of it. All of it is within the bounds.
struct CertifiedDecimation {
  TriangleMesh mesh;      // as stored
  CertifiedError points;  // excluded: too far at the start and farther than epsilon in the end
  MeshValidity validity;
  std::optional<SurfaceDistance> mesh_to_reference;  // two-sided
  std::optional<SurfaceDistance> reference_to_mesh;  // likewise
  bool interrupted = false;
  int repairs = 0;  // how often a result missed a bound and was made again
};

// BoundedDecimator, judged by what shares no code with it: the certificate, the certified distances
// of surfaces in both directions and exact validity, on the mesh as stored. The decimator keeps all
// of it with every edit, so a miss is the storage format's rounding or a defect; the mesh is then
// decimated again under smaller bounds, and in the end the reference stands for itself. Pairs of
// triangles that meet are permitted up to the number that the reference has. Interrupted, it gives
// the mesh at hand, certified too.
// Throws Error as BoundedDecimator does and where the storage cannot hold the mesh within epsilon.
CertifiedDecimation decimate_certified(const TriangleMesh& reference, std::span<const Point> cloud,
                                       const CertifiedDecimationSettings& settings);

// The same by another decimator of that reference and cloud: DecimationSequence::cut.
using Decimate = std::function<DecimatedMesh(const DecimationSettings&)>;
CertifiedDecimation decimate_certified(const TriangleMesh& reference, std::span<const Point> cloud,
                                       const CertifiedDecimationSettings& settings,
                                       const Decimate& decimate);

}  // namespace emax
