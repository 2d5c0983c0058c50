#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "host/app/reference_file.h"
#include "host/app/result_regions.h"
#include "host/app/scan.h"
#include "host/app/scan_pieces.h"
#include "host/report/certificate_file.h"
#include "host/report/result_json.h"

namespace emax {

// The proofs for one mesh.
struct ProvenMesh {
  MeshValidity validity;
  MeshTopology topology;
  CertifiedError points;   // indices are the cloud's
  EmaxResult kernel = {};  // over the points that are not excluded; the index is the file's
  std::optional<double> points_to_reference;  // greatest distance of a kept point, where known
  std::optional<ReferenceBound> reference;    // of a two-sided bound
  std::filesystem::path reference_path;       // of its file
};

// The scan that results are certified against, and how it was read.
struct ResultCloud {
  const Scan& scan;
  const std::string& sha256;      // of its file
  CloudReadOptions reading = {};  // see Certificate
  bool vertices_of_mesh = false;  // see Certificate
  // Where the points are not in memory.
  const ScanPieces* pieces = nullptr;

  std::uint64_t points() const { return pieces ? pieces->points() : scan.cloud.points.size(); }
  Normalization transform() const {
    return pieces ? pieces->normalization() : normalization_of(scan.cloud.points);
  }
};

// A mesh that a command found, with all that its certificate and the JSON report.
struct CertifiedResult {
  ResultCloud cloud;
  double epsilon;  // in the cloud's unit
  const TriangleMesh& mesh;
  const ProvenMesh& proven;
  ChainSettings chain = {};  // how it was found
  std::uint64_t seed = 0, evaluations = 0;
  const ResultRegions* regions = nullptr;  // where planes of the scan were followed
};

struct WrittenResult {
  std::string mesh_sha256;
  std::string certificate;  // its text
};

// The certificate of the result in a file of this name and SHA-256.
std::string certificate_text(const CertifiedResult& result, const std::filesystem::path& mesh,
                             std::string mesh_sha256);

// Writes the mesh, the certificate and, unless it exists already, the reference: all of them or
// none. `reference` is nullptr for a one-sided bound. Throws Error if they cannot be written.
WrittenResult write_result(const std::filesystem::path& mesh, const CertifiedResult& result,
                           ReferenceFile* reference);

// The JSON report of a result, for any command that found it.
ResultReport report_of(const CertifiedResult& result);

}  // namespace emax
