#include "host/tiles/mesh_stars.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <span>
#include <tuple>
#include <type_traits>
#include <vector>

#include "host/geometry/disjoint_sets.h"
#include "host/geometry/edge_sides.h"
#include "host/tiles/component_count.h"
#include "host/tiles/sorted_records.h"

namespace emax {
namespace {

// How a vertex is told from others: by its number in the file, or by its position.
using Numbered = std::uint32_t;
using Placed = std::array<std::uint32_t, 3>;  // the bits of three floats

template <class Vertex>
Vertex vertex_of(const MeshPart& part, std::uint32_t local) {
  if constexpr (std::is_same_v<Vertex, Numbered>) {
    return part.vertex_numbers[local];
  } else {
    const Point& p = part.mesh.vertices[local];
    const auto bits = [](double x) { return std::bit_cast<std::uint32_t>(static_cast<float>(x)); };
    return {bits(p.x()), bits(p.y()), bits(p.z())};
  }
}

// A corner of a triangle. That of a triangle that repeats a vertex has `next` == `at`.
template <class Vertex>
struct StarCorner {
  Vertex at, next, previous;
  std::uint32_t triangle;

  bool operator<(const StarCorner& other) const { return at < other.at; }
};

// A border side of a triangle ends at a fan. The side is known by the place of the vertex opposite
// to it among the three in ascending order.
struct BorderEnd {
  std::uint32_t triangle, opposite, fan;

  bool operator<(const BorderEnd& other) const {
    return std::tie(triangle, opposite) < std::tie(other.triangle, other.opposite);
  }
};

template <class Vertex>
class StarCounter {
 public:
  StarCounter(const NamedInput& input, std::uint64_t memory)
      : input_(input),
        joined_(input, memory / 3),
        surfaces_(input, memory / 3),
        ends_(input, memory / 3),
        memory_(memory / 3) {}

  // All corners at one vertex.
  void add(std::span<const StarCorner<Vertex>> star) {
    star_ = star;
    ++found_.vertices;
    sides_.clear();
    for (std::uint32_t i = 0; i < star.size(); ++i) {
      if (star[i].next == star[i].at) continue;
      sides_.push_back({star[i].next, i, true});
      sides_.push_back({star[i].previous, i, false});
    }
    if (sides_.empty()) return;
    std::ranges::sort(sides_, {}, &Side::other);
    for (DisjointSets* fans : {&fans_, &cut_fans_}) {
      fans->clear();
      fans->grow(star.size());
    }
    borders_.clear();
    for (std::span<const Side> left = sides_; !left.empty();) {
      std::size_t users = 1;
      while (users < left.size() && left[users].other == left[0].other) ++users;
      add_edge(left.first(users));
      left = left.subspan(users);
    }
    count_fans();
  }

  MeshConnectivity finish(std::uint64_t triangles, std::uint64_t repeating) {
    found_.triangles = triangles;
    const std::uint64_t faces = triangles - repeating;
    found_.validity.components = joined_.count(triangles) - repeating;
    MeshTopology& topology = found_.topology;
    topology.components = surfaces_.count(triangles) - repeating;
    topology.border_loops = border_loops();
    topology.genus = (2 * topology.components + edges_ - topology.border_loops - cut_vertices_ -
                      static_cast<std::size_t>(faces)) /
                     2;
    return found_;
  }

 private:
  // Of a triangle of the star, from or to its vertex.
  struct Side {
    Vertex other;  // where it ends
    std::uint32_t corner;
    bool leaves;
  };

  // The sides of all triangles along an edge. Each edge is counted at its lower vertex.
  void add_edge(std::span<const Side> sides) {
    const bool counts = star_[0].at < sides[0].other;
    const bool is_sound = sides.size() == 2 && sides[0].leaves != sides[1].leaves;
    const auto triangle = [this](const Side& s) { return star_[s.corner].triangle; };
    for (const Side& side : sides.subspan(1)) {
      fans_.join(side.corner, sides[0].corner);
      if (counts) joined_.join(triangle(side), triangle(sides[0]));
    }
    if (is_sound) {
      cut_fans_.join(sides[0].corner, sides[1].corner);
      if (counts) surfaces_.join(triangle(sides[0]), triangle(sides[1]));
    } else {
      borders_.insert(borders_.end(), sides.begin(), sides.end());
    }
    if (!counts) return;
    edges_ += is_sound ? 1 : sides.size();
    MeshValidity& validity = found_.validity;
    if (sides.size() == 1) ++validity.boundary_edges;
    if (sides.size() == 2 && !is_sound) ++validity.inconsistent_edges;
    if (sides.size() > 2) ++validity.non_manifold_edges;
  }

