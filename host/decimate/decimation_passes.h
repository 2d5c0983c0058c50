#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

#include "host/decimate/feature_edges.h"
#include "host/decimate/local_search.h"

namespace emax {

// The passes of bounded decimation over a state. Each pass keeps every point within the limit that
// was within it, and is a pure function of the state. Ties go to the lower vertex numbers.
class DecimationPasses {
 public:
  // Called from time to time with the share of the present pass that is done, from 0 to 1. True
  // ends the pass after the present edit.
  using Poll = std::function<bool(double)>;
  static constexpr int kPower = 4;  // of the distances in the energy that places vertices
  struct Options {
    FeatureEdges features;  // kept by collapses and flips
    // For Hoppe's objective: the cost of an edge's squared length, and the gain of one vertex less,
    // in units of epsilon^2. A collapse is then made only where it lowers the energy.
    double spring = 0, representation = 0;
  };
  DecimationPasses(DecimationState& state, Options options, Poll poll);

  // Edge collapses far below the limit, in sweeps over the mesh, until a sweep gains little. The
  // edges of a sweep do not touch. The new vertex is the optimum of the planes' quadrics. Returns
  // the number of collapses.
  std::size_t sweep();
  // Edge collapses, the one that adds least to the energy first, until the limit and the guards
  // permit no more. Returns the number of collapses.
  std::size_t collapse();
  // Rounds of collapses, flips and relocations that lower Hoppe's energy (power 2). Ends after
  // eight rounds, or after one without a collapse in which the other edits are fewer than one for
  // each hundred triangles. Returns the number of edits.
  std::size_t descend();
  // Moves each vertex to where the energy of its points is least. Returns the number of moved
  // vertices.
  std::size_t relocate(int power);
  // Flips each edge whose flip lowers the energy. Returns the number of flips.
  std::size_t flip(int power);
  // Tries collapses that break the limit, and relocates vertices and flips edges around them to
  // restore it. Collapses that still break it are undone. Returns the number of collapses that
  // stay.
  std::size_t collapse_and_mend();

  // The passes that ErrorEquidistribution uses (equidistribution_passes.cpp).

  // Greatest squared distance / limit^2 that a triangle answers for: of its points, its vertices
  // and its edges.
  double worst_of(std::uint32_t slot);
  // The triangles with a point beyond the limit or that break the back bound as last tested, the
  // worst first.
  std::vector<std::uint32_t> beyond_limit();
  // Collapses edges that do not touch, the one that adds least to the energy first, until at most
  // `target` triangles are left. Returns the number of collapses.
  std::size_t collapse_to(std::size_t target, int power);
  // Splits edges, of the triangles with most energy first and none beside another, until at least
  // `target` triangles are there. Returns the number of splits.
  std::size_t split_to(std::size_t target, int power);
  // Splits each of these triangles, or an edge of it, where it is farthest from the reference or
  // from one of its points; none beside another. Returns the number of splits.
  std::size_t split_at_worst(const std::vector<std::uint32_t>& slots, int power);
  // Collapses an edge of each of these triangles, the shortest that can be. Returns the number of
  // collapses.
  std::size_t collapse_at(const std::vector<std::uint32_t>& slots);
  // Flips and relocations within so many rings of triangles around these. Returns their number.
  std::size_t relax_around(const std::vector<std::uint32_t>& slots, int rings, int power);

  void use(LocalSearch::Steps steps) { search_.use(steps); }
  const FeatureEdges& features() const { return options_.features; }
  // After a restored state: these are its features, and steps are as at first.
  void restart(const FeatureEdges& features);

  bool stopped() const { return stopped_; }

 private:
  struct Candidate {
    double cost;
    std::uint32_t a, b;
    std::uint64_t stamp;
    Fit fit;
    // For a queue that gives the least cost first.
    bool operator<(const Candidate& other) const {
      if (cost != other.cost) return cost > other.cost;
      return a != other.a ? a > other.a : b > other.b;
    }
  };

  bool poll(double done);
  bool poll(std::size_t at, std::size_t of);
  using Edge = std::array<std::uint32_t, 2>;
  // `from` and `to` are shares of the present pass.
  std::size_t flip_each(const std::vector<Edge>& edges, int power, double from, double to);
  std::size_t relocate_each(const std::vector<std::uint32_t>& vertices, int power, double from);
  bool judge(std::uint32_t a, std::uint32_t b, Candidate& candidate);
  bool place(const Point& a, const Point& b, Fit& fit);
  // A place of a triangle and the point of the reference or the cloud that it should be near.
  struct Witness {
    std::array<double, 3> at{};  // barycentric
    Point wanted = Point::Zero();
    double share = 0;  // squared distance / limit^2
  };
  Witness worst_place(std::uint32_t slot) const;
  double energy_of(std::uint32_t slot, int power);
  std::vector<Edge> cheapest_collapses(std::size_t most);
  bool untouched(std::uint32_t slot) const;
  void touch_around(std::uint32_t vertex);
  std::uint32_t spare_vertex(const Point& at, std::uint32_t near);
  std::size_t split(const std::vector<std::uint32_t>& slots, int power, std::size_t most);
  bool try_split(std::uint32_t a, std::uint32_t b, int power);
  bool try_best_split(std::uint32_t slot, int power);
  bool try_split_at(std::uint32_t slot, const Witness& witness, int power);
  void make_split();
  std::vector<std::uint32_t> vertices_around(const std::vector<std::uint32_t>& slots,
                                             int rings) const;
  bool keeps_features(std::uint32_t a, std::uint32_t b, const Point& at) const;
  void make_collapse(std::uint32_t a, std::uint32_t b);
  void push(std::uint32_t a, std::uint32_t b);
  bool try_plain_collapse(std::uint32_t a, std::uint32_t b, double most);
  bool apply_collapse(const Candidate& candidate);
  bool settled();
  bool try_relocation(std::uint32_t vertex, int power, bool limit);
  bool try_flip(std::uint32_t a, std::uint32_t b, int power, bool limit);
  void apply(bool keep_undo);
  bool mend(std::uint32_t vertex);
  bool all_within(const std::vector<std::uint32_t>& points) const;
  std::vector<Edge> edges() const;

  DecimationState& state_;
  Options options_;
  Poll poll_;
  LocalSearch search_;
  MeshEdit edit_;
  int power_ = kPower;              // of the energy by which collapses are judged
  std::uint32_t spare_ = kNoIndex;  // a vertex that no triangle has
  std::priority_queue<Candidate> queue_;
  std::vector<std::uint64_t> touched_;  // the edit that last changed the triangles of each vertex
  std::uint64_t edits_ = 0;
  std::uint64_t polls_ = 0;
  bool stopped_ = false;
  std::vector<std::uint32_t> around_, of_a_;  // scratch
  std::vector<EditUndo> undo_;
  std::vector<std::uint32_t> unsettled_;  // points beyond the limit
  std::vector<std::uint32_t> uncovered_;  // triangles of the reference that are not proven
};

}  // namespace emax
