#include "host/decimate/back_bound.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/decimate/local_distance.h"
#include "host/decimate/spatial_order.h"

namespace emax {
namespace {

constexpr int kMostSteps = 64;                        // of the walk to the centroid
constexpr double kTouch = 1e-13, kRoundings = 1e-12;  // of the area of T
constexpr double kSteep = 1e-12;
constexpr int kMostPieces = 160;  // that one triangle may be halved into

}  // namespace

// The plane of a triangle, its corners in it and the sides as lines that are positive inside.
struct BackBound::Plane {
  explicit Plane(const std::array<Point, 3>& c) : origin(c[0]) {
    along = (c[1] - c[0]).normalized();
    normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    across = normal.cross(along);
    for (std::size_t i = 0; i < 3; ++i) corners[i] = project(c[i]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner& from = corners[i];
      const Corner& to = corners[(i + 1) % 3];
      // Across, to the left of the side.
      const double u = to.y - from.y, v = to.z - from.z;
      const double length = std::sqrt(u * u + v * v);
      line[i] = {-v / length, u / length, 0};
      line[i][2] = -(line[i][0] * from.y + line[i][1] * from.z);
      longest = std::max(longest, length);
    }
    area = 0.5 * corners[1].y * corners[2].z;
  }
  // y along the first side, z across it.
  Corner project(const Point& p) const {
    const Point q = p - origin;
    return {along.dot(q), across.dot(q), normal.dot(q)};
  }
  Point lift(const Corner& c) const { return origin + c.y * along + c.z * across; }
  double inside(std::size_t side, const Corner& c) const {
    return line[side][0] * c.y + line[side][1] * c.z + line[side][2];
  }
  // The sides that a corner is beyond.
  unsigned beyond(const Corner& c) const {
    unsigned sides = 0;
    for (unsigned side = 0; side < 3; ++side) {
      if (inside(side, c) < 0) sides |= 1u << side;
    }
    return sides;
  }
  // Whether T reaches to the right of the line from a to b.
  bool reaches_over(const Corner& a, const Corner& b) const {
    return std::ranges::any_of(corners, [&](const Corner& c) {
      return (b.y - a.y) * (c.z - a.z) < (b.z - a.z) * (c.y - a.y);
    });
  }

  Point origin, along, across, normal;
  std::array<Corner, 3> corners;
  double area, longest = 0;
  std::array<std::array<double, 3>, 3> line;
};

BackBound::BackBound(const TriangleMesh& reference, double limit)
    : reference_(spatially_ordered(reference)),
      tree_(reference_),
      limit_(limit),
      squared_limit_(limit * limit),
      faces_(reference_.slots()) {
  for (std::uint32_t t = 0; t < reference_.slots(); ++t) {
    Face& face = faces_[t];
    face.corners = reference_.triangle(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [first, second] =
          reference_.slots_at_edge(face.corners[i], face.corners[(i + 1) % 3]);
      face.neighbours[i] = first == t ? second : first;
    }
  }
}

BackBound::Sight BackBound::sight_from(const Point& p, std::uint32_t hint) const {
  if (hint == kNoIndex) return sight(p);
  double least = squared_distance(p, reference_.corners(hint));
  for (std::uint32_t at = kNoIndex; at != hint;) {
    at = hint;
    for (const std::uint32_t next : faces_[at].neighbours) {
      if (next == kNoIndex) continue;
      const double squared = squared_distance(p, reference_.corners(next));
      if (squared >= least) continue;
      least = squared;
      hint = next;
    }
  }
  return {hint, std::min(least / squared_limit_, Sight{}.share)};
}

BackBound::Sight BackBound::sight(const Point& p, std::uint32_t hint) const {
  const SlotTree::Nearest nearest = tree_.nearest(reference_, p, 4 * squared_limit_, hint);
  if (nearest.slot == kNoIndex) return {};
  return {nearest.slot, nearest.squared_distance / squared_limit_};
}

Point BackBound::toward(const Point& p, std::uint32_t triangle) const {
  return -foot_on(local_frame(reference_.corners(triangle)), p).residual;
}

bool BackBound::holds(const std::array<Point, 3>& corners, std::uint32_t near) const {
  budget_ = kMostPieces;
  if (near == kNoIndex) return false;
  const Sheet sheet = follow_sheet(Plane(corners), near);
  if (sheet == Sheet::kNoSheet) return halve(corners);
  return sheet == Sheet::kWithin;
}

// A walk through the projection, over the side beyond which the centroid lies.
std::uint32_t BackBound::under_centroid(const Plane& plane, std::uint32_t from) const {
  const double y = (plane.corners[1].y + plane.corners[2].y) / 3;
  const double z = plane.corners[2].z / 3;
  for (int step = 0; step < kMostSteps && from != kNoIndex; ++step) {
    std::array<Corner, 3> r;
    for (std::size_t i = 0; i < 3; ++i) {
      r[i] = plane.project(reference_.position(faces_[from].corners[i]));
    }
    double least = 0;
    std::size_t side = 3;
    double area = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner& a = r[i];
      const Corner& b = r[(i + 1) % 3];
      const double turn = (a.y - y) * (b.z - z) - (a.z - z) * (b.y - y);
      area += turn;
      if (turn < least) {
        least = turn;
        side = i;
      }
    }
    if (!(area > 0)) return kNoIndex;
    if (side == 3) return from;
    from = faces_[from].neighbours[side];
  }
  return kNoIndex;
}

