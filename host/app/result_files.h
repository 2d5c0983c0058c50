#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>

#include "host/app/commands.h"
#include "host/app/scan.h"
#include "host/files/atomic_file.h"
#include "host/optimize/optimize.h"
#include "host/report/certificate_file.h"

namespace emax {

// What is proven of one mesh of a search.
struct ProvenMesh {
  CertifiedError points;
  MeshValidity validity;
  MeshTopology topology;
  std::optional<ReferenceBound> reference;  // of a two-sided bound
};

// The files of a search's result: mesh, certificate and, under a two-sided bound, the reference.
// They are written as soon as there is one and again whenever there is a better one, so that a
// program that is killed leaves the best so far.
class ResultFiles {
 public:
  // All of them outlive this; the bound of `settings` is fixed before anything is written.
  ResultFiles(const OptimizeOptions& options, const OptimizeSettings& settings, const Scan& scan,
              const std::string& cloud_sha256, const ErrorConstraint& constraint)
      : options_(options),
        settings_(settings),
        scan_(scan),
        cloud_sha256_(cloud_sha256),
        constraint_(constraint) {}

  // Certifies the mesh, unless that of its evaluation was the last to be written, and writes the
  // files. Throws Error when they cannot be written, and where the certificate contradicts what
  // kernel or decimator said.
  ProvenMesh write(const BestMesh& best, std::uint64_t evaluations);

  // Writes the reference of a two-sided bound alone.
  void write_reference();

  // Whether the files that are there hold a mesh of fewer triangles under the same bounds, as an
  // earlier part of the run may have left them.
  bool hold_fewer_than(std::size_t triangles);

 private:
  ProvenMesh prove(const BestMesh& best);
  const OutputFile& reference_file();
  ReferenceBound bound_of_reference(const BestMesh& best);

  const OptimizeOptions& options_;
  const OptimizeSettings& settings_;
  const Scan& scan_;
  const std::string& cloud_sha256_;
  const ErrorConstraint& constraint_;
  OutputFile reference_;          // its bytes until they are written
  std::string reference_sha256_;  // empty until it is first needed
  std::optional<CertifiedError> points_to_reference_;
  // Of what was written last, which its evaluation and these numbers tell.
  std::tuple<std::uint64_t, std::size_t, std::uint32_t> proven_mesh_;
  std::optional<ProvenMesh> proven_;
};

}  // namespace emax
