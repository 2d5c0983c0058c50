#pragma once

#include <cstdint>
#include <vector>

#include "host/decimate/feature_edges.h"
#include "host/decimate/local_search.h"
#include "host/decimate/true_edges.h"

namespace emax {

// Proposes the edits that DecimationPasses makes, with the best form that LocalSearch finds. The
// limits of points and the topology are tested here; the state's permits() tests the rest. Only
// reads the state and the features, so that several threads may propose at once, each with its own
// proposer. A proposal is a pure function of the state and the features.
class EditProposer {
 public:
  static constexpr int kPower = 4;  // of the distances in the energy that places vertices
  struct Options {
    FeatureEdges features;  // kept by collapses and flips
    // For Hoppe's objective: the cost of an edge's squared length, and the gain of one vertex less,
    // in units of epsilon^2. A collapse is then made only where it lowers the energy.
    double spring = 0, representation = 0;
    // Vertices that stay where they are, with the edges between their neighbours; by number. What
    // is missing is free.
    std::vector<char> held;

    // The vertices at these places stay, with the edges between two and the triangles between three
    // of them.
    std::vector<Point> fixed_places;
    std::vector<char> fixed;

    TrueEdges true_edges;  // that vertices are moved to in the end

    bool fixes(std::uint32_t vertex) const { return vertex < fixed.size() && fixed[vertex] != 0; }
    bool stays(std::uint32_t vertex) const { return vertex < held.size() && held[vertex] != 0; }
    bool holds(std::uint32_t vertex) const { return fixes(vertex) || stays(vertex); }
  };
  // State, options and known edges must outlive the proposer.
  EditProposer(const DecimationState& state, const Options& options, const KnownEdges& known)
      : state_(state), options_(options), search_(state, options.spring, &known) {}

  // A collapse of b into a, the lower number first.
  struct Collapse {
    double cost = 0;  // the increase of the energy
    std::uint32_t a = kNoIndex, b = kNoIndex;
    std::uint64_t stamp = 0;  // the caller's
    Fit fit;
    // For a queue that gives the least cost first.
    bool operator<(const Collapse& other) const {
      if (cost != other.cost) return cost > other.cost;
      return a != other.a ? a > other.a : b > other.b;
    }
    static bool costs_less(const Collapse& c, const Collapse& d) { return d < c; }
  };

  // Each returns whether there is something to propose; it is then in edit(), except after
  // judge(), judge_beyond() and rate().
  // A vertex between planes is put into their place if it can be there; without `in_place` it may
  // be anywhere.
  bool judge(std::uint32_t a, std::uint32_t b, int power, Collapse& collapse, bool in_place = true);
  // A collapse that may break the limit by so much as can be mended. Its cost is the greatest
  // squared distance / limit^2.
  bool judge_beyond(std::uint32_t a, std::uint32_t b, Collapse& collapse);
  // How much energy the collapse into the optimum of the planes' quadrics adds.
  bool rate(std::uint32_t a, std::uint32_t b, int power, Collapse& collapse);
  // The new vertex is the optimum of the planes' quadrics, and no squared distance / limit^2 is
  // greater than `most`. `in_place` as for judge().
  bool plain_collapse(std::uint32_t a, std::uint32_t b, double most, bool in_place);
  // Without `limit` points may go beyond it.
  bool relocation(std::uint32_t vertex, int power, bool limit);
  bool flip(std::uint32_t a, std::uint32_t b, int power, bool limit);
  // Moves a vertex onto the planes that the triangles around it follow.
  bool into_place(std::uint32_t vertex);
  // Moves a vertex so that the true edges are nearer to the edges at it; what lies on shapes stays
  // on them.
  bool toward_edges(std::uint32_t vertex, const TrueEdges& edges);
  // Edges between two fixed vertices and triangles between three may not.
  bool may_split(std::uint32_t a, std::uint32_t b) const;
  bool may_split(const Triangle& triangle) const;

  bool keeps_features(std::uint32_t a, std::uint32_t b, const Point& at) const;
  LocalSearch& search() { return search_; }
  MeshEdit& edit() { return edit_; }

 private:
  FeatureEdges::Collapse permitted(std::uint32_t a, std::uint32_t b) const;
  bool may_flip(std::uint32_t a, std::uint32_t b) const;
  bool judge_free(const Point& pa, const Point& pb, int power, bool in_place, Fit& fit);
  bool judge_in_place(const Point& pa, const Point& pb, int power, Fit& fit);
  bool is_in_place(const Point& at) const;
  bool judge_for_hoppe(const Point& pa, const Point& pb, Fit& fit);
  bool judge_along_feature(std::uint32_t a, std::uint32_t b, int power, Fit& fit);

  const DecimationState& state_;
  const Options& options_;
  LocalSearch search_;
  MeshEdit edit_;
};

}  // namespace emax
