#include "tests/host/features/clouds.h"

#include <cmath>
#include <numbers>

namespace emax::test {

double gaussian(Random& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.uniform(0, 1)));
  return radius * std::cos(2 * std::numbers::pi * random.uniform(0, 1));
}

Plane Patch::plane() const {
  const Point normal = canonical_sign(u.cross(v).normalized());
  return {normal, normal.dot(corner)};
}

void scan_patch(const Patch& patch, std::size_t points, double noise, Random& random,
                std::vector<Point>& cloud) {
  const Point normal = patch.plane().normal;
  for (std::size_t i = 0; i < points; ++i) {
    const double s = random.uniform(0, 1), t = random.uniform(0, 1);
    cloud.emplace_back(patch.corner + s * patch.u + t * patch.v +
                       noise * gaussian(random) * normal);
  }
}

std::vector<Patch> sides_of_box(const Point& lower, const Point& upper) {
  const Point size = upper - lower;
  const Point x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  return {{lower, x, y},   {lower, x, z},   {lower, y, z},
          {upper, -x, -y}, {upper, -x, -z}, {upper, -y, -z}};
}

void scan_cylinder(const Cylinder& cylinder, double length, double angle, std::size_t points,
                   double noise, Random& random, std::vector<Point>& cloud) {
  const Point u = cylinder.axis.unitOrthogonal(), v = cylinder.axis.cross(u);
  for (std::size_t i = 0; i < points; ++i) {
    const double turned = angle * random.uniform(0, 1),
                 along = length * (random.uniform(0, 1) - 0.5);
    const double radius = cylinder.radius + noise * gaussian(random);
    cloud.emplace_back(cylinder.centre + along * cylinder.axis +
                       radius * (std::cos(turned) * u + std::sin(turned) * v));
  }
}

void scan_sphere(const Sphere& sphere, std::size_t points, double noise, Random& random,
                 std::vector<Point>& cloud) {
  for (std::size_t i = 0; i < points; ++i) {
    Point direction;
    for (int k = 0; k < 3; ++k) direction[k] = gaussian(random);
    cloud.emplace_back(sphere.centre +
                       (sphere.radius + noise * gaussian(random)) * direction.normalized());
  }
}

}  // namespace emax::test
