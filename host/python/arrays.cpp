#include "host/python/arrays.h"

#include <nanobind/stl/string.h>

#include "host/files/mesh_file.h"
#include "host/files/sha256.h"
#include "host/geometry/bounds.h"
#include "sw_model/base/public_arguments.h"

namespace nb = nanobind;

namespace emax {
namespace {

static_assert(sizeof(Point) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(std::uint32_t),
              "rows of arrays are points and triangles as they lie in memory");

constexpr const char* kArray = "the given array";

}  // namespace

PointView view_of(std::span<const Point> points, nb::handle owner) {
  return PointView(points.empty() ? nullptr : points.data()->data(), {points.size(), 3}, owner);
}

IndexView view_of(std::span<const Triangle> triangles, nb::handle owner) {
  return IndexView(triangles.empty() ? nullptr : triangles.data()->data(), {triangles.size(), 3},
                   owner);
}

NumberView view_of(std::span<const double> numbers, nb::handle owner) {
  return NumberView(numbers.data(), {numbers.size()}, owner);
}

GivenMesh mesh_of_arrays(PointRows vertices, IndexRows faces) {
  OwnedSurface surface =
      checked_surface({{vertices.data(), vertices.size()}, {faces.data(), faces.size()}}, "mesh");
  return {{std::move(surface.vertices), std::move(surface.triangles)}, "", ""};
}

GivenMesh mesh_of_file(const std::string& file) {
  return {read_mesh(file), file, sha256_of_input(file)};
}

GivenCloud cloud_of_array(PointRows points) {
  GivenCloud given;
  given.scan.path = kArray;
  given.scan.cloud.points = checked_points({points.data(), points.size()}, "cloud");
  check_cloud(given.scan.cloud, "cloud");
  given.scan.width = bounds_of(given.scan.cloud.points).width();
  return given;
}

GivenCloud cloud_of_file(const std::string& file, bool skip_invalid) {
  GivenCloud given;
  given.reading.skip_invalid = skip_invalid;
  given.scan = read_scan(file, given.reading);
  given.sha256 = sha256_of_input(file);
  return given;
}

std::string bytes_of(const std::vector<Point>& points, const std::vector<Triangle>& triangles) {
  return mesh_bytes({points, triangles}, MeshFormat::kPly);
}

void bind_arrays(nb::module_& module) {
  nb::class_<GivenMesh>(module, "GivenMesh")
      .def_prop_ro(
          "vertices",
          [](nb::handle_t<GivenMesh> self) {
            return view_of(nb::cast<GivenMesh&>(self).mesh.vertices, self);
          },
          nb::rv_policy::reference)
      .def_prop_ro(
          "faces",
          [](nb::handle_t<GivenMesh> self) {
            return view_of(nb::cast<GivenMesh&>(self).mesh.triangles, self);
          },
          nb::rv_policy::reference)
      .def_ro("file", &GivenMesh::file);
  nb::class_<GivenCloud>(module, "GivenCloud")
      .def_prop_ro(
          "points",
          [](nb::handle_t<GivenCloud> self) {
            return view_of(nb::cast<GivenCloud&>(self).scan.cloud.points, self);
          },
          nb::rv_policy::reference)
      .def_prop_ro("file",
                   [](const GivenCloud& self) {
                     return self.sha256.empty() ? std::string() : self.scan.path.string();
                   })
      .def("ply_bytes", [](const GivenCloud& self) {
        const std::string bytes = bytes_of(self.scan.cloud.points);
        return nb::bytes(bytes.data(), bytes.size());
      });
  module.def(
      "is_surface", [](const std::string& file) { return is_surface(file); }, nb::arg("file"));
  module.def("mesh_of_arrays", &mesh_of_arrays, nb::arg("vertices"), nb::arg("faces"));
  module.def("mesh_of_file", &mesh_of_file, nb::arg("file"),
             nb::call_guard<nb::gil_scoped_release>());
  module.def("cloud_of_array", &cloud_of_array, nb::arg("points"));
  module.def("cloud_of_file", &cloud_of_file, nb::arg("file"), nb::arg("skip_invalid"),
             nb::call_guard<nb::gil_scoped_release>());
}

}  // namespace emax
