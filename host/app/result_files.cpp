#include "host/app/result_files.h"

#include <fmt/format.h>

#include <filesystem>

#include "host/files/sha256.h"
#include "host/parameters/registry.h"
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

ResultFiles::ResultFiles(const OptimizeOptions& options, const OptimizeSettings& settings,
                         const Scan& scan, const std::string& cloud_sha256,
                         const ErrorConstraint& constraint)
    : options_(options),
      settings_(settings),
      scan_(scan),
      cloud_sha256_(cloud_sha256),
      constraint_(constraint) {
  if (!settings.epsilon_back) return;
  reference_.emplace(reference_path(options.output), settings.bound.reference, scan.cloud.points);
}

ReferenceBound ResultFiles::bound_of_reference(const BestMesh& best) {
  const MeshView reference = settings_.bound.reference.view();
  ReferenceBound bound;
  bound.epsilon_back = *settings_.epsilon_back;
  const SurfaceDistance back =
      decided_distance(best.mesh.view(), ExactMesh(reference), bound.epsilon_back);
  if (!back.within(bound.epsilon_back)) {
    contradict("the decimator's bound on the distance of the mesh to the reference", back.upper);
  }
  bound.mesh_to_reference = back.upper;
  const double epsilon = constraint_.epsilon();
  const SurfaceDistance whole = decided_distance(reference, ExactMesh(best.mesh.view()), epsilon);
  if (!whole.within(epsilon)) {
    contradict("the decimator's bound on the distance of the reference to the mesh", whole.upper);
  }
  bound.reference_to_mesh = whole.upper;
  reference_->describe(bound, best.error.excluded);
  return bound;
}

ProvenMesh ResultFiles::judge(const BestMesh& mesh) const {
  ProvenMesh proven;
  proven.validity = check_mesh(mesh.mesh.view());
  proven.topology = topology_of(mesh.mesh.view());
  proven.points =
      certify(scan_.cloud.points, mesh.mesh.view(), mesh.error.excluded, processor_threads());
  proven.kernel = in_file_indices(mesh.error.kept, scan_.cloud);
  return proven;
}

ProvenMesh ResultFiles::prove(const BestMesh& best) {
  ProvenMesh proven = judge(best);
  if (!proven.points.within(constraint_.epsilon())) {
    contradict("the kernel's e_max", proven.points.e_max_upper);
  }
  if (reference_) {
    proven.reference = bound_of_reference(best);
    proven.reference_path = reference_->path();
  }
  return proven;
}

// Finds the planes that the candidate's worker found.
void ResultFiles::find_regions(const BestMesh& best) {
  regions_.reset();
  const ParameterValues key = features_key(best.chain);
  if (key.by_name().empty()) return;
  const DecimationBound& bound = settings_.bound;
  if (key != planes_key_) {
    const PlaneThresholds thresholds = {
        key.at(PlaneFeatures::kBand), static_cast<std::size_t>(key.at(PlaneFeatures::kLeastPoints)),
        PlaneFeatures::method(key) == PlaneFeatures::Method::kAll};
    planes_ = find_plane_parts(
        points_without(scan_.cloud.points, bound.outliers), bound.epsilon, processor_threads(),
        [] {}, thresholds);
    planes_key_ = key;
  }
  const Storage storage = storage_of(mesh_format(settings_.output));
  regions_ = regions_of(best.mesh, planes_, beside_shape(best.mesh, storage, bound.epsilon),
                        bound.epsilon);
}

CertifiedResult ResultFiles::result(const BestMesh& best, const ProvenMesh& proven,
                                    std::uint64_t evaluations) {
  find_regions(best);
  return {.cloud = {scan_, cloud_sha256_, options_.common.reading},
          .epsilon = constraint_.epsilon(),
          .mesh = best.mesh,
          .proven = proven,
          .chain = best.chain,
          .seed = settings_.seed,
          .evaluations = evaluations,
          .regions = regions_ ? &*regions_ : nullptr};
}

ProvenMesh ResultFiles::write(const BestMesh& best, std::uint64_t evaluations) {
  const std::tuple mesh(best.index, best.triangles, best.error.kept.squared_bits);
  if (!proven_ || proven_mesh_ != mesh) proven_ = prove(best);
  proven_mesh_ = mesh;
  written_ = write_result(options_.output, result(best, *proven_, evaluations),
                          reference_ ? &*reference_ : nullptr);
  return *proven_;
}

void ResultFiles::write_reference() {
  if (const OutputFile* file = reference_->unwritten()) write_atomically(file->path, file->bytes);
  reference_->was_written();
}

bool ResultFiles::hold_fewer_than(std::size_t triangles) const {
  const std::filesystem::path path = certificate_path(options_.output);
  if (!std::filesystem::exists(path) || !std::filesystem::exists(options_.output)) return false;
  try {
    const Certificate there = read_certificate(path);
    return there.triangles < triangles && there.cloud_sha256 == cloud_sha256_ &&
           there.reading == options_.common.reading && there.epsilon == constraint_.epsilon() &&
           there.error.excluded.size() <= constraint_.excludable() &&
           there.reference.has_value() == reference_.has_value() &&
           (!there.reference || (there.reference->sha256 == reference_->sha256() &&
                                 there.reference->epsilon_back == settings_.epsilon_back)) &&
           sha256_of_file(options_.output) == there.mesh_sha256 &&
           (!there.reference || sha256_of_file(reference_->path()) == there.reference->sha256);
  } catch (const Error&) {  // the existing files are not a result
    return false;
  }
}

}  // namespace emax
