#include "host/app/point_claims.h"

#include <mutex>

#include "host/measure/farthest_points.h"
#include "host/measure/piece_measurement.h"
#include "sw_model/base/parallel.h"

namespace emax {

PointClaims recompute(const ScanPieces& scan, const TriangleMesh& mesh,
                      const TriangleMesh* reference, std::span<const std::uint32_t> excluded) {
  const ExactMesh exact(mesh.view());
  PiecewiseCertificate certificate(exact);
  std::optional<ExactMesh> exact_reference;
  std::optional<PiecewiseCertificate> of_reference;
  if (reference != nullptr) of_reference.emplace(exact_reference.emplace(reference->view()));
  const PieceMeasurement kernel(mesh.view(), scan.normalization(), false, processor_threads());
  FarthestPoints worst(0);
  PointClaims claims;
  std::mutex mutex;
  scan.for_each(processor_threads(), [&](const ScanPieces::Piece& piece) {
    const std::vector<std::uint32_t> of_piece = piece.indices_of(excluded);
    certificate.add(piece.points, piece.numbers, of_piece);
    if (of_reference) of_reference->add(piece.points, piece.numbers, of_piece);
    std::vector<std::uint32_t> bits = kernel.squared_distances(piece.points);
    for (const std::uint32_t i : of_piece) bits[i] = 0;
    const std::lock_guard lock(mutex);
    worst.add(bits, piece.numbers);
    claims.excluded += of_piece.size();
  });
  claims.error = certificate.finish();
  claims.kernel = worst.exclude(0).kept;
  if (of_reference) claims.of_reference = of_reference->finish();
  return claims;
}

}  // namespace emax
