#include "tests/host/support/scanned_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <unordered_map>

#include "host/geometry/bounds.h"
#include "host/geometry/merge_vertices.h"
#include "host/surface/mesh_orientation.h"
#include "testbench/stimuli/random.h"

namespace emax::test {
namespace {

constexpr double kPi = std::numbers::pi;

// The grid of nu x nv cells over [0, nu] x [0, nv], placed by `at`.
template <class Place>
void add_grid(TriangleMesh& mesh, int nu, int nv, const Place& at) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i <= nu; ++i) {
    for (int j = 0; j <= nv; ++j) mesh.vertices.push_back(at(i, j));
  }
  const auto index = [&](int i, int j) {
    return first + static_cast<std::uint32_t>(i * (nv + 1) + j);
  };
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      const std::uint32_t a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1),
                          d = index(i, j + 1);
      // Diagonals in turn, so that no direction is preferred.
      if ((i + j) % 2 == 0) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
}

// A parallelogram from `corner`, outward by the right hand from u to v; sides of whole lengths.
void add_face(TriangleMesh& mesh, const Point& corner, const Point& u, const Point& v) {
  const int nu = static_cast<int>(std::lround(u.norm())),
            nv = static_cast<int>(std::lround(v.norm()));
  add_grid(mesh, nu, nv, [&](int i, int j) { return Point(corner + u * i / nu + v * j / nv); });
}

void add_box(TriangleMesh& mesh, const Point& low, const Point& high) {
  const Point size = high - low;
  const Point x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  add_face(mesh, low, y, x);
  add_face(mesh, low, z, y);
  add_face(mesh, low, x, z);
  add_face(mesh, high, -x, -y);
  add_face(mesh, high, -y, -z);
  add_face(mesh, high, -z, -x);
}

TriangleMesh sphere(double scale) {
  TriangleMesh mesh;  // a cube's grid, blown up
  const double half = std::floor(20 * scale);
  add_box(mesh, Point::Constant(-half), Point::Constant(half));
  for (Point& p : mesh.vertices) p = 25 * scale * p.normalized();
  return mesh;
}

TriangleMesh torus(double scale) {
  TriangleMesh mesh;
  const int around = static_cast<int>(160 * scale), across = static_cast<int>(64 * scale);
  add_grid(mesh, around, across, [&](int i, int j) {
    // The seam's vertices are to be equal bit for bit.
    const double u = 2 * kPi * (i % around) / around, v = 2 * kPi * (j % across) / across;
    const double r = scale * (25 + 10 * std::cos(v));
    return Point(r * std::cos(u), r * std::sin(u), scale * 10 * std::sin(v));
  });
  return mesh;
}

TriangleMesh sheet(double scale) {
  TriangleMesh mesh;
  const int nu = static_cast<int>(100 * scale), nv = static_cast<int>(80 * scale);
  add_grid(mesh, nu, nv, [&](int i, int j) {
    const double z = 4 * scale * std::sin(i / (8 * scale)) * std::cos(j / (10 * scale));
    return Point(i, j, z);
  });
  return mesh;
}

TriangleMesh slots(double scale) {
  TriangleMesh mesh;
  const double s = std::round(scale);
  const double length = 36 * s;
  // The profile of the U, extruded along z; sides are whole.
  const std::vector<Eigen::Vector2d> profile = {{0, 0},       {40 * s, 0}, {40 * s, 28 * s},
                                                {23, 28 * s}, {23, 8 * s}, {17, 8 * s},
                                                {17, 28 * s}, {0, 28 * s}};
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Eigen::Vector2d a = profile[i], b = profile[(i + 1) % profile.size()];
    add_face(mesh, Point(a.x(), a.y(), 0), Point(b.x() - a.x(), b.y() - a.y(), 0),
             Point(0, 0, length));
  }
  const auto caps = [&](double x0, double y0, double x1, double y1) {
    add_face(mesh, Point(x0, y0, 0), Point(0, y1 - y0, 0), Point(x1 - x0, 0, 0));
    add_face(mesh, Point(x0, y0, length), Point(x1 - x0, 0, 0), Point(0, y1 - y0, 0));
  };
  caps(0, 0, 17, 8 * s);
  caps(17, 0, 23, 8 * s);
  caps(23, 0, 40 * s, 8 * s);
  caps(0, 8 * s, 17, 28 * s);
  caps(23, 8 * s, 40 * s, 28 * s);
  add_box(mesh, Point(40 * s + 6, 0, 0), Point(40 * s + 14, 28 * s, length));
  return mesh;
}

// The directed edges that triangles would have on a hole's other side stay simple loops: balls are
// cut where the grid is regular.
void cut_ball(TriangleMesh& mesh, const Point& centre, double radius) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return ((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3 - centre).norm() <
           radius;
  });
}

double gaussian(Random& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.uniform(0, 1)));
  return radius * std::cos(2 * kPi * random.uniform(0, 1));
}

struct SurfacePoint {
  Point position, normal;
};

std::vector<SurfacePoint> sample(const TriangleMesh& mesh, double per_area, Random& random) {
  std::vector<SurfacePoint> points;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.view().corners(t);
    const Point cross = (b - a).cross(c - a);
    double expected = 0.5 * cross.norm() * per_area;
    for (; expected > random.uniform(0, 1); expected -= 1) {
      double u = random.uniform(0, 1), v = random.uniform(0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      points.push_back({a + u * (b - a) + v * (c - a), cross.normalized()});
    }
  }
  for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.below(i)]);
  return points;
}

