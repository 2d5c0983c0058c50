#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

#include "host/decimate/feature_edges.h"
#include "host/decimate/local_search.h"

namespace emax {

// The passes of bounded decimation over a state. Each keeps every point that was within the limit
// within it, and each is a pure function of the state; ties go to the lower vertex numbers.
class DecimationPasses {
 public:
  // Told now and then how much of the pass at hand is done, from 0 to 1; true ends the pass after
  // the edit at hand.
  using Poll = std::function<bool(double)>;
  struct Options {
    FeatureEdges features;  // which collapses and flips keep
    // Hoppe's objective: what an edge's squared length costs, and what a vertex less is worth in
    // units of epsilon^2. A collapse is then made only where it lowers the energy.
    double spring = 0, representation = 0;
  };
  DecimationPasses(DecimationState& state, Options options, Poll poll);

  // Edge collapses far below the limit in sweeps over the mesh, each of edges that do not touch,
  // the vertex where the planes' quadrics have it; until a sweep gains little. Returns how many.
  std::size_t sweep();
  // Edge collapses, the one that adds least to the energy first, until none is left that the limit
  // and the guards permit. Returns how many.
  std::size_t collapse();
  // The same for Hoppe's energy, of power 2: collapses, flips and relocations until none lowers it.
  std::size_t descend();
  // Moves each vertex where the energy of its points is least. Returns how many moved.
  std::size_t relocate(int power);
  // Turns each edge for which that lowers the energy. Returns how many.
  std::size_t flip(int power);
  // Collapses that break the limit at first, where moving and turning what is around mends it; the
  // others are undone. Returns how many stayed.
  std::size_t collapse_and_mend();

  bool stopped() const { return stopped_; }

 private:
  struct Candidate {
    double cost;
    std::uint32_t a, b;
    std::uint64_t stamp;
    Fit fit;
    // For a queue that gives the least first.
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
  std::vector<std::uint32_t> uncovered_;  // triangles of the reference not known to be within it
};

}  // namespace emax