// The part of a triangle of the reference that is over T, into part_.
void BackBound::clip(const Plane& plane, const std::array<Corner, 3>& r,
                     const std::array<unsigned, 3>& beyond) const {
  part_.assign(r.begin(), r.end());
  const unsigned cutting = beyond[0] | beyond[1] | beyond[2];
  for (unsigned side = 0; side < 3 && !part_.empty(); ++side) {
    if ((cutting >> side & 1) == 0) continue;
    clipped_.clear();
    for (std::size_t i = 0; i < part_.size(); ++i) {
      const Corner& a = part_[i];
      const Corner& b = part_[(i + 1) % part_.size()];
      const double at_a = plane.inside(side, a), at_b = plane.inside(side, b);
      if (at_a >= 0) clipped_.push_back(a);
      if ((at_a < 0) == (at_b < 0)) continue;
      const double s = at_a / (at_a - at_b);
      clipped_.push_back(
          {a.y + s * (b.y - a.y), a.z + s * (b.z - a.z), a.height + s * (b.height - a.height)});
    }
    part_.swap(clipped_);
  }
}

// From a triangle of the reference under T over every side that T reaches over. Where all of these
// face the way T does and the sheet does not end, a way in T from the first triangle to any point
// passes from one of them to the next, so they cover T; kNoSheet where they do not.
BackBound::Sheet BackBound::follow_covering(const Plane& plane, std::uint32_t start) const {
  ++search_;
  faces_[start].seen = search_;
  covering_.clear();
  covering_.push_back({start, {}, {}});
  const auto project = [&](std::uint32_t vertex, Covering& at, std::size_t i) {
    at.corners[i] = plane.project(reference_.position(vertex));
    at.beyond[i] = plane.beyond(at.corners[i]);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    project(faces_[start].corners[i], covering_.back(), i);
  }
  while (!covering_.empty()) {
    const Covering at = covering_.back();
    covering_.pop_back();
    const std::array<Corner, 3>& r = at.corners;
    const double u = r[1].y - r[0].y, v = r[1].z - r[0].z;
    const double x = r[2].y - r[0].y, y = r[2].z - r[0].z;
    const bool faces = u * y - v * x > kSteep * (u * u + v * v + x * x + y * y);
    const bool flat = std::abs(r[0].height) <= limit_ && std::abs(r[1].height) <= limit_ &&
                      std::abs(r[2].height) <= limit_;
    if (!faces || !flat) {
      clip(plane, r, at.beyond);
      if (part_.empty()) continue;
      if (!faces) return Sheet::kNoSheet;
      if (!(part_distance(plane, part_, at.triangle) <= limit_)) return Sheet::kBeyond;
    }
    const Face& face = faces_[at.triangle];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if ((at.beyond[i] & at.beyond[j]) != 0 || !plane.reaches_over(r[i], r[j])) continue;
      const std::uint32_t next = face.neighbours[i];
      if (next == kNoIndex) return Sheet::kNoSheet;
      if (faces_[next].seen == search_) continue;
      faces_[next].seen = search_;
      Covering& over = covering_.emplace_back();
      over.triangle = next;
      const Triangle& t = faces_[next].corners;
      for (std::size_t k = 0; k < 3; ++k) {
        if (t[k] == face.corners[i] || t[k] == face.corners[j]) {
          const std::size_t same = t[k] == face.corners[i] ? i : j;
          over.corners[k] = r[same];
          over.beyond[k] = at.beyond[same];
        } else {
          project(t[k], over, k);
        }
      }
    }
  }
  return Sheet::kWithin;
}

