#include "host/report/surface_samples.h"

#include <Eigen/Geometry>
#include <cmath>

namespace emax {
namespace {

// Roberts' R2 sequence: multiples, modulo 1, of the inverse powers of the plastic number.
constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;

double fraction(double x) { return x - std::floor(x); }

Point on_triangle(const std::array<Point, 3>& corners, std::size_t i) {
  double u = fraction(kFirst * static_cast<double>(i) + 0.5);
  double v = fraction(kSecond * static_cast<double>(i) + 0.5);
  if (u + v > 1) {  // mirrored from the other half of the parallelogram
    u = 1 - u;
    v = 1 - v;
  }
  return corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
}

}  // namespace

std::vector<Point> surface_samples(MeshView mesh, std::size_t count) {
  std::vector<double> passed;  // area up to and including each triangle
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto v = mesh.corners(t);
    area += (v[1] - v[0]).cross(v[2] - v[0]).norm() / 2;
    passed.push_back(area);
  }
  if (!(area > 0)) return {mesh.vertices.begin(), mesh.vertices.end()};
  std::vector<Point> samples;
  samples.reserve(count);
  std::size_t t = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(count) * area;
    while (t + 1 < passed.size() && passed[t] < at) ++t;
    samples.push_back(on_triangle(mesh.corners(t), i));
  }
  return samples;
}

}  // namespace emax
