#include "host/decimate/back_bound.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/decimate/local_distance.h"
#include "host/decimate/spatial_order.h"

namespace emax {
namespace {

constexpr int kMostPieces = 1000;  // that the parts of one triangle may be halved into

}  // namespace

class BackBound::Faces {
 public:
  Faces(const BackBound& bound, Search& search) : bound_(bound), search_(search) {}

  const Triangle& corners(std::uint32_t t) const { return bound_.faces_[t].corners; }
  const Point& position(std::uint32_t v) const { return bound_.reference_.position(v); }
  std::uint32_t neighbour(std::uint32_t t, std::size_t side) const {
    return bound_.faces_[t].neighbours[side];
  }
  bool visited(std::uint32_t t) const;
  void visit(std::uint32_t t);

 private:
  const BackBound& bound_;
  Search& search_;
};

struct BackBound::Search {
  SheetWalk<Faces> walk;
  std::vector<std::uint32_t> seen;  // of each triangle, the last search that reached it
  std::uint32_t number = 0;         // of this search
  std::vector<std::array<Point, 3>> pieces;
  int budget = 0;
};

bool BackBound::Faces::visited(std::uint32_t t) const { return search_.seen[t] == search_.number; }
void BackBound::Faces::visit(std::uint32_t t) { search_.seen[t] = search_.number; }

BackBound::~BackBound() = default;

BackBound::BackBound(const TriangleMesh& reference, double limit)
    : reference_(spatially_ordered(reference)),
      tree_(reference_),
      limit_(limit),
      squared_limit_(limit * limit),
      faces_(reference_.slots()) {
  for (std::uint32_t t = 0; t < reference_.slots(); ++t) {
    Face& face = faces_[t];
    face.corners = reference_.triangle(t);
    const std::array<Point, 3> c = reference_.corners(t);
    mean_edge_ += ((c[1] - c[0]).norm() + (c[2] - c[1]).norm() + (c[0] - c[2]).norm()) / 3;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [first, second] =
          reference_.slots_at_edge(face.corners[i], face.corners[(i + 1) % 3]);
      face.neighbours[i] = first == t ? second : first;
    }
  }
  mean_edge_ /= static_cast<double>(reference_.slots());
  usual_rise_ = find_usual_rise();
}

double BackBound::find_usual_rise() const {
  std::vector<double> rises;
  for (std::uint32_t t = 0; t < faces_.size(); ++t) {
    const TrianglePlane plane(reference_.corners(t));
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t next = faces_[t].neighbours[i];
      if (next == kNoIndex || next < t) continue;
      const Triangle& c = faces_[t].corners;
      const std::uint32_t far = opposite(faces_[next].corners, c[i], c[(i + 1) % 3]);
      rises.push_back(std::abs(plane.project(reference_.position(far)).height));
    }
  }
  if (rises.empty()) return 0;
  const auto at = rises.begin() + static_cast<std::ptrdiff_t>(rises.size() * 3 / 4);
  std::ranges::nth_element(rises, at);
  return *at;
}

