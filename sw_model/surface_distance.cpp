#include "sw_model/surface_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sw_model/flush_mode.h"

namespace emax {
namespace {

using Fault = SurfaceDistanceOptions::Fault;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnit = 0x1p-53;
constexpr unsigned kMaxDepth = 1000;
constexpr std::size_t kQueriesPerPoll = 1024;
// A cut leaves at least this part of an edge on either side, and every fourth one halves the
// longest edge, so pieces shrink however they are cut.
constexpr double kLeastPart = 1.0 / 16;
constexpr unsigned kHalvingPeriod = 4;

struct Corner {
  Point point;
  DistanceBounds distance;
  std::uint32_t nearest;  // triangle of the reference
};

struct Piece {
  std::array<Corner, 3> corners;
  double bound;             // no point of the mesh's triangle that this stands for is farther
  std::uint32_t candidate;  // the triangle of the reference which shows that
  std::uint32_t triangle;   // of the mesh
  std::uint16_t depth;      // cuts
  std::uint16_t worst;      // the corner farthest from the candidate

  bool operator<(const Piece& other) const {
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
    finest_ = std::max(options.absolute, 0x1p-30 * (high - low).maxCoeff());
  }

  SurfaceDistance run() {
    begin();
    while (!pieces_.empty() && pieces_.front().bound > enough() && !refuted()) {
      std::pop_heap(pieces_.begin(), pieces_.end());
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      cut(piece);
      if (options_.fault == Fault::kStopsEarly) pieces_.clear();
    }
    result_.upper = std::max(result_.lower, settled_);
    if (!pieces_.empty()) result_.upper = std::max(result_.upper, pieces_.front().bound);
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
        // A large triangle's corners say little of its middle.
        const Point centre =
            (piece.corners[0].point + piece.corners[1].point + piece.corners[2].point) / 3;
        try_candidate(corner_at(centre, t, 1).nearest, piece);
      }
      put(piece);
    }
  }

  double margin(unsigned depth) const {
    return options_.fault == Fault::kNoMargin ? 0 : depth * rounding_;
  }

  double enough() const {
    return std::max(
        {options_.limit, result_.lower * (1 + options_.relative), result_.lower + finest_});
  }
  bool refuted() const { return options_.limit >= 0 && result_.lower > options_.limit; }

  Corner corner_at(const Point& point, std::uint32_t triangle, unsigned depth) {
    if (++queries_ % kQueriesPerPoll == 0 && options_.poll) options_.poll();
    const ExactMesh::Nearest nearest = reference_.nearest(point);
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

  // A piece with the best of a few candidates: those of its corners and of the piece it was cut
  // from.
  Piece piece_of(const std::array<Corner, 3>& corners, std::uint32_t inherited,
                 std::uint32_t triangle, unsigned depth) const {
    Piece piece = {corners, kInfinity, 0, triangle, static_cast<std::uint16_t>(depth), 0};
    const std::array<std::uint32_t, 4> candidates = {inherited, corners[0].nearest,
                                                     corners[1].nearest, corners[2].nearest};
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const auto seen = candidates.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::find(candidates.begin(), seen, *seen) == seen) try_candidate(*seen, piece);
    }
    if (options_.fault == Fault::kNearestOfEachCorner) {
      piece.bound = std::max(
          {corners[0].distance.upper, corners[1].distance.upper, corners[2].distance.upper});
    }
    return piece;
  }

  void try_candidate(std::uint32_t candidate, Piece& piece) const {
    double greatest = -1;
    std::uint16_t worst = 0;
    for (std::uint16_t k = 0; k < 3; ++k) {
      const double d = distance(piece.corners[k], candidate).upper;
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
      pieces_.push_back(piece);
      std::push_heap(pieces_.begin(), pieces_.end());
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

  // Where the candidate and the triangle nearest to the worst corner are equally far, by secants.
  bool cut_between_candidates(const Piece& piece) {
    const std::uint32_t other = piece.corners[piece.worst].nearest;
    std::array<double, 3> excess;
    int above = 0, below = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const DistanceBounds here = distance(piece.corners[k], piece.candidate);
      const DistanceBounds there = distance(piece.corners[k], other);
      // A corner on the border of the two is there but for roundings.
      const bool apart =
          here.lower > there.upper + 2 * rounding_ || there.lower > here.upper + 2 * rounding_;
      excess[k] = apart ? here.upper - there.upper : 0;
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
    return corner_at(a + position * (b - a), piece.triangle, piece.depth + 1u);
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
  SurfaceDistance result_;
  double settled_ = -1;  // the greatest bound of the pieces that need no cut
  std::vector<Piece> pieces_;
};

}  // namespace

SurfaceDistance surface_distance(MeshView mesh, const ExactMesh& reference,
                                 const SurfaceDistanceOptions& options) {
  require_no_flush("the distance between surfaces");
  require_measurable(mesh);
  return Search(mesh, reference, options).run();
}

std::vector<Triangle> triangles_of_points(std::size_t points) {
  std::vector<Triangle> triangles(points);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) triangles[i] = {i, i, i};
  return triangles;
}

}  // namespace emax
