#include "host/geometry/polygon_triangulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <vector>

namespace emax {
namespace {

std::vector<std::uint32_t> corners_of(std::span<const Triangle> fan) {
  std::vector<std::uint32_t> corners = {fan[0][0], fan[0][1]};
  for (const Triangle& t : fan) corners.push_back(t[2]);
  return corners;
}

// Twice the polygon's area as a vector.
Point newell_normal(std::span<const std::uint32_t> corners, std::span<const Point> vertices) {
  Point sum = Point::Zero();
  const Point& origin = vertices[corners[0]];
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += (vertices[corners[i]] - origin).cross(vertices[corners[i + 1]] - origin);
  }
  return sum;
}

class Ears {
 public:
  Ears(std::vector<std::uint32_t> corners, std::span<const Point> vertices)
      : corners_(std::move(corners)), vertices_(vertices) {
    normal_ = newell_normal(corners_, vertices_);
  }

  // Returns nothing if no ear is left.
  std::vector<Triangle> cut() {
    std::vector<Triangle> triangles;
    while (corners_.size() > 3) {
      const std::size_t ear = shortest_ear();
      if (ear == corners_.size()) return {};
      triangles.push_back({at(ear + corners_.size() - 1), at(ear), at(ear + 1)});
      corners_.erase(corners_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    if (!(turn(at(0), at(1), at(2)) > 0)) return {};
    triangles.push_back({at(0), at(1), at(2)});
    return triangles;
  }

 private:
  std::uint32_t at(std::size_t i) const { return corners_[i % corners_.size()]; }

  // Twice the area of a triangle in the projection, positive where it faces the polygon's way.
  double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return normal_.dot((vertices_[b] - vertices_[a]).cross(vertices_[c] - vertices_[a]));
  }

  std::size_t shortest_ear() const {
    std::size_t best = corners_.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const std::uint32_t a = at(i + corners_.size() - 1), b = at(i), c = at(i + 1);
      const double length = (vertices_[c] - vertices_[a]).squaredNorm();
      if (length >= least || !(turn(a, b, c) > 0)) continue;
      const bool free = std::ranges::none_of(corners_, [&](std::uint32_t p) {
        return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
               turn(c, a, p) >= 0;
      });
      if (!free) continue;
      least = length;
      best = i;
    }
    return best;
  }

  std::vector<std::uint32_t> corners_;
  std::span<const Point> vertices_;
  Point normal_;
};

bool faces_one_way(std::span<const Triangle> fan, std::span<const Point> vertices) {
  const Point normal = newell_normal(corners_of(fan), vertices);
  return std::ranges::all_of(fan, [&](const Triangle& t) {
    return normal.dot((vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]])) > 0;
  });
}

}  // namespace

void triangulate(std::span<Triangle> fan, std::span<const Point> vertices) {
  if (faces_one_way(fan, vertices)) return;
  const std::vector<Triangle> cut = Ears(corners_of(fan), vertices).cut();
  if (cut.size() == fan.size()) std::ranges::copy(cut, fan.begin());
}

}  // namespace emax