// Points thinned until no two are nearer than `distance(from, to)` >= 1.
template <class Distance>
std::vector<Point> thinned(const std::vector<SurfacePoint>& candidates, double reach,
                           const Distance& distance) {
  std::unordered_map<std::uint64_t, std::vector<SurfacePoint>> cells;
  const auto key = [&](const Eigen::Vector3i& cell) {
    return static_cast<std::uint64_t>(cell.x() + (1 << 20)) << 42 |
           static_cast<std::uint64_t>(cell.y() + (1 << 20)) << 21 |
           static_cast<std::uint64_t>(cell.z() + (1 << 20));
  };
  std::vector<Point> kept;
  for (const SurfacePoint& candidate : candidates) {
    const Eigen::Vector3i home = (candidate.position / reach).array().floor().cast<int>();
    bool free = true;
    for (int n = 0; n < 27 && free; ++n) {
      const auto cell =
          cells.find(key(home + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (cell == cells.end()) continue;
      for (const SurfacePoint& other : cell->second) free = free && distance(candidate, other) >= 1;
    }
    if (!free) continue;
    cells[key(home)].push_back(candidate);
    kept.push_back(candidate.position);
  }
  return kept;
}

std::vector<Point> scanned_points(const TriangleMesh& mesh, Density density, Random& random) {
  constexpr double kCandidates = 12;  // of a point that is kept
  if (density == Density::kEven) {
    return thinned(sample(mesh, kCandidates, random), 1,
                   [](const auto& a, const auto& b) { return (a.position - b.position).norm(); });
  }
  const std::vector<SurfacePoint> dense = sample(mesh, 4 * kCandidates, random);
  if (density == Density::kLines) {
    // Lines cross the direction of least change of an oblique axis.
    const Point axis = Point(0.3, 0.5, 0.8).normalized();
    return thinned(dense, 2, [&](const auto& a, const auto& b) {
      const Point d = a.position - b.position;
      const Point along = b.normal.cross(axis).normalized();
      const double x = d.dot(along), rest = (d - x * along).squaredNorm();
      return std::sqrt(4 * x * x + rest / 4);
    });
  }
  const Bounds box = bounds_of(mesh.vertices);
  const auto apart = [&](const Point& p) {
    return 0.5 * std::pow(4.0, (p.x() - box.lower.x()) / (box.upper.x() - box.lower.x()));
  };
  return thinned(dense, 2, [&](const auto& a, const auto& b) {
    return (a.position - b.position).norm() / std::min(apart(a.position), apart(b.position));
  });
}

std::string_view name_of(Density density) {
  return density == Density::kEven ? "even" : density == Density::kGraded ? "graded" : "lines";
}

}  // namespace

TriangleMesh shape_surface(std::string_view shape, double scale) {
  TriangleMesh mesh;
  if (shape == "sphere") mesh = sphere(scale);
  if (shape == "torus") mesh = torus(scale);
  if (shape == "box") add_box(mesh, {0, 0, 0}, Point(50, 40, 30) * std::round(scale));
  if (shape == "sheet") mesh = sheet(scale);
  if (shape == "slots") mesh = slots(scale);
  if (mesh.triangles.empty()) throw std::invalid_argument("no shape " + std::string(shape));
  merge_equal_vertices(mesh.vertices, mesh.triangles);
  return mesh;
}

ScanOfShape scan_of_shape(const ScanSettings& settings) {
  ScanOfShape scan;
  scan.name = std::string(settings.shape) + "-" + std::string(name_of(settings.density)) + "-" +
              std::to_string(settings.noise).substr(0, 4) + (settings.holes ? "-holes" : "") +
              (settings.outliers > 0 ? "-outliers" : "");
  scan.surface = shape_surface(settings.shape, settings.scale);
  if (settings.holes) {
    const Bounds box = bounds_of(scan.surface.vertices);
    const Point middle = box.midpoint();
    const auto nearest = [&](const Point& p) {
      return *std::ranges::min_element(scan.surface.vertices, {},
                                       [&](const Point& v) { return (v - p).norm(); });
    };
    cut_ball(scan.surface, nearest({middle.x(), middle.y(), box.upper.z()}), 7);
    cut_ball(scan.surface, nearest({box.lower.x(), middle.y(), middle.z()}), 7);
    drop_unused(scan.surface);
  }
  Random random(named_seed(settings.shape, settings.seed));
  scan.points = scanned_points(scan.surface, settings.density, random);
  for (Point& p : scan.points) {
    for (int axis = 0; axis < 3; ++axis) p[axis] += settings.noise * gaussian(random);
  }
  scan.outliers =
      static_cast<std::size_t>(settings.outliers * static_cast<double>(scan.points.size()));
  const Bounds box = bounds_of(scan.points);
  for (std::size_t i = 0; i < scan.outliers; ++i) {
    scan.points.push_back(box.midpoint() +
                          Point(0.6 * random.point(-1, 1).cwiseProduct(box.upper - box.lower)));
  }
  return scan;
}

std::vector<Point> points_on(const TriangleMesh& mesh, double per_area, std::uint64_t seed) {
  Random random(seed);
  std::vector<Point> points;
  for (const SurfacePoint& p : sample(mesh, per_area, random)) points.push_back(p.position);
  return points;
}

}  // namespace emax::test
