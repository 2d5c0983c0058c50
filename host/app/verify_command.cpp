#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/app/commands.h"
#include "host/app/interrupt.h"
#include "host/app/json_output.h"
#include "host/app/reference_text.h"
#include "host/files/atomic_file.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "host/parameters/decimation_bound.h"
#include "host/report/certificate_file.h"
#include "host/report/verification_json.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"
#include "sw_model/certify/surface_distance.h"

namespace emax {
namespace {

// The file as named, or beside the certificate, or (if `also_here`) in the current folder.
std::filesystem::path locate(const std::string& named, const std::string& file, const char* option,
                             const std::filesystem::path& certificate, bool also_here) {
  if (!named.empty()) return named;
  std::filesystem::path beside = certificate.parent_path() / file;
  if (std::filesystem::exists(beside)) return beside;
  if (also_here && std::filesystem::exists(file)) return file;
  throw Error(fmt::format("{}: its {} is not found; name it with --{}", certificate.string(), file,
                          option));
}

// Converts indices of the file to those of the cloud as read.
std::vector<std::uint32_t> in_cloud(std::span<const std::uint32_t> in_file,
                                    const PointCloud& cloud) {
  std::vector<std::uint32_t> indices(in_file.begin(), in_file.end());
  for (std::uint32_t& index : indices) {
    if (cloud.file_index.empty()) continue;
    const auto at = std::ranges::lower_bound(cloud.file_index, index);
    const bool found = at != cloud.file_index.end() && *at == index;
    index = found ? static_cast<std::uint32_t>(at - cloud.file_index.begin()) : ~0u;
  }
  return indices;
}

// Another build may round the last bit differently.
bool agree(double claimed, double found) {
  return std::abs(claimed - found) <= 1e-12 * std::abs(found);
}

class Verification {
 public:
  explicit Verification(const VerifyOptions& options)
      : path_(options.certificate), certificate_(read_certificate(path_)) {
    mesh_path_ = locate(options.mesh, certificate_.mesh_file, "mesh", path_, false);
    cloud_path_ = locate(options.cloud, certificate_.cloud_file, "cloud", path_, true);
    if (certificate_.reference) {
      reference_path_ =
          locate(options.reference, certificate_.reference->file, "reference", path_, true);
    }
  }

  // Throws Error if `json` is one of the files that are read.
  void require_apart(const std::string& json) const {
    check_distinct({json}, {path_, mesh_path_, cloud_path_, reference_path_});
  }

  // The JSON of the results of run().
  std::string json_text() const {
    return to_json_text({.certificate_file = path_.string(),
                         .mesh_file = mesh_path_.string(),
                         .cloud_file = cloud_path_.string(),
                         .reference_file = reference_path_.string(),
                         .certificate = &certificate_,
                         .e_max = e_max_,
                         .reasons = reasons_});
  }

