#pragma once

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
  bool judge(std::uint32_t a, std::uint32_t b, Candidate& candidate);
  bool place(const Point& a, const Point& b, Fit& fit);
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
  std::vector<std::array<std::uint32_t, 2>> edges() const;

  DecimationState& state_;
  Options options_;
  Poll poll_;
  LocalSearch search_;
  MeshEdit edit_;
  std::priority_queue<Candidate> queue_;
  std::vector<std::uint64_t> touched_;  // the edit that last changed the triangles of each vertex
  std::uint64_t edits_ = 0;
  std::uint64_t polls_ = 0;
  bool stopped_ = false;
  std::vector<std::uint32_t> around_, of_a_, of_b_;  // scratch
  std::vector<EditUndo> undo_;
  std::vector<std::uint32_t> unsettled_;  // points beyond the limit
  std::vector<std::uint32_t> uncovered_;  // triangles of the reference that are not proven
};

}  // namespace emax
