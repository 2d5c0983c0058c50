#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/files/atomic_file.h"
#include "host/geometry/triangle_mesh.h"
#include "host/report/certificate_file.h"
#include "sw_model/certify/certificate.h"

namespace emax {

// The reference surface of a two-sided bound and the file that holds it. Checksum and topology are
// computed once for all results that refer to it, and the file is written once.
class ReferenceFile {
 public:
  // A file that is still to be written. `mesh` and `points`, those of the cloud, must outlive this.
  ReferenceFile(std::filesystem::path path, const TriangleMesh& mesh,
                std::span<const Point> points);
  // A file that exists, with the checksum of its bytes.
  ReferenceFile(std::filesystem::path path, const TriangleMesh& mesh, std::span<const Point> points,
                std::string sha256);

  const std::filesystem::path& path() const { return file_.path; }
  const std::string& sha256() const { return sha256_; }
  const MeshTopology& topology() const { return topology_; }

  // Fills in a bound's data about the reference itself; epsilon_back and the distances between mesh
  // and reference stay unchanged. `excluded`: points that the bound excludes. O(n log n) for n
  // points; less if `excluded` is the same as in the last call.
  void describe(ReferenceBound& bound, const std::vector<std::uint32_t>& excluded);
  // The same where the greatest distance of a point that is not excluded is known.
  void describe_measured(ReferenceBound& bound, double points_to_reference) const;

  // The file that is still to be written; nullptr if it exists.
  const OutputFile* unwritten() const { return file_.bytes.empty() ? nullptr : &file_; }
  void was_written() { file_.bytes = {}; }

 private:
  OutputFile file_;  // its bytes until they are written
  const TriangleMesh& mesh_;
  std::span<const Point> points_;
  std::string sha256_;
  MeshTopology topology_;
  std::optional<CertifiedError> points_to_reference_;  // of the last call
};

}  // namespace emax
