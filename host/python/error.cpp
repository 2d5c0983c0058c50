#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <limits>

#include "host/app/error_findings.h"
#include "host/geometry/merge_vertices.h"
#include "host/python/arrays.h"
#include "host/python/attended.h"
#include "host/python/bindings.h"

namespace nb = nanobind;

namespace emax {
namespace {

// What `emax error --json` writes, and the distance of every point.
struct Errors {
  std::string json;
  std::vector<double> distances;
  std::string exceeding;
};

std::optional<ErrorReference> reference_of(const GivenCloud& cloud, const GivenMesh* surface,
                                           const GivenCloud* points, bool two_sided) {
  using Kind = ErrorReference::Kind;
  if (!two_sided) return std::nullopt;
  if (surface != nullptr) {
    return ErrorReference{surface->file.empty() ? "reference" : surface->file, Kind::kSurface,
                          surface->mesh};
  }
  const GivenCloud& other = points != nullptr ? *points : cloud;
  return cloud_reference(other.scan.path, points != nullptr ? Kind::kCloud : Kind::kScan,
                         other.scan.cloud.points);
}

}  // namespace

void bind_error(nb::module_& module) {
  nb::class_<Errors>(module, "Errors")
      .def_ro("json", &Errors::json)
      .def_ro("exceeding", &Errors::exceeding)
      .def_prop_ro(
          "distances",
          [](nb::handle_t<Errors> self) {
            return view_of(nb::cast<Errors&>(self).distances, self);
          },
          nb::rv_policy::reference);
  module.def(
      "error",
      [](const GivenCloud& cloud, const GivenMesh& given, const std::string& max_error,
         bool two_sided, const GivenMesh* reference_mesh, const GivenCloud* reference_cloud,
         const std::vector<double>& quantiles, std::size_t worst, const std::string& excluded) {
        return attended(nb::none(), [&](Watch& watch) -> std::function<nb::object()> {
          ErrorQuestion question;
          question.excluded_share = parse_share(excluded);
          question.quantiles = quantiles;
          question.worst = worst;
          question.memory = std::numeric_limits<std::uint64_t>::max();  // for all distances
          question.interrupted = [&] { return watch.stopped(); };
          if (!max_error.empty()) {
            question.tolerance =
                parse_tolerance(max_error, "max_error").in_unit_of(cloud.scan.unit, "max_error");
          }
          TriangleMesh mesh = given.mesh;
          drop_unused_vertices(mesh.vertices, mesh.triangles);
          ErrorFindings found = find_errors(
              MeasuredMesh(std::move(mesh)), ScanPieces(cloud.scan),
              reference_of(cloud, reference_mesh, reference_cloud, two_sided), question);
          auto errors = std::make_shared<Errors>();
          errors->json = to_json_text(report_of(found, cloud.scan));
          if (found.errors.limit) errors->exceeding = found.exceeding();
          errors->distances = std::move(found.distances);
          return [errors] { return nb::cast(std::move(*errors)); };
        });
      },
      nb::arg("cloud"), nb::arg("mesh"), nb::arg("max_error"), nb::arg("two_sided"),
      nb::arg("reference_mesh").none(), nb::arg("reference_cloud").none(), nb::arg("quantiles"),
      nb::arg("worst"), nb::arg("exclude_outliers"));
}

}  // namespace emax
