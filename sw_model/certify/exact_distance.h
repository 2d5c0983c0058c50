#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// A proven interval that holds an exact distance. Its width is a few units in the last place of
// |P - V| plus the triangle's size, wherever the coordinates lie.
struct DistanceBounds {
  double lower, upper;
};

// Distance from a point to a triangle of any shape: slivers, segments and single points too.
//
// Shares nothing with the kernel: no frame, no rotation, binary64 throughout. It works on V_i - P,
// so rounding scales with the distance and not with the coordinates.
//   upper: the distance to a convex combination of the corners, which is a point of the triangle
//          whatever the weights, plus the rounding of the computation (docs/numerics.md).
//   lower: for any direction n, |n| <= 1, the triangle is at least min_i (V_i - P).n away.
// Coordinates finite and below 1e150. Throws std::logic_error while flush mode is on. O(1).
DistanceBounds point_triangle_distance(const Point& p, const std::array<Point, 3>& corners);

// Throws Error for a mesh without triangles or with a vertex that is not finite or beyond 1e150;
// std::invalid_argument for an index out of range.
void require_measurable(MeshView mesh);

// The lower end of the distance from `p` to a mesh whose least upper end is `upper`, of the
// triangles of a part of it. The least of all parts bounds the distance to the whole. O(triangles).
double lower_end(const Point& p, MeshView part, double upper);

// A mesh as the oracle searches it: a median-split box tree in binary64. Copies what it needs.
class ExactMesh {
 public:
  struct Nearest {
    DistanceBounds distance;
    std::uint32_t triangle;
  };

  // Throws as require_measurable does. O(n log n).
  explicit ExactMesh(MeshView mesh);

  // `upper` is the least upper bound over all triangles, the same to the bit as without the tree,
  // and `triangle` the lowest index that attains it. The search may stop at any triangle within
  // `enough`; then `upper` <= enough is all that is promised, and `lower` is 0. A triangle known to
  // be near, `seed`, makes it faster and changes nothing else.
  Nearest nearest(const Point& p, double enough = -std::numeric_limits<double>::infinity(),
                  std::uint32_t seed = ~0u) const;

  DistanceBounds distance(const Point& p) const { return nearest(p).distance; }

  // What nearest() gives for a mesh of which this is a part, where `least` is what it gives for all
  // parts before (of none: infinite): `upper` is the least of both, and the triangle, if it is of
  // this part, is numbered from `first` on. `lower` is not changed.
  void lower(const Point& p, std::uint32_t first, Nearest& least) const;

  std::array<Point, 3> corners(std::uint32_t triangle) const {
    return corners_at(place_of_[triangle]);
  }

  // Bounds of the distance to one triangle of the mesh.
  DistanceBounds distance_to(const Point& p, std::uint32_t triangle) const;

  // At least the distance to one triangle, for a quarter of the cost of distance_to, and mostly
  // more than it by a few roundings alone.
  double upper_to(const Point& p, std::uint32_t triangle) const;

  // A triangle that is nearest to p in plain binary64, which proves nothing: where several are
  // about equally far, any of them. It costs a third of nearest(). No seed need be near.
  std::uint32_t likely_nearest(const Point& p, std::uint32_t seed = 0) const;

  // distance_to(p, triangle).upper <= limit, mostly without computing that distance: a corner or
  // another point of the triangle that is well within the limit is enough.
  bool is_within(const Point& p, std::uint32_t triangle, double limit) const;

 private:
  struct Node {
    Point low, high;
    std::uint32_t begin, end;  // in a leaf: its triangles
    std::uint32_t right;       // the right child, 0 in a leaf; the left child follows its parent
  };

  struct Centre {
    Point at;
    std::uint32_t triangle;
  };
  std::uint32_t build(MeshView mesh, std::uint32_t begin, std::uint32_t end,
                      std::vector<Centre>& centres);
  void take_triangles(MeshView mesh);
  std::array<Point, 3> corners_at(std::uint32_t place) const {
    const Triangle& t = triangles_[place];
    return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
  }
  Nearest search(const Point& p, double enough, Nearest best) const;
  double likely_squared(const Point& p, std::uint32_t place) const;
  struct Quick {
    double squared, size;
  };
  std::optional<Quick> quick(const Point& p, std::uint32_t place) const;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;     // the triangle at each place in the leaves
  std::vector<std::uint32_t> place_of_;  // the place of each triangle
  std::vector<Triangle> triangles_;      // at each place
  std::vector<Point> vertices_;          // in the order of the places
  std::vector<std::uint8_t> is_sliver_;  // at each place: plain arithmetic may be far off
  double scale_ = 1, unscale_ = 1;       // keep fourth powers of lengths representable
};

}  // namespace emax
