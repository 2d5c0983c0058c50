#include "host/app/point_claims.h"

#include <mutex>

#include "host/measure/farthest_points.h"

namespace emax {

PointClaims recompute(const ScanPieces& scan, const MeasuredMesh& mesh,
                      const TriangleMesh* reference, std::span<const std::uint32_t> excluded,
                      PieceRunner& runner, const MeterFiles& files, std::uint64_t memory) {
  const auto meter = meter_of(scan, mesh, reference, {.memory = memory});
  PieceQuestion asked;
  asked.worst = true;
  asked.excluded.assign(excluded.begin(), excluded.end());
  FarthestPoints worst(0);
  std::mutex mutex;
  runner.run(scan, *meter, files, asked, nullptr, [&](const PieceFindings& found) {
    const std::lock_guard lock(mutex);
    worst.add(found.worst);
  });
  PointClaims claims;
  claims.error = meter->certified();
  claims.excluded = claims.error.excluded.size();
  claims.kernel = worst.exclude(0).kept;
  if (PiecewiseCertificate* of_reference = meter->certificate_of_reference()) {
    claims.of_reference = of_reference->finish();
  }
  return claims;
}

}  // namespace emax
