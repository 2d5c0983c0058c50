#include "host/app/certified_result.h"

#include <utility>
#include <vector>

#include "host/files/mesh_file.h"
#include "host/files/scan_folder.h"
#include "host/files/sha256.h"

namespace emax {
namespace {

Certificate certificate_of(const CertifiedResult& result, const std::filesystem::path& mesh,
                           std::string mesh_sha256) {
  const Scan& scan = result.cloud.scan;
  Certificate certificate;
  certificate.mesh_file = mesh.filename().string();
  certificate.mesh_sha256 = std::move(mesh_sha256);
  certificate.cloud_file = name_of_input(scan.path);
  certificate.cloud_sha256 = result.cloud.sha256;
  certificate.reading = result.cloud.reading;
  certificate.vertices_of_mesh = result.cloud.vertices_of_mesh;
  certificate.epsilon = result.epsilon;
  if (scan.unit) certificate.unit = scan.unit->name;
  certificate.error = in_file_indices(result.proven.points, scan.cloud);
  certificate.kernel = result.proven.kernel;
  certificate.vertices = result.mesh.vertices.size();
  certificate.triangles = result.mesh.triangles.size();
  certificate.validity = result.proven.validity;
  certificate.topology = result.proven.topology;
  certificate.reference = result.proven.reference;
  certificate.transform = result.cloud.transform();
  certificate.chain = result.chain;
  certificate.seed = result.seed;
  certificate.evaluations = result.evaluations;
  return certificate;
}

}  // namespace

std::string certificate_text(const CertifiedResult& result, const std::filesystem::path& mesh,
                             std::string mesh_sha256) {
  return to_json_text(certificate_of(result, mesh, std::move(mesh_sha256)));
}

WrittenResult write_result(const std::filesystem::path& mesh, const CertifiedResult& result,
                           ReferenceFile* reference) {
  const TriangleGroups* groups = result.regions != nullptr ? &result.regions->groups : nullptr;
  std::string bytes = mesh_bytes(result.mesh, mesh_format(mesh),
                                 {.unit = result.cloud.scan.unit, .groups = groups});
  const std::string mesh_sha256 = sha256(bytes);
  std::string certificate = certificate_text(result, mesh, mesh_sha256);
  std::vector<OutputFile> files;
  if (reference != nullptr && reference->unwritten() != nullptr) {
    files.push_back(*reference->unwritten());
  }
  files.push_back({mesh, std::move(bytes)});
  files.push_back({certificate_path(mesh), certificate});
  write_together(files);
  if (reference != nullptr) reference->was_written();
  return {mesh_sha256, std::move(certificate)};
}

ResultReport report_of(const CertifiedResult& result) {
  const Scan& scan = result.cloud.scan;
  ResultReport report;
  report.validity = result.proven.validity;
  report.topology = result.proven.topology;
  report.triangles = result.mesh.triangles.size();
  report.epsilon = result.epsilon;
  report.certified = in_file_indices(result.proven.points, scan.cloud);
  report.kernel = result.proven.kernel;
  report.points = result.cloud.points();
  if (scan.unit) report.unit = scan.unit->name;
  report.transform = result.cloud.transform();
  report.reference = result.proven.reference;
  if (result.regions != nullptr) report.regions = result.regions->regions;
  return report;
}

}  // namespace emax
