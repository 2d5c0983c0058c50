#include "sw_model/certify/surface_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/certify/matrix_free.h"
#include "sw_model/certify/rounding.h"

namespace emax {
namespace {

constexpr unsigned kMostCuts = 1000;
constexpr std::size_t kStepsPerPoll = 1024;
// A cut leaves at least this part of an edge on either side, and every fourth one halves the
// piece, so pieces shrink however they are cut.
constexpr double kLeastPart = 1.0 / 16;
constexpr unsigned kHalvingPeriod = 4;
constexpr std::size_t kMostCorners = 8;
// Asked for first. Most of the time goes to what is farther than the farthest of them.
constexpr std::size_t kSamples = 256;
// A triangle whose bound is more than this times what is aimed at is asked for its centre.
constexpr double kLarge = 8;
constexpr std::size_t kAhead = 8;  // triangles whose vertices are fetched early
constexpr std::uint32_t kNone = ~0u;

struct Corner {
  Point point;
  DistanceBounds distance = {-kInfinity, kInfinity};  // proven from below where needed
  std::uint32_t near = kNone;  // the triangle of the reference that proves `upper`
  bool asked = false;          // `near` is the nearest, or its distance does not matter
};

using Distances = std::array<double, kMostCorners>;

// A convex polygon, part of a triangle of the mesh.
struct Piece {
  std::array<Corner, kMostCorners> corners;
  std::uint32_t count;      // of corners
  std::uint32_t candidate;  // the triangle of the reference that proves the bound
  Distances to;             // upper ends of the distances of the corners to the candidate
  double bound;             // of the distances of all points of the mesh that this piece stands for
  std::uint32_t triangle;   // of the mesh
  std::uint32_t depth;      // cuts that led to this piece
};

// A triangle of the mesh to be cut.
struct Rank {
  double bound;
  std::uint32_t triangle;
  std::uint32_t candidate;  // the triangle of the reference that proves the bound

  bool operator<(const Rank& other) const {
    return bound != other.bound ? bound < other.bound : triangle > other.triangle;
  }
};

class Search {
 public:
  Search(MeshView mesh, const ExactMesh& reference, const SurfaceDistanceOptions& options)
      : mesh_(mesh), reference_(reference), options_(options) {
    Point low = Point::Constant(kInfinity), high = -low;
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t vertex : triangle) {
        low = low.cwiseMin(mesh.vertices[vertex]);
        high = high.cwiseMax(mesh.vertices[vertex]);
      }
    }
    // Coordinates of cuts lie between those of vertices.
    rounding_ = 9 * kUnitRoundoff * low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff() + 0x1p-1060;
    finest_ = std::max(options.absolute, 0x1p-30 * (high - low).maxCoeff());
  }

