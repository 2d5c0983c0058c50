#include "sw_model/certify/surface_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/certify/matrix_free.h"

namespace emax {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnit = 0x1p-53;
constexpr unsigned kMaxDepth = 1000;
constexpr std::size_t kQueriesPerPoll = 1024;
// A cut leaves at least this part of an edge on either side, and every fourth one halves the
// longest edge, so pieces shrink however they are cut.
constexpr double kLeastPart = 1.0 / 16;
constexpr unsigned kHalvingPeriod = 4;
// A proven distance is at most this times the plain one, unless the plain one is wrong.
constexpr double kPlain = 1 + 1e-6;

struct Corner {
  Point point;
  DistanceBounds distance;
  std::uint32_t nearest;  // triangle of the reference
};

struct Piece {
  std::array<Corner, 3> corners;
  double bound;             // of the distances of all points of the mesh that this piece stands for
  std::uint32_t candidate;  // the triangle of the reference that proves the bound
  std::uint32_t triangle;   // of the mesh
  std::uint16_t depth;      // cuts that led to this piece
  std::uint16_t worst;      // the corner farthest from the candidate
};

// The part of a piece that the heap moves.
struct Rank {
  double bound;
  std::uint32_t triangle;
  std::uint32_t place;

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
    rounding_ = 9 * kUnit * low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff() + 0x1p-1060;
    const double extent = (high - low).maxCoeff();
    finest_ = std::max(options.absolute, 0x1p-30 * extent);
    scale_ = extent > 0x1p-900 ? std::ldexp(1, -std::ilogb(extent)) : 1;
  }

  SurfaceDistance run() {
    begin();
    // A decision cuts every piece beyond the limit in any case. Taking the triangles of the mesh
    // one after the other, the farthest first, keeps to the same part of the reference.
    if (decides()) std::sort(open_.begin(), open_.end());
    while (!open_.empty() && (decides() || open_.front().bound > enough()) && !refuted()) {
      if (!decides()) std::pop_heap(open_.begin(), open_.end());
      const std::uint32_t place = open_.back().place;
      open_.pop_back();
      free_.push_back(place);
      const Piece piece = pieces_[place];
      cut(piece);
      if (EMAX_FAULT(kStopsEarly)) open_.clear();
    }
    result_.upper = std::max(result_.lower, settled_);
    for (const Rank& rank : open_) result_.upper = std::max(result_.upper, rank.bound);
    return result_;
  }

