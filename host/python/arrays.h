#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <span>
#include <string>
#include <vector>

#include "host/app/scan.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

// What comes from Python: three numbers a row, in C order. Rows are copied once, 24 bytes a point.
using PointRows = nanobind::ndarray<const double, nanobind::shape<-1, 3>, nanobind::c_contig,
                                    nanobind::device::cpu>;
using IndexRows = nanobind::ndarray<const std::uint32_t, nanobind::shape<-1, 3>, nanobind::c_contig,
                                    nanobind::device::cpu>;

// What goes to Python: views of memory that `owner` keeps alive. They cannot be written to, as
// certificates speak of these bits.
using PointView = nanobind::ndarray<nanobind::numpy, const double, nanobind::shape<-1, 3>>;
using IndexView = nanobind::ndarray<nanobind::numpy, const std::uint32_t, nanobind::shape<-1, 3>>;
using NumberView = nanobind::ndarray<nanobind::numpy, const double, nanobind::ndim<1>>;
PointView view_of(std::span<const Point> points, nanobind::handle owner);
IndexView view_of(std::span<const Triangle> triangles, nanobind::handle owner);
NumberView view_of(std::span<const double> numbers, nanobind::handle owner);

// A mesh of a file or of arrays.
struct GivenMesh {
  TriangleMesh mesh;
  std::string file, sha256;  // empty: of arrays
};
// Throws Error for indices out of range and numbers that are not finite.
GivenMesh mesh_of_arrays(PointRows vertices, IndexRows faces);
GivenMesh mesh_of_file(const std::string& file);

// A cloud of a file or of arrays.
struct GivenCloud {
  Scan scan;
  std::string sha256;  // empty: of arrays
  CloudReadOptions reading;
};
// Throws Error as check_cloud().
GivenCloud cloud_of_array(PointRows points);
GivenCloud cloud_of_file(const std::string& file, bool skip_invalid);

// The bytes of the file that stands for arrays: PLY, as emax writes it.
std::string bytes_of(const std::vector<Point>& points, const std::vector<Triangle>& triangles = {});

void bind_arrays(nanobind::module_& module);

}  // namespace emax