BackBound::Sheet BackBound::follow_sheet(const Plane& plane, std::uint32_t near) const {
  std::uint32_t start = under_centroid(plane, near);
  if (start == kNoIndex) {
    // The nearest at a ridge may be across it.
    const Point centroid =
        plane.lift({(plane.corners[1].y + plane.corners[2].y) / 3, plane.corners[2].z / 3, 0});
    near = sight(centroid, near).triangle;
    if (near == kNoIndex) return Sheet::kBeyond;
    start = under_centroid(plane, near);
  }
  if (start == kNoIndex) return Sheet::kNoSheet;
  const Sheet covering = follow_covering(plane, start);
  if (covering != Sheet::kNoSheet) return covering;
  ++search_;
  front_.assign(1, start);
  faces_[start].seen = search_;
  sheet_.clear();
  bool ends = false;
  double covered = 0, worst = 0;
  while (!front_.empty()) {
    const std::uint32_t t = front_.back();
    front_.pop_back();
    const Triangle& triangle = faces_[t].corners;
    std::array<Corner, 3> r;
    std::array<unsigned, 3> beyond{};
    for (std::size_t i = 0; i < 3; ++i) {
      r[i] = plane.project(reference_.position(triangle[i]));
      beyond[i] = plane.beyond(r[i]);
    }
    if ((beyond[0] & beyond[1] & beyond[2]) != 0) continue;
    clip(plane, r, beyond);
    if (part_.empty()) continue;
    double overlap = 0;
    for (std::size_t i = 2; i < part_.size(); ++i) {
      overlap += 0.5 * ((part_[i - 1].y - part_[0].y) * (part_[i].z - part_[0].z) -
                        (part_[i - 1].z - part_[0].z) * (part_[i].y - part_[0].y));
    }
    const double u = r[1].y - r[0].y, v = r[1].z - r[0].z;
    const double x = r[2].y - r[0].y, y = r[2].z - r[0].z;
    const double area = u * y - v * x;
    // What only touches T says nothing of it, whichever way it faces; over a ridge the sheet ends.
    if (std::abs(overlap) < kTouch * plane.area ||
        !(area > kSteep * (u * u + v * v + x * x + y * y))) {
      ends = true;
      continue;
    }
    sheet_.push_back(r);
    covered += overlap;
    worst = std::max(worst, part_distance(plane, part_, t));
    if (!(worst <= limit_)) return Sheet::kBeyond;
    for (std::size_t i = 0; i < 3; ++i) {
      if ((beyond[i] & beyond[(i + 1) % 3]) != 0) continue;
      const std::uint32_t next = faces_[t].neighbours[i];
      ends = ends || next == kNoIndex;
      if (next == kNoIndex || faces_[next].seen == search_) continue;
      faces_[next].seen = search_;
      front_.push_back(next);
    }
  }
  if (sheet_.empty() || (ends && covers_itself())) return Sheet::kNoSheet;
  // About a point of T that is r from what is covered, T scaled by r / its longest side is in T and
  // not covered.
  const double rest = std::max(plane.area - covered, 0.0) + kRoundings * plane.area;
  const double reach = plane.longest * std::sqrt(rest / plane.area);
  return worst + reach <= limit_ ? Sheet::kWithin : Sheet::kNoSheet;
}

