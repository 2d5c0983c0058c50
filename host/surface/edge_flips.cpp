#include "host/surface/edge_flips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "host/geometry/box_pairs.h"
#include "host/geometry/edge_sides.h"
#include "host/geometry/exact_predicates.h"
#include "host/geometry/triangle_pair.h"

namespace emax {
namespace {

constexpr std::uint32_t kNoSide = ~0u;
// A flip must reduce the turn of the edges around it by this ratio of their length. A smaller gain
// may be rounding, and the flips would not end.
constexpr double kGain = 1e-9;

double turn_cost(const Point& from, const Point& to, const Point& normal, const Point& other) {
  return (to - from).norm() * (normal - other).norm();
}

// A side has the number 3 * triangle + place of its first vertex. Edges of triangles with a locked
// vertex are not flipped.
class Flips {
 public:
  Flips(TriangleMesh& mesh, const std::vector<std::uint8_t>& locked)
      : mesh_(mesh),
        locked_(locked),
        twin_(3 * mesh.triangles.size(), kNoSide),
        queued_(twin_.size(), 1),
        changed_(mesh.triangles.size(), 0) {
    EdgeSides(mesh.view()).for_each_edge([&](std::span<const EdgeSide> sides) {
      if (sides.size() != 2 || sides[0].ascends == sides[1].ascends) return;
      const auto side = [](const EdgeSide& s) {
        return static_cast<std::uint32_t>(s.ascends ? s.lower_corner : s.upper_corner);
      };
      twin_[side(sides[0])] = side(sides[1]);
      twin_[side(sides[1])] = side(sides[0]);
    });
  }

  std::size_t run() {
    std::vector<std::uint32_t> now, next(twin_.size());
    for (std::uint32_t s = 0; s < next.size(); ++s) next[s] = s;
    std::size_t flips = 0;
    while (!next.empty()) {
      now.swap(next);
      next.clear();
      for (const std::uint32_t side : now) {
        queued_[side] = 0;
        if (!worth(side)) continue;
        flip(side);
        ++flips;
        for (const std::uint32_t t : {side / 3, twin_[side] / 3}) {
          for (std::uint32_t s = 3 * t; s < 3 * t + 3; ++s) {
            queue(s, next);
            if (twin_[s] == kNoSide) continue;
            queue(following(twin_[s]), next);
            queue(following(following(twin_[s])), next);
          }
        }
      }
    }
    return flips;
  }

  // Whether each triangle took part in a flip.
  const std::vector<std::uint8_t>& changed() const { return changed_; }

 private:
  static std::uint32_t following(std::uint32_t s) { return s - s % 3 + (s + 1) % 3; }
  std::uint32_t from(std::uint32_t s) const { return mesh_.triangles[s / 3][s % 3]; }
  const Point& at(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }

  void queue(std::uint32_t s, std::vector<std::uint32_t>& next) {
    if (twin_[s] == kNoSide || queued_[s] != 0) return;
    queued_[s] = 1;
    next.push_back(s);
  }

  Point normal(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return (at(b) - at(a)).cross(at(c) - at(a));
  }
  Point unit_normal(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return normal(a, b, c).normalized();
  }

  double cost(std::uint32_t a, std::uint32_t b, const Point& n, const Point& m) const {
    return turn_cost(at(a), at(b), n, m);
  }
  // The cost of side s if its own triangle had the normal `n`.
  double cost_outside(std::uint32_t s, const Point& n) const {
    if (twin_[s] == kNoSide) return 0;
    const Triangle& t = mesh_.triangles[twin_[s] / 3];
    return cost(from(s), from(following(s)), n, unit_normal(t[0], t[1], t[2]));
  }

  // Total length of the five edges of the two triangles at a side and its twin.
  double length(std::uint32_t s, std::uint32_t t) const {
    double sum = 0;
    for (const std::uint32_t side :
         {s, following(s), following(following(s)), following(t), following(following(t))}) {
      sum += (at(from(following(side))) - at(from(side))).norm();
    }
    return sum;
  }

  // Height over the longest side.
  double thickness(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const double longest = std::max({(at(b) - at(a)).squaredNorm(), (at(c) - at(b)).squaredNorm(),
                                     (at(a) - at(c)).squaredNorm()});
    return normal(a, b, c).norm() / longest;
  }