  SurfaceDistance run() {
    take_samples();
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) look_at(t);
    // The farthest first, which raises `lower` early. One triangle after the other keeps to the
    // same part of the reference.
    std::sort(open_.begin(), open_.end());
    while (!refuted() && !(open_.empty() && pieces_.empty())) {
      if (pieces_.empty()) {
        const Rank rank = open_.back();
        open_.pop_back();
        if (rank.bound > enough()) {
          start(rank);
        } else {
          settle(rank.bound);
        }
      } else {
        const Piece piece = pieces_.back();
        pieces_.pop_back();
        resolve(piece);
      }
      if (EMAX_FAULT(kStopsEarly)) {
        open_.clear();
        pieces_.clear();
      }
    }
    for (const Rank& rank : open_) settle(rank.bound);
    for (const Piece& piece : pieces_) settle(piece.bound);
    result_.upper = std::max(result_.lower, settled_);
    return result_;
  }

 private:
  double margin(unsigned depth) const {
    return EMAX_FAULT(kCutsWithoutMargin) ? 0 : depth * rounding_;
  }

  double enough() const {
    return std::max(
        {options_.limit, result_.lower * (1 + options_.relative), result_.lower + finest_});
  }
  bool refuted() const { return options_.limit >= 0 && result_.lower > options_.limit; }
  void settle(double bound) { settled_ = std::max(settled_, bound); }

  void step() {
    if (++steps_ % kStepsPerPoll == 0 && options_.poll) options_.poll();
  }

  // The more is known from below, the fewer triangles need a second look.
  void take_samples() {
    result_.witness = mesh_.vertices[mesh_.triangles[0][0]];
    vertices_.resize(mesh_.vertices.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i) vertices_[i].point = mesh_.vertices[i];
    const std::size_t stride = (mesh_.triangles.size() + kSamples - 1) / kSamples;
    for (std::size_t t = 0; t < mesh_.triangles.size(); t += stride) {
      ask(vertices_[mesh_.triangles[t][0]], static_cast<std::uint32_t>(t), 0);
    }
  }

  // Finds the triangle nearest to a corner, and its distance from below where this is news.
  void ask(Corner& corner, std::uint32_t triangle, unsigned depth) {
    if (corner.asked) return;
    corner.asked = true;
    step();
    learn(corner,
          reference_.likely_nearest(corner.point, corner.near == kNone ? last_ : corner.near));
    last_ = corner.near;
    if (corner.distance.upper <= result_.lower) return;
    const ExactMesh::Nearest nearest = reference_.nearest(corner.point, -kInfinity, corner.near);
    corner.distance = nearest.distance;
    corner.near = nearest.triangle;
    const double lower = nearest.distance.lower - margin(depth);
    if (lower > result_.lower) {
      result_.lower = lower;
      result_.witness = corner.point;
      result_.triangle = triangle;
    }
  }

  double learn(Corner& corner, std::uint32_t candidate) const {
    if (corner.near == candidate) return corner.distance.upper;
    const double upper = reference_.upper_to(corner.point, candidate);
    if (upper < corner.distance.upper) {
      corner.distance.upper = upper;
      corner.near = candidate;
    }
    return upper;
  }

  // Most triangles are settled by a triangle that is near a neighbour.
  void look_at(std::uint32_t t) {
    step();
    if (t + kAhead < mesh_.triangles.size()) {
      for (const std::uint32_t vertex : mesh_.triangles[t + kAhead]) {
        __builtin_prefetch(&vertices_[vertex]);
      }
    }
    const Triangle& triangle = mesh_.triangles[t];
    if (vertices_[triangle[0]].near == kNone && vertices_[triangle[1]].near == kNone &&
        vertices_[triangle[2]].near == kNone) {
      ask(vertices_[triangle[0]], t, 0);
    }
    Rank rank = {kInfinity, t, kNone};
    for (const std::uint32_t vertex : triangle) {
      look_from(vertices_[vertex].near, rank);
      if (rank.bound <= result_.lower) return settle(rank.bound);
    }
    // A vertex may be farther than all samples. What is near to one is often near to the others.
    for (;;) {
      Corner* farthest = &vertices_[triangle[0]];
      for (const std::uint32_t vertex : triangle) {
        if (vertices_[vertex].distance.upper > farthest->distance.upper) {
          farthest = &vertices_[vertex];
        }
      }
      if (EMAX_FAULT(kNearestOfEachCorner)) rank.bound = farthest->distance.upper;
      if (farthest->distance.upper <= result_.lower || farthest->asked) break;
      ask(*farthest, t, 0);
      look_from(farthest->near, rank);
    }
    if (rank.bound <= enough()) {
      settle(rank.bound);
    } else {
      open_.push_back(rank);
    }
  }

  void look_from(std::uint32_t candidate, Rank& rank) {
    if (candidate == kNone || candidate == rank.candidate) return;
    double farthest = 0;
    for (const std::uint32_t vertex : mesh_.triangles[rank.triangle]) {
      farthest = std::max(farthest, learn(vertices_[vertex], candidate));
    }
    if (farthest < rank.bound) {
      rank.bound = farthest;
      rank.candidate = candidate;
    }
  }

  void start(const Rank& rank) {
    Piece piece;
    piece.count = 3;
    piece.bound = kInfinity;
    piece.triangle = rank.triangle;
    piece.depth = 0;
    Corner centre;
    centre.point = Point::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      piece.corners[k] = vertices_[mesh_.triangles[rank.triangle][k]];
      centre.point += piece.corners[k].point / 3;
    }
    offer(piece, rank.candidate, distances(piece, rank.candidate));
    // The corners of a large triangle tell little about its middle.
    if (piece.bound > kLarge * enough()) {
      last_ = rank.candidate;
      ask(centre, rank.triangle, 1);
      offer(piece, centre.near, distances(piece, centre.near));
    }
    resolve(piece);
  }

  Distances distances(Piece& piece, std::uint32_t candidate) const {
    Distances to;
    for (std::size_t k = 0; k < piece.count; ++k) to[k] = learn(piece.corners[k], candidate);
    return to;
  }

  void offer(Piece& piece, std::uint32_t candidate, const Distances& to) const {
    double bound = *std::max_element(to.begin(), to.begin() + piece.count);
    if (piece.depth > 0) bound = std::nextafter(bound + margin(piece.depth), kInfinity);
    if (!(bound < piece.bound)) return;
    piece.bound = bound;
    piece.candidate = candidate;
    piece.to = to;
  }

  void resolve(Piece piece) {
    step();
    if (piece.bound <= enough()) return settle(piece.bound);
    Corner& worst = piece.corners[static_cast<std::size_t>(
        std::max_element(piece.to.begin(), piece.to.begin() + piece.count) - piece.to.begin())];
    if (worst.distance.upper > result_.lower) ask(worst, piece.triangle, piece.depth);
    const std::uint32_t candidate = piece.candidate, other = worst.near;
    if (piece.bound <= enough() || is_exact(piece, worst)) return settle(piece.bound);
    const Distances to = piece.to, to_other = distances(piece, other);
    offer(piece, other, to_other);
    if (piece.bound <= enough()) return settle(piece.bound);
    ++result_.cuts;
    if (piece.count == kMostCorners) return cut_along_diagonal(piece);
    const bool halves = piece.depth % kHalvingPeriod == kHalvingPeriod - 1;
    if (!halves && cut_between(piece, candidate, to, other, to_other)) return;
    if (!halve(piece, candidate, to, other, to_other)) cut_along_diagonal(piece);
  }

  // Whether only roundings lie between the bound and the distance of the worst corner, so that
  // cutting would not help.
  bool is_exact(const Piece& piece, const Corner& worst) const {
    const double roundings =
        worst.distance.upper - worst.distance.lower + (piece.depth + 1) * rounding_;
    return worst.near == piece.candidate || piece.depth >= kMostCuts ||
           (worst.distance.lower >= 0 && piece.bound <= worst.distance.lower + 4 * roundings);
  }

  // Cuts where the candidates are equally far, by secants.
  bool cut_between(const Piece& piece, std::uint32_t candidate, const Distances& to,
                   std::uint32_t other, const Distances& to_other) {
    Distances excess;
    for (std::size_t k = 0; k < piece.count; ++k) {
      const double difference = to[k] - to_other[k];
      // Such a small difference is rounding: the corner is equally far from both.
      excess[k] = std::abs(difference) > 4 * rounding_ ? difference : 0;
    }
    return cut(piece, excess, candidate, to, other, to_other);
  }

  bool halve(const Piece& piece, std::uint32_t candidate, const Distances& to, std::uint32_t other,
             const Distances& to_other) {
    double longest = -1;
    Point along = Point::Zero(), middle = along;
    for (std::size_t i = 0; i < piece.count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Point &a = piece.corners[i].point, &b = piece.corners[j].point;
        const double length = (a - b).squaredNorm();
        if (length <= longest) continue;
        longest = length;
        along = a - b;
        middle = b + 0.5 * along;
      }
    }
    Distances excess;
    for (std::size_t k = 0; k < piece.count; ++k) {
      excess[k] = (piece.corners[k].point - middle).dot(along);
    }
    return cut(piece, excess, candidate, to, other, to_other);
  }

  // Around a polygon, zeros aside.
  static int sign_changes(const Distances& values, std::size_t count) {
    int changes = 0;
    double first = 0, last = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (values[k] == 0) continue;
      if (last == 0) first = values[k];
      changes += last != 0 && (last > 0) != (values[k] > 0) ? 1 : 0;
      last = values[k];
    }
    return changes + ((last > 0) != (first > 0) ? 1 : 0);
  }

  static double secant(double from, double to) {
    return std::clamp(from / (from - to), kLeastPart, 1 - kLeastPart);
  }

  // Cuts by a chord where the excess is zero. False where its sign does not change twice around
  // the piece.
  bool cut(const Piece& piece, const Distances& excess, std::uint32_t candidate,
           const Distances& to, std::uint32_t other, const Distances& to_other) {
    if (sign_changes(excess, piece.count) != 2) return false;
    struct Side {
      Piece part;
      Distances to, to_other;
    };
    std::array<Side, 2> sides;
    for (Side& side : sides) {
      side.part.count = 0;
      side.part.bound = kInfinity;
      side.part.triangle = piece.triangle;
      side.part.depth = piece.depth + 1;
    }
    const auto add = [](Side& side, const Corner& corner, double d, double d_other) {
      const std::uint32_t k = side.part.count++;
      side.part.corners[k] = corner;
      side.to[k] = d;
      side.to_other[k] = d_other;
    };
    for (std::size_t k = 0; k < piece.count; ++k) {
      const std::size_t next = k + 1 == piece.count ? 0 : k + 1;
      if (excess[k] >= 0) add(sides[0], piece.corners[k], to[k], to_other[k]);
      if (excess[k] <= 0) add(sides[1], piece.corners[k], to[k], to_other[k]);
      if (!(excess[k] > 0 && excess[next] < 0) && !(excess[k] < 0 && excess[next] > 0)) continue;
      const Point &a = piece.corners[k].point, &b = piece.corners[next].point;
      Corner x;
      x.point = a + secant(excess[k], excess[next]) * (b - a);
      const double d = learn(x, candidate), d_other = learn(x, other);
      for (Side& side : sides) add(side, x, d, d_other);
    }
    for (Side& side : sides) {
      offer(side.part, candidate, side.to);
      offer(side.part, other, side.to_other);
    }
    if (sides[0].part.bound > sides[1].part.bound) std::swap(sides[0], sides[1]);
    for (const Side& side : sides) put(side.part);
    return true;
  }

  // Without a new corner. A triangle that could not be halved is so small that squares of its
  // lengths vanish.
  void cut_along_diagonal(const Piece& piece) {
    if (piece.count == 3) return settle(piece.bound);
    const std::uint32_t half = piece.count / 2;
    for (const std::uint32_t first : {0u, half}) {
      Piece part = piece;
      part.count = first == 0 ? half + 1 : piece.count - half + 1;
      for (std::uint32_t k = 0; k < part.count; ++k) {
        part.corners[k] = piece.corners[(first + k) % piece.count];
        part.to[k] = piece.to[(first + k) % piece.count];
      }
      part.bound = kInfinity;
      offer(part, piece.candidate, part.to);
      put(part);
    }
  }

  void put(const Piece& piece) {
    if (piece.bound <= enough()) {
      settle(piece.bound);
    } else {
      pieces_.push_back(piece);
    }
  }

  MeshView mesh_;
  const ExactMesh& reference_;
  const SurfaceDistanceOptions& options_;
  std::size_t steps_ = 0;
  double rounding_;  // how far a cut moves what it cuts
  double finest_;    // the absolute width of interval that is aimed at
  SurfaceDistance result_;
  double settled_ = -1;     // the greatest bound of the pieces that need no cut
  std::uint32_t last_ = 0;  // the answer to the last query, where the next one starts
  std::vector<Corner> vertices_;
  std::vector<Rank> open_;     // triangles of the mesh to cut, the farthest last
  std::vector<Piece> pieces_;  // of the triangle in hand: a stack
};

}  // namespace

SurfaceDistance surface_distance(MeshView mesh, const ExactMesh& reference,
                                 const SurfaceDistanceOptions& options) {
  require_no_flush("the distance between surfaces");
  require_measurable(mesh);
  return Search(mesh, reference, options).run();
}

SurfaceDistance decided_distance(MeshView mesh, const ExactMesh& reference, double limit) {
  SurfaceDistanceOptions options;
  options.relative = 0;
  options.limit = limit;
  return surface_distance(mesh, reference, options);
}

std::vector<Triangle> triangles_of_points(std::size_t points) {
  std::vector<Triangle> triangles(points);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) triangles[i] = {i, i, i};
  return triangles;
}

}  // namespace emax
