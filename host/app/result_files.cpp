#include "host/app/result_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "host/app/reference_text.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"
#include "sw_model/certify/surface_distance.h"

namespace emax {
namespace {

[[noreturn]] void contradict(const char* whose, double certified) {
  throw Error(
      fmt::format("the certificate ({:.9g}) contradicts {}: nothing is written; this is a defect "
                  "of the program, please report it",
                  certified, whose));
}

}  // namespace

const OutputFile& ResultFiles::reference_file() {
  if (reference_sha256_.empty()) {
    reference_ = {reference_path(options_.output),
                  mesh_bytes(settings_.bound.reference, MeshFormat::kPly)};
    reference_sha256_ = sha256(reference_.bytes);
  }
  return reference_;
}

ReferenceBound ResultFiles::bound_of_reference(const BestMesh& best) {
  const double allowed = *settings_.epsilon_back;
  const SurfaceDistance back =
      decided_distance(best.mesh.view(), ExactMesh(settings_.bound.reference.view()), allowed);
  if (!back.within(allowed)) {
    contradict("the decimator's bound on the distance of the mesh to the reference", back.upper);
  }
  ReferenceBound bound;
  const double epsilon = constraint_.epsilon();
  const SurfaceDistance whole =
      decided_distance(settings_.bound.reference.view(), ExactMesh(best.mesh.view()), epsilon);
  if (!whole.within(epsilon)) {
    contradict("the decimator's bound on the distance of the reference to the mesh", whole.upper);
  }
  bound.reference_to_mesh = whole.upper;
  bound.topology = topology_of(settings_.bound.reference.view());
  bound.file = reference_file().path.filename().string();
  bound.sha256 = reference_sha256_;
  bound.triangles = settings_.bound.reference.triangles.size();
  bound.epsilon_back = allowed;
  bound.mesh_to_reference = back.upper;
  if (!points_to_reference_ || points_to_reference_->excluded != best.error.excluded) {
    points_to_reference_ = certify(scan_.cloud.points, settings_.bound.reference.view(),
                                   best.error.excluded, processor_threads());
  }
  bound.points_to_reference = points_to_reference_->e_max_upper;
  return bound;
}

ProvenMesh ResultFiles::prove(const BestMesh& best) {
  ProvenMesh proven;
  proven.validity = check_mesh(best.mesh.view());
  proven.topology = topology_of(best.mesh.view());
  proven.points =
      certify(scan_.cloud.points, best.mesh.view(), best.error.excluded, processor_threads());
  if (!proven.points.within(constraint_.epsilon())) {
    contradict("the kernel's e_max", proven.points.e_max_upper);
  }
  if (settings_.epsilon_back) proven.reference = bound_of_reference(best);
  return proven;
}

ProvenMesh ResultFiles::write(const BestMesh& best, std::uint64_t evaluations) {
  const std::tuple mesh(best.index, best.triangles, best.error.kept.squared_bits);
  if (!proven_ || proven_mesh_ != mesh) proven_ = prove(best);
  proven_mesh_ = mesh;
  const ProvenMesh& proven = *proven_;
  std::string bytes = mesh_bytes(best.mesh, mesh_format(settings_.output));
  Certificate certificate;
  certificate.mesh_file = std::filesystem::path(options_.output).filename().string();
  certificate.mesh_sha256 = sha256(bytes);
  certificate.cloud_file = scan_.path.filename().string();
  certificate.cloud_sha256 = cloud_sha256_;
  certificate.skip_invalid = options_.common.skip_invalid;
  certificate.epsilon = constraint_.epsilon();
  certificate.error = in_file_indices(proven.points, scan_.cloud);
  certificate.kernel = in_file_indices(best.error.kept, scan_.cloud);
  certificate.vertices = best.mesh.vertices.size();
  certificate.triangles = best.mesh.triangles.size();
  certificate.validity = proven.validity;
  certificate.topology = proven.topology;
  certificate.transform = constraint_.cloud().normalization();
  certificate.chain = best.chain;
  certificate.seed = settings_.seed;
  certificate.evaluations = evaluations;
  std::vector<OutputFile> files;
  if (settings_.epsilon_back) {
    certificate.reference = proven.reference;
    if (!reference_.bytes.empty()) files.push_back(reference_);
  }
  files.push_back({options_.output, std::move(bytes)});
  files.push_back({certificate_path(options_.output), to_json_text(certificate)});
  write_together(files);
  reference_.bytes.clear();  // which stay as they are
  return proven;
}

void ResultFiles::write_reference() {
  const OutputFile& file = reference_file();
  write_atomically(file.path, file.bytes);
  reference_.bytes.clear();
}

bool ResultFiles::hold_fewer_than(std::size_t triangles) {
  const std::filesystem::path path = certificate_path(options_.output);
  if (!std::filesystem::exists(path) || !std::filesystem::exists(options_.output)) return false;
  try {
    const Certificate there = read_certificate(path);
    if (settings_.epsilon_back) reference_file();
    return there.triangles < triangles && there.cloud_sha256 == cloud_sha256_ &&
           there.skip_invalid == options_.common.skip_invalid &&
           there.epsilon == constraint_.epsilon() &&
           there.error.excluded.size() <= constraint_.excludable() &&
           there.reference.has_value() == settings_.epsilon_back.has_value() &&
           (!there.reference || (there.reference->sha256 == reference_sha256_ &&
                                 there.reference->epsilon_back == settings_.epsilon_back)) &&
           sha256_of_file(options_.output) == there.mesh_sha256 &&
           (!there.reference ||
            sha256_of_file(reference_path(options_.output)) == there.reference->sha256);
  } catch (const Error&) {  // what is there is no result
    return false;
  }
}

}  // namespace emax
