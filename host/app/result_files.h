#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>

#include "host/app/certified_result.h"
#include "host/app/commands.h"
#include "host/optimize/optimize.h"

namespace emax {

// The files of a search's result: mesh, certificate and, under a two-sided bound, the reference.
// They are written as soon as there is a result, and again whenever there is a better one, so that
// a program that is killed leaves the best so far.
class ResultFiles {
 public:
  // All arguments must outlive this; the bound of `settings` must be final.
  ResultFiles(const OptimizeOptions& options, const OptimizeSettings& settings, const Scan& scan,
              const std::string& cloud_sha256, const ErrorConstraint& constraint);

  // Certifies the mesh, unless the mesh of this evaluation was written last, and writes the files.
  // Throws Error if they cannot be written, and if the certificate contradicts the numbers of the
  // kernel or the decimator.
  ProvenMesh write(const BestMesh& best, std::uint64_t evaluations);

  // What write() wrote last, if anything.
  const std::optional<WrittenResult>& written() const { return written_; }

  // Writes only the reference of a two-sided bound, and computes its topology.
  void write_reference();
  const MeshTopology& topology_of_reference() const { return reference_->topology(); }

  // Whether the existing files hold a mesh of fewer triangles under the same bounds, which an
  // earlier part of the run may have left.
  bool hold_fewer_than(std::size_t triangles) const;

  // The proofs for a mesh, whether it keeps the bounds or not; without those for the reference.
  ProvenMesh judge(const BestMesh& mesh) const;

  // The result record for a mesh of the search, with the regions of a mesh on planes of the scan.
  // Valid until the next call.
  CertifiedResult result(const BestMesh& best, const ProvenMesh& proven, std::uint64_t evaluations);
  // The planes of the last result() with regions.
  const PlaneParts& planes() const { return planes_; }

 private:
  void find_regions(const BestMesh& best);
  ProvenMesh prove(const BestMesh& best);
  ReferenceBound bound_of_reference(const BestMesh& best);

  const OptimizeOptions& options_;
  const OptimizeSettings& settings_;
  const Scan& scan_;
  const std::string& cloud_sha256_;
  const ErrorConstraint& constraint_;
  std::optional<ReferenceFile> reference_;  // of a two-sided bound
  // The evaluation and numbers that identify the mesh that was written last, and its proofs.
  std::tuple<std::uint64_t, std::size_t, std::uint32_t> proven_mesh_;
  std::optional<ProvenMesh> proven_;
  std::optional<WrittenResult> written_;
  // Those of the last candidate on planes, and the values of PlaneFeatures by which they were
  // found.
  PlaneParts planes_;
  ParameterValues planes_key_;
  std::optional<ResultRegions> regions_;  // of the last result
};

}  // namespace emax
