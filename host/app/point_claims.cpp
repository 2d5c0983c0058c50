#include "host/app/point_claims.h"

#include <mutex>

#include "host/measure/farthest_points.h"
#include "sw_model/base/parallel.h"

namespace emax {

PointClaims recompute(const ScanPieces& scan, const TriangleMesh& mesh,
                      const TriangleMesh* reference, std::span<const std::uint32_t> excluded,
                      PieceRunner& runner, const MeterFiles& files) {
  PieceMeter meter(mesh, reference, scan.normalization(), false, processor_threads());
  PieceQuestion asked;
  asked.worst = true;
  asked.excluded.assign(excluded.begin(), excluded.end());
  FarthestPoints worst(0);
  std::mutex mutex;
  runner.run(scan, meter, files, asked, nullptr, [&](const PieceFindings& found) {
    const std::lock_guard lock(mutex);
    worst.add(found.worst);
  });
  PointClaims claims;
  claims.error = meter.certificate().finish();
  claims.excluded = claims.error.excluded.size();
  claims.kernel = worst.exclude(0).kept;
  if (PiecewiseCertificate* of_reference = meter.certificate_of_reference()) {
    claims.of_reference = of_reference->finish();
  }
  return claims;
}

}  // namespace emax
