#include "host/decimate/back_bound.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "host/decimate/local_distance.h"
#include "host/decimate/spatial_order.h"

namespace emax {
namespace {

constexpr double kTouch = 1e-13, kRoundings = 1e-12;  // of the area of T
constexpr int kMostPieces = 160;                      // pieces that one triangle may be halved into

}  // namespace

class BackBound::Faces {
 public:
  explicit Faces(const BackBound& bound) : bound_(bound) {}

  const Triangle& corners(std::uint32_t t) const { return bound_.faces_[t].corners; }
  const Point& position(std::uint32_t v) const { return bound_.reference_.position(v); }
  std::uint32_t neighbour(std::uint32_t t, std::size_t side) const {
    return bound_.faces_[t].neighbours[side];
  }
  bool visit(std::uint32_t t) {
    return std::exchange(bound_.faces_[t].seen, bound_.search_) != bound_.search_;
  }
  bool part_within(const TrianglePlane& plane, const std::vector<PlanarCorner>& part,
                   std::uint32_t t) const {
    return bound_.part_distance(plane, part, t) <= bound_.limit_;
  }

 private:
  const BackBound& bound_;
};

BackBound::~BackBound() = default;

BackBound::BackBound(const TriangleMesh& reference, double limit)
    : reference_(spatially_ordered(reference)),
      tree_(reference_),
      limit_(limit),
      squared_limit_(limit * limit),
      faces_(reference_.slots()),
      walk_(std::make_unique<SheetWalk<Faces>>()) {
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
  const Sheet sheet = follow_sheet(TrianglePlane(corners), near);
  if (sheet == Sheet::kNoSheet) return halve(corners);
  return sheet == Sheet::kWithin;
}

Sheet BackBound::follow_sheet(const TrianglePlane& plane, std::uint32_t near) const {
  Faces faces(*this);
  std::uint32_t start = walk_->under_centroid(plane, near, faces);
  if (start == kNoIndex) {
    // At a ridge the nearest triangle may lie on the other side of the ridge.
    const Point centroid =
        plane.lift({(plane.corners[1].y + plane.corners[2].y) / 3, plane.corners[2].z / 3, 0});
    near = sight(centroid, near).triangle;
    if (near == kNoIndex) return Sheet::kBeyond;
    start = walk_->under_centroid(plane, near, faces);
  }
  if (start == kNoIndex) return Sheet::kNoSheet;
  ++search_;
  const Sheet covering = walk_->follow_covering(plane, start, limit_, faces);
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
    std::array<PlanarCorner, 3> r;
    std::array<unsigned, 3> beyond{};
    for (std::size_t i = 0; i < 3; ++i) {
      r[i] = plane.project(reference_.position(triangle[i]));
      beyond[i] = plane.beyond(r[i]);
    }
    if ((beyond[0] & beyond[1] & beyond[2]) != 0) continue;
    part_.clip(plane, r, beyond);
    const std::vector<PlanarCorner>& part = part_.corners();
    if (part.empty()) continue;
    double overlap = 0;
    for (std::size_t i = 2; i < part.size(); ++i) {
      overlap += 0.5 * ((part[i - 1].y - part[0].y) * (part[i].z - part[0].z) -
                        (part[i - 1].z - part[0].z) * (part[i].y - part[0].y));
    }
    // A triangle that only touches T proves nothing about T, whichever way it faces. At a triangle
    // that faces away, over a ridge, the sheet ends.
    if (std::abs(overlap) < kTouch * plane.area || !faces_plane(r)) {
      ends = true;
      continue;
    }
    sheet_.push_back(r);
    covered += overlap;
    worst = std::max(worst, part_distance(plane, part, t));
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
  // Let p be a point of T at distance r from the covered part. T scaled about p by r / its longest
  // side lies in T and is not covered, so the area of the rest bounds r.
  const double rest = std::max(plane.area - covered, 0.0) + kRoundings * plane.area;
  const double reach = plane.longest * std::sqrt(rest / plane.area);
  return worst + reach <= limit_ ? Sheet::kWithin : Sheet::kNoSheet;
}

// Whether two triangles of the sheet overlap in the projection. Triangles with a common vertex have
// the same numbers for it, so triangles that only touch are recognised exactly.
bool BackBound::covers_itself() const {
  using Shape = std::array<PlanarCorner, 3>;
  const auto separates = [](const Shape& s, const Shape& t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const PlanarCorner &a = s[i], &b = s[(i + 1) % 3];
      if (std::all_of(t.begin(), t.end(), [&](const PlanarCorner& c) {
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

// Returns at most the limit, or infinity.
double BackBound::part_distance(const TrianglePlane& plane, const std::vector<PlanarCorner>& part,
                                std::uint32_t triangle) const {
  double height = 0;
  for (const PlanarCorner& c : part) height = std::max(height, std::abs(c.height));
  if (height <= limit_) return height;
  double squared = 0;
  for (const PlanarCorner& c : part) {
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
