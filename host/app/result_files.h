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
// They are written as soon as there is one and again whenever there is a better one, so that a
// program that is killed leaves the best so far.
class ResultFiles {
 public:
  // All of them outlive this; the bound of `settings` is fixed.
  ResultFiles(const OptimizeOptions& options, const OptimizeSettings& settings, const Scan& scan,
              const std::string& cloud_sha256, const ErrorConstraint& constraint);

  // Certifies the mesh, unless that of its evaluation was the last to be written, and writes the
  // files. Throws Error when they cannot be written, and where the certificate contradicts what
  // kernel or decimator said.
  ProvenMesh write(const BestMesh& best, std::uint64_t evaluations);

  // Of a two-sided bound: writes the reference alone, and its topology.
  void write_reference();
  const MeshTopology& topology_of_reference() const { return reference_->topology(); }

  // Whether the files that are there hold a mesh of fewer triangles under the same bounds, as an
  // earlier part of the run may have left them.
  bool hold_fewer_than(std::size_t triangles) const;

  // What is proven of a mesh, whether it keeps the bounds or not; nothing of the reference.
  ProvenMesh judge(const BestMesh& mesh) const;

  // A mesh of the search as a result.
  CertifiedResult result(const BestMesh& best, const ProvenMesh& proven,
                         std::uint64_t evaluations) const;

 private:
  ProvenMesh prove(const BestMesh& best);
  ReferenceBound bound_of_reference(const BestMesh& best);

  const OptimizeOptions& options_;
  const OptimizeSettings& settings_;
  const Scan& scan_;
  const std::string& cloud_sha256_;
  const ErrorConstraint& constraint_;
  std::optional<ReferenceFile> reference_;  // of a two-sided bound
  // Of what was written last, which its evaluation and these numbers tell.
  std::tuple<std::uint64_t, std::size_t, std::uint32_t> proven_mesh_;
  std::optional<ProvenMesh> proven_;
};

}  // namespace emax