  bool run() {
    require(sha256_of_file(mesh_path_) == certificate_.mesh_sha256,
            fmt::format("{} is not the mesh that was certified (SHA-256)", mesh_path_.string()));
    require(sha256_of_file(cloud_path_) == certificate_.cloud_sha256,
            fmt::format("{} is not the cloud that was certified (SHA-256)", cloud_path_.string()));
    if (certificate_.reference) {
      require(sha256_of_file(reference_path_) == certificate_.reference->sha256,
              fmt::format("{} is not the reference that was certified (SHA-256)",
                          reference_path_.string()));
    }
    if (!reasons_.empty()) return report();

    const TriangleMesh mesh = read_mesh(mesh_path_);
    const Scan scan = certificate_.vertices_of_mesh
                          ? vertices_of(cloud_path_, read_mesh(cloud_path_))
                          : read_scan(cloud_path_, certificate_.reading);
    require_resolution(scan, certificate_.epsilon);
    require(mesh.triangles.size() == certificate_.triangles &&
                mesh.vertices.size() == certificate_.vertices,
            fmt::format("the mesh has {} triangles and {} vertices, not {} and {}",
                        mesh.triangles.size(), mesh.vertices.size(), certificate_.triangles,
                        certificate_.vertices));
    const auto excluded = in_cloud(certificate_.error.excluded, scan.cloud);
    std::vector<std::uint32_t> sorted = excluded;
    std::ranges::sort(sorted);
    require(sorted.empty() || sorted.back() < scan.cloud.points.size(),
            "the certificate excludes a point that the cloud does not have");
    require(std::ranges::adjacent_find(sorted) == sorted.end(),
            "the certificate excludes a point twice");
    require(sorted.size() < scan.cloud.points.size(), "the certificate excludes every point");
    if (!reasons_.empty()) return report();
    check_error(mesh, scan, excluded);
    check_kernel(mesh, scan, excluded);
    if (certificate_.reference) check_reference(mesh, scan, excluded);
    const MeshValidity validity = check_mesh(mesh.view());
    require(validity == certificate_.validity && validity.valid() == certificate_.claims_valid,
            "the mesh's validity differs");
    check_topology("the mesh", certificate_.topology, mesh);
    const Normalization transform = normalization_of(scan.cloud.points);
    require(transform.origin == certificate_.transform.origin &&
                transform.scale == certificate_.transform.scale,
            "the certificate's transform is not that of the cloud");
    return report();
  }

 private:
  void require(bool holds, std::string otherwise) {
    if (!holds) reasons_.push_back(std::move(otherwise));
  }

  void check_topology(const char* what, const MeshTopology& claimed, const TriangleMesh& mesh) {
    const MeshTopology found = topology_of(mesh.view());
    require(claimed == found, fmt::format("the certificate claims {} for {}, which has {}",
                                          describe(claimed), what, describe(found)));
  }

  void check_error(const TriangleMesh& mesh, const Scan& scan,
                   std::span<const std::uint32_t> excluded) {
    const CertifiedError error =
        certify(scan.cloud.points, mesh.view(), excluded, processor_threads());
    const CertifiedError& claimed = certificate_.error;
    require(
        error.within(certificate_.epsilon),
        fmt::format("e_max is {:.9g}, more than {:.9g}", error.e_max_upper, certificate_.epsilon));
    // Another build may round the last bit differently, but a claim below the exact value is false.
    require(claimed.e_max_upper >= error.e_max_lower && claimed.e_max_upper <= certificate_.epsilon,
            fmt::format("the certificate claims e_max {:.9g}, but it is {:.9g}",
                        claimed.e_max_upper, error.e_max_upper));
    require(claimed.points == error.points,
            fmt::format("the certificate counts {} points, but {} are kept", claimed.points,
                        error.points));
    for (std::size_t i = 0; i < excluded.size(); ++i) {
      require(
          agree(claimed.excluded_distances[i], error.excluded_distances[i]),
          fmt::format(
              "the certificate claims {:.9g} for the distance of the excluded point {}, which is "
              "{:.9g}",
              claimed.excluded_distances[i], claimed.excluded[i], error.excluded_distances[i]));
    }
    require(agree(claimed.e_max_upper_all, error.e_max_upper_all),
            fmt::format("the certificate claims e_max {:.9g} over all points, but it is {:.9g}",
                        claimed.e_max_upper_all, error.e_max_upper_all));
    e_max_ = error.e_max_upper;
  }

  void check_kernel(const TriangleMesh& mesh, const Scan& scan,
                    std::span<const std::uint32_t> excluded) {
    const EmaxResult worst = kernel_error(scan, mesh.view(), excluded);
    require(worst.squared_bits == certificate_.kernel.squared_bits &&
                worst.worst_point == certificate_.kernel.worst_point,
            fmt::format("the kernel gives 0x{:08x} at point {}, not 0x{:08x} at point {}",
                        worst.squared_bits, worst.worst_point, certificate_.kernel.squared_bits,
                        certificate_.kernel.worst_point));
  }