BackBound::Sight BackBound::sight_from(const Point& p, std::uint32_t hint) const {
  if (hint == kNoIndex) return sight(p);
  double least = squared_distance(p, reference_.corners(hint));
  for (std::uint32_t at = kNoIndex; at != hint;) {
    at = hint;
    const std::array<Point, 3> c = reference_.corners(at);
    const Point normal = (c[1] - c[0]).cross(c[2] - c[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t next = faces_[at].neighbours[i];
      // What lies over the triangle is nearest to it.
      if (next == kNoIndex || !((c[(i + 1) % 3] - c[i]).cross(p - c[i]).dot(normal) < 0)) continue;
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

// A segment and the plane through it.
class BackBound::Segment {
 public:
  Segment(const BackBound& bound, const Point& from, const Point& to, const Point& up)
      : bound_(bound),
        from_(from),
        along_((to - from) / (to - from).squaredNorm()),
        normal_((to - from).cross(up)) {}

  struct Exit {
    double along = 0;
    std::size_t side = 3;  // 3: there is none
  };
  // Of the sides of the triangle that the plane cuts, except the one to `entered`, the farthest in
  // the direction of `sense`, 1 or -1.
  Exit exit(std::uint32_t triangle, std::uint32_t entered, double sense) const {
    const Face& face = bound_.faces_[triangle];
    std::array<double, 3> above;
    for (std::size_t i = 0; i < 3; ++i) above[i] = normal_.dot(corner(face, i) - from_);
    Exit exit;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const bool cut = (above[i] >= 0) != (above[j] >= 0);
      if (!cut || (entered != kNoIndex && face.neighbours[i] == entered)) continue;
      const Point& a = corner(face, i);
      const Point at = a + above[i] / (above[i] - above[j]) * (corner(face, j) - a);
      const double along = along_.dot(at - from_);
      if (exit.side == 3 || sense * along > sense * exit.along) exit = {along, i};
    }
    return exit;
  }

 private:
  const Point& corner(const Face& face, std::size_t i) const {
    return bound_.reference_.position(face.corners[i]);
  }

  const BackBound& bound_;
  Point from_, along_, normal_;
};

bool BackBound::follow(const Point& from, const Point& to, const Point& up, std::uint32_t middle,
                       std::vector<Crossing>& crossings) const {
  constexpr std::size_t kMostCrossings = 600;
  constexpr double kTurnsBack = 1e-3;
  const Segment segment(*this, from, to, up);
  crossings.clear();
  for (const double sense : {-1.0, 1.0}) {
    std::uint32_t at = middle, entered = kNoIndex;
    for (double last = 0.5;;) {
      const Segment::Exit exit = segment.exit(at, entered, sense);
      if (exit.side == 3 || crossings.size() == kMostCrossings) return false;
      if (sense > 0 ? exit.along >= 1 : exit.along <= 0) break;
      if (entered != kNoIndex && sense * (exit.along - last) < -kTurnsBack) return false;
      last = exit.along;
      entered = at;
      at = faces_[at].neighbours[exit.side];
      if (at == kNoIndex) return false;
      crossings.push_back({last, sense > 0 ? entered : at, sense > 0 ? at : entered});
    }
    if (sense < 0) std::ranges::reverse(crossings);
  }
  return true;
}

double BackBound::share_of(const Point& p, std::uint32_t triangle) const {
  return squared_distance(p, reference_.corners(triangle)) / squared_limit_;
}

Point BackBound::toward(const Point& p, std::uint32_t triangle) const {
  return -foot_on(local_frame(reference_.corners(triangle)), p).residual;
}

std::shared_ptr<BackBound::Search> BackBound::make_search() const {
  auto search = std::make_shared<Search>();
  search->seen.resize(faces_.size(), 0);
  return search;
}

bool BackBound::holds(const std::array<Point, 3>& corners, std::uint32_t near,
                      Search& search) const {
  if (near == kNoIndex) return false;
  search.budget = kMostPieces;
  const Sheet sheet = follow_sheet(TrianglePlane(corners), near, search);
  if (sheet == Sheet::kNoSheet) return halve(corners, search);
  return sheet == Sheet::kWithin;
}

Sheet BackBound::follow_sheet(const TrianglePlane& plane, std::uint32_t near,
                              Search& search) const {
  Faces faces(*this, search);
  std::uint32_t start = search.walk.under_centroid(plane, near, faces);
  if (start == kNoIndex) {
    // At a ridge the nearest triangle may lie on the other side of the ridge.
    near = sight(plane.lift(plane.middle()), near).triangle;
    if (near == kNoIndex) return Sheet::kUnproven;
    start = search.walk.under_centroid(plane, near, faces);
  }
  if (start == kNoIndex) return Sheet::kNoSheet;
  ++search.number;
  return search.walk.follow_covering(plane, start, limit_, faces,
                                     [&](const std::vector<PlanarCorner>& part, std::uint32_t t) {
                                       return part_within(plane, part, t, search);
                                     });
}

bool BackBound::part_within(const TrianglePlane& plane, const std::vector<PlanarCorner>& part,
                            std::uint32_t triangle, Search& search) const {
  const bool within = std::ranges::all_of(part, [&](const PlanarCorner& c) {
    return squared_distance(plane.lift(c), reference_.corners(triangle)) <= squared_limit_;
  });
  if (within) return true;
  for (std::size_t i = 2; i < part.size(); ++i) {
    if (!halve({plane.lift(part[0]), plane.lift(part[i - 1]), plane.lift(part[i])}, search))
      return false;
  }
  return true;
}

bool BackBound::halve(const std::array<Point, 3>& corners, Search& search) const {
  std::vector<std::array<Point, 3>>& pieces = search.pieces;
  pieces.assign(1, corners);
  while (!pieces.empty()) {
    if (--search.budget < 0) return false;
    const std::array<Point, 3> piece = pieces.back();
    pieces.pop_back();
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
    pieces.push_back({a, middle, c});
    pieces.push_back({middle, b, c});
  }
  return true;
}

}  // namespace emax
