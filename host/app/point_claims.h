#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "host/app/measured_mesh.h"
#include "host/app/piece_runner.h"
#include "host/app/scan_pieces.h"
#include "host/geometry/triangle_mesh.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/model/emax_model.h"

namespace emax {

// What a certificate claims of the points of a scan, recomputed. Points are named by their numbers
// in the file.
struct PointClaims {
  std::size_t excluded = 0;  // those of the excluded that are points of the scan
  CertifiedError error;
  EmaxResult kernel;                           // over the kept points
  std::optional<CertifiedError> of_reference;  // their distance from the reference
};

// `excluded`: ascending, each once, fewer than the scan has points. `reference` may be nullptr.
// `files`: those of the meshes, where the runner has other processes. `memory`: bytes for distances
// from a mesh in parts, which is measured without a reference by this process.
PointClaims recompute(const ScanPieces& scan, const MeasuredMesh& mesh,
                      const TriangleMesh* reference, std::span<const std::uint32_t> excluded,
                      PieceRunner& runner, const MeterFiles& files, std::uint64_t memory);

}  // namespace emax