  bool worth(std::uint32_t s) const {
    const std::uint32_t t = twin_[s];
    if (t == kNoSide) return false;
    const std::uint32_t bc = following(s), ca = following(bc), ad = following(t),
                        db = following(ad);
    const std::uint32_t a = from(s), b = from(t), c = from(ca), d = from(db);
    if (c == d || locked_[a] + locked_[b] + locked_[c] + locked_[d] > 0) return false;
    const Point n = unit_normal(a, b, c), m = unit_normal(b, a, d);
    const Point p = unit_normal(a, d, c), q = unit_normal(d, b, c);
    if (!(p.dot(n + m) > 0) || !(q.dot(n + m) > 0)) return false;
    const double before = cost(a, b, n, m) + cost_outside(bc, n) + cost_outside(ca, n) +
                          cost_outside(ad, m) + cost_outside(db, m);
    const double after = cost(c, d, p, q) + cost_outside(ca, p) + cost_outside(ad, p) +
                         cost_outside(bc, q) + cost_outside(db, q);
    if (!(before - after > kGain * length(s, t))) return false;
    const double thin = std::min(thickness(a, d, c), thickness(d, b, c));
    if (thin < kThinnest && thin < std::min(thickness(a, b, c), thickness(b, a, d))) return false;
    if (collinear(at(a), at(d), at(c)) || collinear(at(d), at(b), at(c))) return false;
    return !joined(ca, d);
  }

  // Whether an edge runs from the vertex where side `s` begins to `other`.
  bool joined(std::uint32_t s, std::uint32_t other) const {
    const auto has = [&](std::uint32_t side) {
      return from(following(side)) == other || from(following(following(side))) == other;
    };
    std::uint32_t side = s;
    do {
      if (has(side)) return true;
      side = twin_[following(following(side))];
    } while (side != kNoSide && side != s);
    if (side == s) return false;
    for (side = s; twin_[side] != kNoSide;) {  // in the other direction, from the border
      side = following(twin_[side]);
      if (has(side)) return true;
    }
    return false;
  }

  void join(std::uint32_t s, std::uint32_t t) {
    twin_[s] = t;
    if (t != kNoSide) twin_[t] = s;
  }

  // Triangles (a, b, c) and (b, a, d) become (d, c, a) and (c, d, b). Sides s and t are the edge
  // between them.
  void flip(std::uint32_t s) {
    const std::uint32_t t = twin_[s];
    const std::uint32_t bc = following(s), ca = following(bc), ad = following(t),
                        db = following(ad);
    const std::uint32_t a = from(s), b = from(t), c = from(ca), d = from(db);
    const std::array<std::uint32_t, 4> outside = {twin_[ca], twin_[ad], twin_[bc], twin_[db]};
    changed_[s / 3] = changed_[t / 3] = 1;
    mesh_.triangles[s / 3][s % 3] = d;
    mesh_.triangles[s / 3][bc % 3] = c;
    mesh_.triangles[s / 3][ca % 3] = a;
    mesh_.triangles[t / 3][t % 3] = c;
    mesh_.triangles[t / 3][ad % 3] = d;
    mesh_.triangles[t / 3][db % 3] = b;
    join(bc, outside[0]);  // c to a
    join(ca, outside[1]);  // a to d
    join(ad, outside[3]);  // d to b
    join(db, outside[2]);  // b to c
  }

  TriangleMesh& mesh_;
  const std::vector<std::uint8_t>& locked_;  // of the vertices
  std::vector<std::uint32_t> twin_;
  std::vector<std::uint8_t> queued_;   // of the sides
  std::vector<std::uint8_t> changed_;  // of the triangles
};

// Locks the vertices of changed triangles that intersect others; returns false if none does.
bool lock_intersecting(const TriangleMesh& mesh, const std::vector<std::uint8_t>& changed,
                       std::vector<std::uint8_t>& locked) {
  bool found = false;
  BoxPairs(triangle_boxes(mesh.view())).for_each([&](std::uint32_t i, std::uint32_t j) {
    if (changed[i] + changed[j] == 0 || !intersect_beyond_shared(mesh.view(), i, j)) return;
    found = true;
    for (const std::uint32_t t : {i, j}) {
      if (changed[t] == 0) continue;
      for (const std::uint32_t v : mesh.triangles[t]) locked[v] = 1;
    }
  });
  return found;
}

}  // namespace

std::size_t flip_edges(TriangleMesh& mesh) {
  std::vector<std::uint8_t> locked(mesh.vertices.size(), 0);
  // Every round locks new vertices: those of triangles that a flip made.
  for (;;) {
    TriangleMesh flipped = mesh;
    Flips flips(flipped, locked);
    const std::size_t count = flips.run();
    if (lock_intersecting(flipped, flips.changed(), locked)) continue;
    mesh = std::move(flipped);
    return count;
  }
}

double total_turn(const TriangleMesh& mesh) {
  const auto normal = [&](const EdgeSide& side) {
    const auto [a, b, c] = mesh.view().corners(side.lower_corner / 3);
    return Point((b - a).cross(c - a).normalized());
  };
  double sum = 0;
  EdgeSides(mesh.view()).for_each_edge([&](std::span<const EdgeSide> sides) {
    if (sides.size() != 2) return;
    const std::uint32_t lower =
        mesh.triangles[sides[0].lower_corner / 3][sides[0].lower_corner % 3];
    sum += turn_cost(mesh.vertices[lower], mesh.vertices[sides[0].upper], normal(sides[0]),
                     normal(sides[1]));
  });
  return sum;
}

}  // namespace emax
