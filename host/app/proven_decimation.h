#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/app/certified_result.h"
#include "host/app/given_reference.h"
#include "host/decimate/certified_decimation.h"

namespace emax {

// The points of a scan that a decimation has to keep to, and those that it may leave out.
struct KeptPoints {
  std::vector<std::uint32_t> outliers;  // left out from the start, ascending
  std::vector<Point> points;            // the others
  std::vector<std::uint32_t> index;     // of these in the cloud
};

// Where the farthest points take all that may be excluded, and `missed` others cannot be joined to
// the mesh, the nearest of the former make room: most of them can be joined. How many stay excluded
// then; nothing where there is room, or none can be made. `tries`: how often that was asked before.
std::optional<std::size_t> fewer_excluded(std::size_t excluded, std::size_t missed,
                                          std::size_t excludable, int tries);

struct KeptReference {
  KeptPoints kept;
  GivenReference reference;
};

// Leaves out the points farthest beyond `epsilon` from the mesh, at most `excludable` of them and
// fewer where others need the room. `make` gives the reference of those that are kept, and is
// called up to five times. O(n log n) beside that.
KeptReference reference_with_room(const Scan& scan, MeshView mesh, double epsilon,
                                  std::size_t excludable, std::size_t threads,
                                  const std::function<GivenReference(const KeptPoints&)>& make);

// Decimates the reference under the bounds of `settings`, and certifies every point of the scan.
CertifiedDecimation decimate_scan(const TriangleMesh& reference, const Scan& scan,
                                  const KeptPoints& kept,
                                  const CertifiedDecimationSettings& settings);

// The decimator's proofs in the form of the certificate, without those for the reference.
ProvenMesh proofs_of(const CertifiedDecimation& made, const Scan& scan);

// The proofs for the reference of a two-sided bound, whose file is `file`. `points_to_reference`:
// the greatest distance of a kept point from it, where it is known.
ReferenceBound bound_of(const CertifiedDecimation& made, double epsilon_back, ReferenceFile& file,
                        const std::optional<double>& points_to_reference = {});

// What the certificate says of how the mesh was found.
ChainSettings chain_of(const DecimationSettings& settings);

}  // namespace emax
