#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "host/decimate/decimation_state.h"
#include "host/decimate/edge_places.h"

namespace emax {

// The farthest places of edges that were looked at, as long as the edges' ends stay.
class KnownEdges {
 public:
  struct Known {
    Point low, high;  // the ends, of the lower vertex first
    std::vector<EdgePlace> places;
  };
  using Map = std::unordered_map<std::uint64_t, Known>;  // by key()

  static std::uint64_t key(std::uint32_t low, std::uint32_t high) {
    return std::uint64_t{low} << 32 | high;
  }
  static const Known* find(const Map& map, std::uint64_t key, const Point& low, const Point& high);
  const Map& all() const { return known_; }
  // Takes over those whose ends are where the mesh has them, and empties `fresh`.
  void keep(Map& fresh, const EditableMesh& mesh);

 private:
  Map known_;
};

// Places on the edges that an edit changes, with their distances to the reference surface. Between
// two pieces of surface the greatest distance may lie where edges cross, which neither points of
// the cloud nor vertices show.
class EdgeSamples {
 public:
  // `known` is read only; what is looked at anew is fresh() until it is taken.
  explicit EdgeSamples(const DecimationState& state, const KnownEdges* known = nullptr)
      : state_(state), known_(known) {}

  // Off at first: take() then takes none.
  void enable(bool on) { enabled_ = on; }
  bool none() const { return !enabled_ || state_.back() == nullptr; }

  // Of the edges that only one of both sets of triangles has, and of those at `vertex`, which
  // moves; it may be kNoIndex. New edges of `vertex` that were edges of `other` begin with what is
  // known of these.
  void take(std::span<const std::uint32_t> removed, std::span<const Triangle> added,
            std::uint32_t vertex, std::uint32_t other = kNoIndex);

  // The greatest squared distance / limit^2 between the ends of an edge of the mesh.
  double worst_on(std::uint32_t a, std::uint32_t b);

  // The sum of (distance / limit)^power as it stands.
  double energy_before(int power) const;
  // The same with the vertex at `position`, and the greatest squared distance / limit^2. Walks from
  // the reference's triangles of the last call.
  struct Energy {
    double sum = 0, worst = 0;
  };
  Energy measure(const Point& position, int power);
  // Whether the new edges of the vertex at `position` are nowhere farther from the reference than
  // the greater of `permitted`, a squared distance / limit^2, and what the edges before were. Looks
  // for the farthest places anew, unlike measure().
  bool permits(const Point& position, std::uint32_t vertex, double permitted);
  // Adds to the normal equations of a step of the vertex, at the position last measured. Weights
  // are relative to `worst`.
  void add_to(Eigen::Matrix3d& matrix, Point& right, const Point& position, double worst,
              int power) const;

  KnownEdges::Map& fresh() { return fresh_; }

 private:
  struct Sample {
    std::uint32_t from;  // kNoIndex: the moving vertex
    std::uint32_t to;
    EdgePlace at;
  };
  using Edge = std::array<std::uint32_t, 2>;

  const std::vector<EdgePlace>& places(const Edge& edge);
  const std::vector<EdgePlace>& places_between(std::uint32_t from, const EdgeEnd& at,
                                               std::uint32_t to);
  bool moves(const Edge& e) const { return e[0] == vertex_ || e[1] == vertex_; }
  std::vector<Sample>& after();
  void add_moving(const Edge& edge, std::uint32_t to);
  Point place(const Sample& s, const Point& moving) const;

  const DecimationState& state_;
  bool enabled_ = false;
  const KnownEdges* known_;
  KnownEdges::Map fresh_;
  std::vector<Sample> before_, after_;
  std::vector<Edge> edges_before_, edges_after_;  // of the triangles taken, each once
  std::uint32_t vertex_ = kNoIndex, other_ = kNoIndex;
};

}  // namespace emax