 private:
  void begin() {
    result_.witness = mesh_.vertices[mesh_.triangles[0][0]];
    constexpr std::uint32_t kUnseen = ~0u;
    std::vector<Corner> corners(mesh_.vertices.size(), Corner{Point::Zero(), {}, kUnseen});
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (const std::uint32_t vertex : mesh_.triangles[t]) {
        if (corners[vertex].nearest == kUnseen) {
          corners[vertex] = corner_at(mesh_.vertices[vertex], t, 0);
        }
      }
    }
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Triangle& triangle = mesh_.triangles[t];
      Piece piece = piece_of({corners[triangle[0]], corners[triangle[1]], corners[triangle[2]]},
                             corners[triangle[0]].nearest, t, 0);
      if (piece.bound > enough()) {
        // The corners of a large triangle tell little about its middle.
        const Point centre =
            (piece.corners[0].point + piece.corners[1].point + piece.corners[2].point) / 3;
        try_candidate(corner_at(centre, t, 1).nearest, piece);
      }
      put(piece);
    }
  }

  double margin(unsigned depth) const {
    return EMAX_FAULT(kCutsWithoutMargin) ? 0 : depth * rounding_;
  }

  double enough() const {
    return std::max(
        {options_.limit, result_.lower * (1 + options_.relative), result_.lower + finest_});
  }
  bool decides() const { return options_.limit >= 0; }
  bool refuted() const { return decides() && result_.lower > options_.limit; }

  Corner corner_at(const Point& point, std::uint32_t triangle, unsigned depth,
                   std::uint32_t seed = ~0u) {
    if (++queries_ % kQueriesPerPoll == 0 && options_.poll) options_.poll();
    const ExactMesh::Nearest nearest = reference_.nearest(point, -kInfinity, seed);
    const double lower = nearest.distance.lower - margin(depth);
    if (lower > result_.lower) {
      result_.lower = lower;
      result_.witness = point;
      result_.triangle = triangle;
    }
    return {point, nearest.distance, nearest.triangle};
  }

  DistanceBounds distance(const Corner& corner, std::uint32_t candidate) const {
    return corner.nearest == candidate ? corner.distance
                                       : reference_.distance_to(corner.point, candidate);
  }

  // A piece with the best of a few candidates: the triangles nearest to its corners, and the
  // candidate of the piece that it was cut from.
  Piece piece_of(const std::array<Corner, 3>& corners, std::uint32_t inherited,
                 std::uint32_t triangle, unsigned depth) const {
    Piece piece = {corners, kInfinity, 0, triangle, static_cast<std::uint16_t>(depth), 0};
    const std::array<std::uint32_t, 4> candidates = {inherited, corners[0].nearest,
                                                     corners[1].nearest, corners[2].nearest};
    std::uint32_t likely = inherited;
    double least = kInfinity;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const auto seen = candidates.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::find(candidates.begin(), seen, *seen) != seen) continue;
      const double farthest = farthest_corner(corners, *seen, least);
      if (farthest < least) {
        least = farthest;
        likely = *seen;
      }
    }
    try_candidate(likely, piece);
    // The plain distance to a sliver may be wrong; then every candidate is proven.
    if (least == kInfinity || piece.bound > least * kPlain + 16 * margin(depth + 1)) {
      for (const std::uint32_t candidate : candidates) try_candidate(candidate, piece);
    }
    if (EMAX_FAULT(kNearestOfEachCorner)) {
      piece.bound = std::max(
          {corners[0].distance.upper, corners[1].distance.upper, corners[2].distance.upper});
    }
    return piece;
  }

  double likely_distance(const Corner& corner, std::uint32_t candidate) const {
    if (corner.nearest == candidate) return corner.distance.upper;
    const std::array<Point, 3>& triangle = reference_.corners(candidate);
    return ericson_offset<double>(Point::Zero(), scale_ * (triangle[0] - corner.point),
                                  scale_ * (triangle[1] - corner.point),
                                  scale_ * (triangle[2] - corner.point))
               .norm() /
           scale_;
  }

  // The plain distance of the farthest corner, for a tenth of the cost of a proven one; infinity
  // where it is not below `least`.
  double farthest_corner(const std::array<Corner, 3>& corners, std::uint32_t candidate,
                         double least) const {
    double farthest = 0;
    for (const Corner& corner : corners) {
      const double distance = likely_distance(corner, candidate);
      if (!(distance < least)) return kInfinity;  // also for NaN
      farthest = std::max(farthest, distance);
    }
    return farthest;
  }

  void try_candidate(std::uint32_t candidate, Piece& piece) const {
    double greatest = -1;
    std::uint16_t worst = 0;
    for (std::uint16_t k = 0; k < 3; ++k) {
      const double d = distance(piece.corners[k], candidate).upper;
      if (d > piece.bound) return;
      if (d <= greatest) continue;
      greatest = d;
      worst = k;
    }
    if (piece.depth > 0) greatest = std::nextafter(greatest + margin(piece.depth), kInfinity);
    if (greatest >= piece.bound) return;
    piece.bound = greatest;
    piece.candidate = candidate;
    piece.worst = worst;
  }

  void put(const Piece& piece) {
    if (piece.bound <= enough() || is_exact(piece)) {
      settled_ = std::max(settled_, piece.bound);
    } else {
      std::uint32_t place = static_cast<std::uint32_t>(pieces_.size());
      if (free_.empty()) {
        pieces_.push_back(piece);
      } else {
        place = free_.back();
        free_.pop_back();
        pieces_[place] = piece;
      }
      open_.push_back({piece.bound, piece.triangle, place});
      if (!decides()) std::push_heap(open_.begin(), open_.end());
    }
  }

  // Whether only roundings lie between the bound and the distance of the worst corner, so that
  // cutting would not help.
  bool is_exact(const Piece& piece) const {
    const Corner& worst = piece.corners[piece.worst];
    const double roundings =
        worst.distance.upper - worst.distance.lower + (piece.depth + 1) * rounding_;
    return worst.nearest == piece.candidate ||
           piece.bound <= worst.distance.lower + 4 * roundings || piece.depth >= kMaxDepth;
  }

  void cut(const Piece& piece) {
    ++result_.cuts;
    if (piece.depth % kHalvingPeriod != kHalvingPeriod - 1 && cut_between_candidates(piece)) return;
    std::array<double, 3> squared;
    for (std::size_t k = 0; k < 3; ++k) {
      squared[k] =
          (piece.corners[(k + 1) % 3].point - piece.corners[(k + 2) % 3].point).squaredNorm();
    }
    const auto longest = std::max_element(squared.begin(), squared.end());
    cut_from_corner(piece, static_cast<std::size_t>(longest - squared.begin()), 0.5);
  }

  // Cuts where the candidate and the triangle nearest to the worst corner are equally far, by
  // secants.
  bool cut_between_candidates(const Piece& piece) {
    const std::uint32_t other = piece.corners[piece.worst].nearest;
    std::array<double, 3> excess;
    int above = 0, below = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double difference = likely_distance(piece.corners[k], piece.candidate) -
                                likely_distance(piece.corners[k], other);
      // Such a small difference is rounding: the corner is equally far from both.
      excess[k] = std::abs(difference) > 4 * rounding_ ? difference : 0;
      above += excess[k] > 0 ? 1 : 0;
      below += excess[k] < 0 ? 1 : 0;
    }
    if (above == 0 || below == 0) return false;
    if (above + below == 2) {
      const std::size_t k =
          static_cast<std::size_t>(std::find(excess.begin(), excess.end(), 0.0) - excess.begin());
      cut_from_corner(piece, k, secant(excess[(k + 1) % 3], excess[(k + 2) % 3]));
      return true;
    }
    std::size_t lone = 0;
    while ((excess[lone] > 0) != (above == 1)) ++lone;
    const std::size_t i = (lone + 1) % 3, j = (lone + 2) % 3;
    const Corner x = between(piece, lone, i, secant(excess[lone], excess[i]));
    const Corner y = between(piece, lone, j, secant(excess[lone], excess[j]));
    const Corner &at_i = piece.corners[i], &at_j = piece.corners[j];
    add_part(piece, {piece.corners[lone], x, y});
    if ((x.point - at_j.point).squaredNorm() < (y.point - at_i.point).squaredNorm()) {
      add_part(piece, {x, at_i, at_j});
      add_part(piece, {x, at_j, y});
    } else {
      add_part(piece, {x, at_i, y});
      add_part(piece, {y, at_i, at_j});
    }
    return true;
  }

  static double secant(double from, double to) {
    return std::clamp(from / (from - to), kLeastPart, 1 - kLeastPart);
  }

  void cut_from_corner(const Piece& piece, std::size_t k, double position) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const Corner x = between(piece, i, j, position);
    add_part(piece, {piece.corners[k], piece.corners[i], x});
    add_part(piece, {piece.corners[k], x, piece.corners[j]});
  }

  Corner between(const Piece& piece, std::size_t from, std::size_t to, double position) {
    const Point &a = piece.corners[from].point, &b = piece.corners[to].point;
    return corner_at(a + position * (b - a), piece.triangle, piece.depth + 1u, piece.candidate);
  }

  void add_part(const Piece& of, const std::array<Corner, 3>& corners) {
    put(piece_of(corners, of.candidate, of.triangle, of.depth + 1u));
  }

  MeshView mesh_;
  const ExactMesh& reference_;
  const SurfaceDistanceOptions& options_;
  std::size_t queries_ = 0;
  double rounding_;  // how far a cut moves what it cuts
  double finest_;    // the absolute width of interval that is aimed at
  double scale_;     // keeps fourth powers of lengths representable
  SurfaceDistance result_;
  double settled_ = -1;  // the greatest bound of the pieces that need no cut
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> free_;  // places in pieces_
  std::vector<Rank> open_;           // pieces to cut: a heap, in a decision a stack
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