  void check_reference(const TriangleMesh& mesh, const Scan& scan,
                       std::span<const std::uint32_t> excluded) {
    const ReferenceBound& claimed = *certificate_.reference;
    const TriangleMesh reference = read_mesh(reference_path_);
    require(reference.triangles.size() == claimed.triangles,
            fmt::format("the reference has {} triangles, not {}", reference.triangles.size(),
                        claimed.triangles));
    const auto check = [&](const char* what, MeshView from, const TriangleMesh& to, double claim,
                           double limit) {
      require(claim >= 0 && claim <= limit,
              fmt::format("the certificate claims {:.9g} for {}, not within 0 and {:.9g}", claim,
                          what, limit));
      if (!(claim >= 0)) return;
      const SurfaceDistance found = decided_distance(from, ExactMesh(to.view()), claim);
      // A claim that holds may stay undecided because of roundings.
      require(
          found.lower <= claim && found.within(limit),
          fmt::format("the certificate claims {:.9g} for {}, which lies within {:.9g} and {:.9g}",
                      claim, what, found.lower, found.upper));
    };
    check("the distance of the mesh to the reference", mesh.view(), reference,
          claimed.mesh_to_reference, claimed.epsilon_back);
    check("the distance of the reference to the mesh", reference.view(), mesh,
          claimed.reference_to_mesh, certificate_.epsilon);
    check_topology("the reference", claimed.topology, reference);
    const CertifiedError own =
        certify(scan.cloud.points, reference.view(), excluded, processor_threads());
    require(
        claimed.points_to_reference >= own.e_max_lower,
        fmt::format(
            "the certificate claims {:.9g} for the distance of the points to the reference, which "
            "is {:.9g}",
            claimed.points_to_reference, own.e_max_upper));
  }

  bool report() const {
    if (reasons_.empty()) {
      const CertifiedError& error = certificate_.error;
      fmt::print("yes: every {}point of {} lies within {:.9g} of {} (e_max {:.9g}, {} triangles)\n",
                 error.excluded.empty() ? "" : "kept ", cloud_path_.string(), certificate_.epsilon,
                 mesh_path_.string(), *e_max_, grouped(certificate_.triangles));
      if (!error.excluded.empty()) {
        fmt::print("     {} of its {} points are excluded, the farthest at {:.9g}\n",
                   grouped(error.excluded.size()), grouped(error.points + error.excluded.size()),
                   std::ranges::max(error.excluded_distances));
      }
      if (certificate_.reference) {
        const ReferenceBound& reference = *certificate_.reference;
        fmt::print("yes: all of {} lies within {:.9g} of {} (at most {:.9g})\n",
                   mesh_path_.string(), reference.epsilon_back, reference_path_.string(),
                   reference.mesh_to_reference);
        if (reference.reference_to_mesh <= certificate_.epsilon) {
          fmt::print("yes: all of {} lies within {:.9g} of {} (at most {:.9g})\n",
                     reference_path_.string(), certificate_.epsilon, mesh_path_.string(),
                     reference.reference_to_mesh);
        } else {
          fmt::print("     all of {} lies within {:.9g} of {}, which the certificate leaves open\n",
                     reference_path_.string(), reference.reference_to_mesh, mesh_path_.string());
        }
      }
      fmt::print("yes: {} has {}\n", mesh_path_.string(),
                 describe(certificate_.topology,
                          certificate_.reference ? std::optional(certificate_.reference->topology)
                                                 : std::nullopt));
      return true;
    }
    for (const std::string& reason : reasons_) fmt::print("no: {}\n", reason);
    return false;
  }

  std::filesystem::path path_;
  Certificate certificate_;
  std::filesystem::path mesh_path_, cloud_path_, reference_path_;
  std::optional<double> e_max_;
  std::vector<std::string> reasons_;
};

}  // namespace

int run_verify(const VerifyOptions& options) {
  if (!options.json.empty()) check_output(options.json, kJsonEndings);
  Verification verification(options);
  verification.require_apart(options.json);
  const bool holds = verification.run();
  if (json_is_wanted(options.json)) write_json(options.json, verification.json_text());
  return holds ? kExitOk : kExitNo;
}

}  // namespace emax
