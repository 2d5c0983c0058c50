#include "host/decimate/triangle_sheet.h"

#include <Eigen/Geometry>

namespace emax {

TrianglePlane::TrianglePlane(const std::array<Point, 3>& c) : origin(c[0]) {
  along = (c[1] - c[0]).normalized();
  normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  across = normal.cross(along);
  for (std::size_t i = 0; i < 3; ++i) corners[i] = project(c[i]);
  for (std::size_t i = 0; i < 3; ++i) {
    const PlanarCorner& from = corners[i];
    const PlanarCorner& to = corners[(i + 1) % 3];
    // The direction to the left of the side.
    const double u = to.y - from.y, v = to.z - from.z;
    const double length = std::sqrt(u * u + v * v);
    line[i] = {-v / length, u / length, 0};
    line[i][2] = -(line[i][0] * from.y + line[i][1] * from.z);
  }
}

// Keeps the side of a line on which `inside` is not negative.
template <class Side>
void PartOverTriangle::cut(const Side& inside) {
  clipped_.clear();
  for (std::size_t i = 0; i < part_.size(); ++i) {
    const PlanarCorner& a = part_[i];
    const PlanarCorner& b = part_[(i + 1) % part_.size()];
    const double at_a = inside(a), at_b = inside(b);
    if (at_a >= 0) clipped_.push_back(a);
    if ((at_a < 0) == (at_b < 0)) continue;
    const double s = at_a / (at_a - at_b);
    clipped_.push_back(
        {a.y + s * (b.y - a.y), a.z + s * (b.z - a.z), a.height + s * (b.height - a.height)});
  }
  part_.swap(clipped_);
}

void PartOverTriangle::clip(const TrianglePlane& plane, const std::array<PlanarCorner, 3>& r,
                            const std::array<unsigned, 3>& beyond) {
  part_.assign(r.begin(), r.end());
  const unsigned cutting = beyond[0] | beyond[1] | beyond[2];
  for (unsigned side = 0; side < 3 && !part_.empty(); ++side) {
    if ((cutting >> side & 1) == 0) continue;
    cut([&](const PlanarCorner& c) { return plane.inside(side, c); });
  }
}

void PartOverTriangle::shadow(const TrianglePlane& plane, const PlanarCorner& a,
                              const PlanarCorner& b) {
  const auto left_of = [](const PlanarCorner& from, const PlanarCorner& to, const PlanarCorner& c) {
    return (to.y - from.y) * (c.z - from.z) - (to.z - from.z) * (c.y - from.y);
  };
  const PlanarCorner middle = plane.middle();
  part_.clear();
  if (!(left_of(a, b, middle) > 0)) return;
  part_.assign(plane.corners.begin(), plane.corners.end());
  cut([&](const PlanarCorner& c) { return -left_of(a, b, c); });
  cut([&](const PlanarCorner& c) { return left_of(middle, a, c); });
  cut([&](const PlanarCorner& c) { return -left_of(middle, b, c); });
}

}  // namespace emax