  void count_fans() {
    std::size_t fans = 0;
    for (std::uint32_t i = 0; i < star_.size(); ++i) {
      if (star_[i].next == star_[i].at) continue;
      if (fans_.root(i) == i) ++fans;
      if (cut_fans_.root(i) == i) ++cut_vertices_;
    }
    if (fans > 1) ++found_.validity.non_manifold_vertices;
    number_of_.assign(borders_.empty() ? 0 : star_.size(), kNoNumber);
    for (const Side& side : borders_) {
      std::uint32_t& number = number_of_[cut_fans_.root(side.corner)];
      if (number == kNoNumber) {
        if (border_fans_ == kNoNumber) {
          input_.fail("more border edges than 32-bit numbers can name", "split the file");
        }
        number = border_fans_++;
      }
      const StarCorner<Vertex>& corner = star_[side.corner];
      const Vertex& opposite = side.leaves ? corner.previous : corner.next;
      const int place = (side.other < opposite ? 1 : 0) + (corner.at < opposite ? 1 : 0);
      ends_.add({corner.triangle, static_cast<std::uint32_t>(place), number});
    }
  }

  // A fan on a border has two sides on it, so the fans form loops.
  std::size_t border_loops() {
    ComponentCount loops(input_, memory_);
    const BorderEnd none = {};
    BorderEnd before = none;
    bool is_first = true;
    ends_.take([&](const BorderEnd& end) {
      if (!is_first) loops.join(before.fan, end.fan);
      before = end;
      is_first = !is_first;
    });
    return static_cast<std::size_t>(loops.count(border_fans_));
  }

  static constexpr std::uint32_t kNoNumber = std::numeric_limits<std::uint32_t>::max();

  const NamedInput& input_;
  MeshConnectivity found_;
  ComponentCount joined_, surfaces_;  // of triangles: by any edge, and by sound ones
  SortedRecords<BorderEnd> ends_;     // two of each border side
  std::uint64_t memory_;
  std::size_t edges_ = 0, cut_vertices_ = 0;  // of the cut surface
  std::uint32_t border_fans_ = 0;

  std::span<const StarCorner<Vertex>> star_;
  std::vector<Side> sides_, borders_;
  DisjointSets fans_{0}, cut_fans_{0};  // of corners of the star
  std::vector<std::uint32_t> number_of_;
};

template <class Vertex>
MeshConnectivity count_stars(const MeshParts& mesh, std::size_t part_triangles,
                             std::uint64_t memory,
                             const std::function<void(const MeshPart&)>& look) {
  using Corner = StarCorner<Vertex>;
  SortedRecords<Corner> corners(mesh.input(), memory / 2);
  std::uint64_t repeating = 0;
  const std::uint64_t triangles = mesh.read(part_triangles, [&](const MeshPart& part) {
    look(part);
    for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
      const Triangle& local = part.mesh.triangles[t];
      const auto number = part.first + static_cast<std::uint32_t>(t);
      const bool repeats = repeats_index(local);
      repeating += repeats ? 1 : 0;
      std::array<Vertex, 3> v;
      for (std::size_t i = 0; i < 3; ++i) v[i] = vertex_of<Vertex>(part, local[i]);
      for (std::size_t i = 0; i < 3; ++i) {
        corners.add(repeats ? Corner{v[i], v[i], v[i], number}
                            : Corner{v[i], v[(i + 1) % 3], v[(i + 2) % 3], number});
      }
    }
  });
  StarCounter<Vertex> counter(mesh.input(), memory / 2);
  std::vector<Corner> star;
  corners.take([&](const Corner& corner) {
    if (!star.empty() && star[0].at != corner.at) {
      counter.add(star);
      star.clear();
    }
    star.push_back(corner);
  });
  if (!star.empty()) counter.add(star);
  return counter.finish(triangles, repeating);
}

}  // namespace

MeshConnectivity connectivity_in_parts(const MeshParts& mesh, std::size_t part_triangles,
                                       std::uint64_t memory,
                                       const std::function<void(const MeshPart&)>& look) {
  if (!mesh.vertices()) return count_stars<Placed>(mesh, part_triangles, memory, look);
  MeshConnectivity found = count_stars<Numbered>(mesh, part_triangles, memory, look);
  found.vertices = *mesh.vertices();
  return found;
}

}  // namespace emax
