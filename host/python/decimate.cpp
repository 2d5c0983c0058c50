#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <chrono>

#include "host/app/given_reference.h"
#include "host/app/proven_decimation.h"
#include "host/decimate/joining_distance.h"
#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "host/files/tolerance.h"
#include "host/geometry/merge_vertices.h"
#include "host/measure/error_constraint.h"
#include "host/python/attended.h"
#include "host/python/bindings.h"
#include "host/python/certified_mesh.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"

namespace nb = nanobind;

namespace emax {
namespace {

// What `emax decimate` takes as options, with their meanings.
struct DecimateQuestion {
  std::string max_error, back_error, effort, objective, exclude_outliers;
  double feature_angle = 0;
  std::optional<double> seconds;
  std::size_t threads = 0;
  bool two_sided = true, repair = false, closed = false;
};

class ArrayDecimation {
 public:
  ArrayDecimation(const GivenMesh& given, const GivenCloud* cloud, const DecimateQuestion& question,
                  Watch& watch)
      : given_(given),
        question_(question),
        watch_(watch),
        mesh_(given.mesh),
        own_cloud_(cloud == nullptr),
        scan_(own_cloud_ ? vertices_of(name_of(given), given.mesh) : cloud->scan),
        in_files_(own_cloud_ ? !given.sha256.empty() : !cloud->sha256.empty()),
        cloud_sha256_(own_cloud_ ? sha256_of_mesh() : sha256_of(*cloud)),
        reading_(own_cloud_ ? CloudReadOptions{} : cloud->reading) {
    drop_unused_vertices(mesh_.vertices, mesh_.triangles);
    epsilon_ = length(question.max_error, "max_error");
    epsilon_back_ =
        question.back_error.empty() ? epsilon_ : length(question.back_error, "back_error");
    excludable_ =
        excludable_points(parse_share(question.exclude_outliers), scan_.cloud.points.size());
  }

  CertifiedMesh run() {
    const auto start = std::chrono::steady_clock::now();
    const auto stopped = [this] { return watch_.stopped(); };
    const auto [kept, reference] = reference_with_room(
        scan_, mesh_.view(), epsilon_, excludable_, 1, [&](const KeptPoints& points) {
          return make_reference(mesh_, points.points,
                                joining_distance(mesh_, points.points, epsilon_, stopped),
                                {.repair = question_.repair, .closed = question_.closed}, stopped);
        });
    if (stopped()) throw Interrupted{};
    CertifiedDecimationSettings settings = this->settings();
    settings.decimation.interrupted = [&] {
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
      return stopped() || (question_.seconds && took.count() > *question_.seconds);
    };
    CertifiedDecimation made = decimate_scan(reference.surface.mesh, scan_, kept, settings);
    const bool may_leave_out = own_cloud_ && reference.surface.dropped > 0;
    if (!may_leave_out && made.points.excluded.size() > excludable_) refuse(made.points);
    return certified(made, reference, settings.decimation);
  }

 private:
  static std::string name_of(const GivenMesh& given) {
    return given.file.empty() ? "mesh" : given.file;
  }
  std::string sha256_of_mesh() const {
    return !given_.sha256.empty() ? given_.sha256
                                  : sha256(mesh_bytes(given_.mesh, MeshFormat::kPly));
  }
  static std::string sha256_of(const GivenCloud& cloud) {
    return !cloud.sha256.empty() ? cloud.sha256 : sha256(bytes_of(cloud.scan.cloud.points));
  }
  double length(const std::string& text, const char* argument) const {
    const Tolerance tolerance = parse_tolerance(text, argument);
    return below_width(tolerance.in_unit_of(scan_.unit, argument), argument, scan_);
  }

  CertifiedDecimationSettings settings() const {
    using Effort = DecimationSettings::Effort;
    CertifiedDecimationSettings settings;
    DecimationSettings& d = settings.decimation;
    d.epsilon = epsilon_;
    d.epsilon_back = epsilon_back_;
    d.two_sided = question_.two_sided;
    d.effort = question_.effort == "quick"  ? Effort::kCollapse
               : question_.effort == "deep" ? Effort::kDeep
                                            : Effort::kRelax;
    d.feature_angle = question_.feature_angle;
    d.threads = question_.threads > 0 ? question_.threads : processor_threads();
    if (question_.objective == "hoppe") d.objective = DecimationSettings::Objective::kHoppe;
    d.advanced = [this](double share, std::size_t triangles) { watch_.advance(share, triangles); };
    settings.storage = storage_of(MeshFormat::kPly);
    return settings;
  }