// Whether two triangles of the sheet overlap in the projection. Those with a common vertex have
// the same numbers for it, so what only touches is told exactly.
bool BackBound::covers_itself() const {
  using Shape = std::array<Corner, 3>;
  const auto separates = [](const Shape& s, const Shape& t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner &a = s[i], &b = s[(i + 1) % 3];
      if (std::all_of(t.begin(), t.end(), [&](const Corner& c) {
            return (b.y - a.y) * (c.z - a.z) <= (b.z - a.z) * (c.y - a.y);
          })) {
        return true;
      }
    }
    return false;
  };
  const auto left = [](const Shape& s) { return std::min({s[0].y, s[1].y, s[2].y}); };
  std::sort(sheet_.begin(), sheet_.end(),
            [&](const Shape& s, const Shape& t) { return left(s) < left(t); });
  for (std::size_t i = 0; i < sheet_.size(); ++i) {
    const Shape& s = sheet_[i];
    const double right = std::max({s[0].y, s[1].y, s[2].y});
    for (std::size_t j = i + 1; j < sheet_.size() && left(sheet_[j]) < right; ++j) {
      if (!separates(s, sheet_[j]) && !separates(sheet_[j], s)) return true;
    }
  }
  return false;
}

// At most the limit, or infinite.
double BackBound::part_distance(const Plane& plane, const std::vector<Corner>& part,
                                std::uint32_t triangle) const {
  double height = 0;
  for (const Corner& c : part) height = std::max(height, std::abs(c.height));
  if (height <= limit_) return height;
  double squared = 0;
  for (const Corner& c : part) {
    squared = std::max(squared, squared_distance(plane.lift(c), reference_.corners(triangle)));
  }
  if (squared <= squared_limit_) return std::sqrt(squared);
  for (std::size_t i = 2; i < part.size(); ++i) {
    if (!halve({plane.lift(part[0]), plane.lift(part[i - 1]), plane.lift(part[i])})) {
      return std::numeric_limits<double>::infinity();
    }
  }
  return limit_;
}

bool BackBound::halve(const std::array<Point, 3>& corners) const {
  pieces_.assign(1, corners);
  while (!pieces_.empty()) {
    if (--budget_ < 0) return false;
    const std::array<Point, 3> piece = pieces_.back();
    pieces_.pop_back();
    const SlotTree::Nearest nearest =
        tree_.nearest(reference_, (piece[0] + piece[1] + piece[2]) / 3, squared_limit_);
    const std::uint32_t candidate = nearest.slot;
    if (candidate == kNoIndex) return false;
    const std::array<Point, 3> of = reference_.corners(candidate);
    bool within = true;
    for (const Point& corner : piece) {
      if (squared_distance(corner, of) <= squared_limit_) continue;
      within = false;
      if (!(sight(corner, candidate).share <= 1)) return false;
    }
    if (within) continue;
    std::size_t longest = 0;
    double length = -1;
    for (std::size_t i = 0; i < 3; ++i) {
      const double squared = (piece[(i + 1) % 3] - piece[i]).squaredNorm();
      if (squared > length) {
        length = squared;
        longest = i;
      }
    }
    const Point& a = piece[longest];
    const Point& b = piece[(longest + 1) % 3];
    const Point& c = piece[(longest + 2) % 3];
    const Point middle = 0.5 * (a + b);
    pieces_.push_back({a, middle, c});
    pieces_.push_back({middle, b, c});
  }
  return true;
}

}  // namespace emax
