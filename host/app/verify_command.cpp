#include <fmt/format.h>

#include <algorithm>

#include "host/app/commands.h"
#include "host/app/interrupt.h"
#include "host/emax_search/error_engine.h"
#include "host/geometry/mesh_file.h"
#include "host/geometry/sha256.h"
#include "host/report/certificate_file.h"
#include "sw_model/error.h"

namespace emax {
namespace {

// As named, or beside the certificate, or (for a cloud) in the current folder.
std::filesystem::path locate(const std::string& named, const std::string& file, const char* option,
                             const std::filesystem::path& certificate, bool also_here) {
  if (!named.empty()) return named;
  std::filesystem::path beside = certificate.parent_path() / file;
  if (std::filesystem::exists(beside)) return beside;
  if (also_here && std::filesystem::exists(file)) return file;
  throw Error(fmt::format("{}: its {} is not found; name it with --{}", certificate.string(), file,
                          option));
}

// Indices of the file back to those of the cloud as read.
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

class Verification {
 public:
  explicit Verification(const VerifyOptions& options)
      : path_(options.certificate), certificate_(read_certificate(path_)) {
    mesh_path_ = locate(options.mesh, certificate_.mesh_file, "mesh", path_, false);
    cloud_path_ = locate(options.cloud, certificate_.cloud_file, "cloud", path_, true);
  }

  bool run() {
    require(sha256_of_file(mesh_path_) == certificate_.mesh_sha256,
            fmt::format("{} is not the mesh that was certified (SHA-256)", mesh_path_.string()));
    require(sha256_of_file(cloud_path_) == certificate_.cloud_sha256,
            fmt::format("{} is not the cloud that was certified (SHA-256)", cloud_path_.string()));
    if (!reasons_.empty()) return report();

    const TriangleMesh mesh = read_mesh(mesh_path_);
    const Scan scan = read_scan(cloud_path_, certificate_.skip_invalid);
    require(mesh.triangles.size() == certificate_.triangles &&
                mesh.vertices.size() == certificate_.vertices,
            fmt::format("the mesh has {} triangles and {} vertices, not {} and {}",
                        mesh.triangles.size(), mesh.vertices.size(), certificate_.triangles,
                        certificate_.vertices));
    const auto excluded = in_cloud(certificate_.error.excluded, scan.cloud);
    if (std::ranges::any_of(excluded,
                            [&](std::uint32_t i) { return i >= scan.cloud.points.size(); })) {
      require(false, "it excludes a point that the cloud does not have");
      return report();
    }
    check_error(mesh, scan, excluded);
    check_kernel(mesh, scan, excluded);
    require(check_mesh(mesh.view()) == certificate_.validity, "the mesh's validity differs");
    return report();
  }

 private:
  void require(bool holds, std::string otherwise) {
    if (!holds) reasons_.push_back(std::move(otherwise));
  }

  void check_error(const TriangleMesh& mesh, const Scan& scan,
                   std::span<const std::uint32_t> excluded) {
    const CertifiedError error = certify(scan.cloud.points, mesh.view(), excluded);
    const CertifiedError& claimed = certificate_.error;
    require(
        error.within(certificate_.epsilon),
        fmt::format("e_max is {:.9g}, more than {:.9g}", error.e_max_upper, certificate_.epsilon));
    // Another build may round the last bit otherwise; a claim below the exact value is false.
    require(claimed.e_max_upper >= error.e_max_lower && claimed.e_max_upper <= certificate_.epsilon,
            fmt::format("it claims e_max {:.9g}, but it is {:.9g}", claimed.e_max_upper,
                        error.e_max_upper));
    require(claimed.points == error.points,
            fmt::format("it counts {} points, but {} are kept", claimed.points, error.points));
    e_max_ = error.e_max_upper;
  }

  void check_kernel(const TriangleMesh& mesh, const Scan& scan,
                    std::span<const std::uint32_t> excluded) {
    const PreparedCloud cloud(scan.cloud.points);
    const PreparedMesh prepared(mesh.view(), cloud.normalization());
    ErrorEngine engine(cloud, {.interrupted = was_interrupted});
    std::vector<std::uint32_t> bits = engine.squared_distances(prepared);
    for (const std::uint32_t i : excluded) bits[i] = 0;
    const EmaxResult worst = worst_of(bits);
    require(worst.squared_bits == certificate_.kernel.squared_bits &&
                scan.cloud.index_in_file(worst.worst_point) == certificate_.kernel.worst_point,
            fmt::format("the kernel gives 0x{:08x} at point {}, not 0x{:08x} at point {}",
                        worst.squared_bits, scan.cloud.index_in_file(worst.worst_point),
                        certificate_.kernel.squared_bits, certificate_.kernel.worst_point));
  }

  bool report() const {
    if (reasons_.empty()) {
      fmt::print("yes: every {}point of {} lies within {:.9g} of {} (e_max {:.9g}, {} triangles)\n",
                 certificate_.error.excluded.empty() ? "" : "kept ", cloud_path_.string(),
                 certificate_.epsilon, mesh_path_.string(), e_max_,
                 grouped(certificate_.triangles));
      return true;
    }
    for (const std::string& reason : reasons_) fmt::print("no: {}\n", reason);
    return false;
  }

  std::filesystem::path path_;
  Certificate certificate_;
  std::filesystem::path mesh_path_, cloud_path_;
  double e_max_ = 0;
  std::vector<std::string> reasons_;
};

}  // namespace

int run_verify(const VerifyOptions& options) {
  return Verification(options).run() ? kExitOk : kExitNo;
}

}  // namespace emax