  [[noreturn]] void refuse(const CertifiedError& points) const {
    throw Error(fmt::format(
        "max_error: {} of {} points are farther than {:.9g} from the mesh, the farthest at {:.9g}, "
        "and no triangle could be added to reach them; raise max_error or exclude points with "
        "exclude_outliers",
        points.excluded.size(), scan_.cloud.points.size(), epsilon_,
        std::ranges::max(points.excluded_distances)));
  }

  CertifiedMesh certified(CertifiedDecimation& made, const GivenReference& reference,
                          const DecimationSettings& settings) {
    ProvenMesh proven = proofs_of(made, scan_);
    CertifiedMesh result;
    if (question_.two_sided) {
      const TriangleMesh& surface = reference.surface.mesh;
      // A file that exists, or will: that of the mesh or, of its vertices, that of the arrays.
      const bool has_file = reference.is_as_given() && (!given_.file.empty() || own_cloud_);
      const std::string name = given_.file.empty() ? arrays_path(kMeshName) : given_.file;
      const std::vector<Point>& points = scan_.cloud.points;
      ReferenceFile file = has_file ? ReferenceFile(name, surface, points, sha256_of_mesh())
                                    : ReferenceFile(reference_path(kMeshName), surface, points);
      proven.reference = bound_of(made, epsilon_back_, file);
      result.back = proven.reference->mesh_to_reference;
      if (!has_file) result.reference = surface;
      result.arrays_are_reference = has_file && given_.file.empty();
    }
    if (!in_files_) scan_.path = arrays_path(kMeshName);
    const CertifiedResult facts = {.cloud = {scan_, cloud_sha256_, reading_, own_cloud_},
                                   .epsilon = epsilon_,
                                   .mesh = made.mesh,
                                   .proven = proven,
                                   .chain = chain_of(settings)};
    result.certificate =
        certificate_text(facts, kMeshName, sha256(mesh_bytes(made.mesh, MeshFormat::kPly)));
    result.e_max = made.points.e_max_upper;
    result.interrupted = made.interrupted;
    if (!in_files_) {
      result.arrays = own_cloud_ ? given_.mesh : TriangleMesh{scan_.cloud.points, {}};
    }
    result.mesh = std::move(made.mesh);
    return result;
  }

  const GivenMesh& given_;
  const DecimateQuestion& question_;
  Watch& watch_;
  TriangleMesh mesh_;
  bool own_cloud_;
  Scan scan_;
  bool in_files_;
  std::string cloud_sha256_;
  CloudReadOptions reading_;
  double epsilon_ = 0, epsilon_back_ = 0;
  std::size_t excludable_ = 0;
};

}  // namespace

void bind_decimate(nb::module_& module) {
  nb::class_<DecimateQuestion>(module, "DecimateQuestion")
      .def(nb::init<>())
      .def_rw("max_error", &DecimateQuestion::max_error)
      .def_rw("back_error", &DecimateQuestion::back_error)
      .def_rw("effort", &DecimateQuestion::effort)
      .def_rw("objective", &DecimateQuestion::objective)
      .def_rw("exclude_outliers", &DecimateQuestion::exclude_outliers)
      .def_rw("feature_angle", &DecimateQuestion::feature_angle)
      .def_rw("seconds", &DecimateQuestion::seconds, nb::arg().none())
      .def_rw("threads", &DecimateQuestion::threads)
      .def_rw("two_sided", &DecimateQuestion::two_sided)
      .def_rw("repair", &DecimateQuestion::repair)
      .def_rw("closed", &DecimateQuestion::closed);
  module.def(
      "decimate",
      [](const GivenMesh& mesh, const GivenCloud* cloud, const DecimateQuestion& question,
         const nb::object& progress) {
        return attended(progress, [&](Watch& watch) -> std::function<nb::object()> {
          auto made =
              std::make_shared<CertifiedMesh>(ArrayDecimation(mesh, cloud, question, watch).run());
          return [made] { return nb::cast(std::move(*made)); };
        });
      },
      nb::arg("mesh"), nb::arg("cloud").none(), nb::arg("question"), nb::arg("progress").none());
}

}  // namespace emax
