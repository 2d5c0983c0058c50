#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <queue>
#include <vector>

#include "host/decimate/edit_proposer.h"
#include "host/decimate/independent_edits.h"

namespace emax {

// The passes of bounded decimation over a state. Each pass keeps every point within the limit that
// was within it, and is a pure function of the state. Ties go to the lower vertex numbers.
//
// Edits are proposed by several threads and made by one. Relocations and flips are proposed in
// batches that do not touch each other, so that the number of threads changes no byte.
class DecimationPasses {
 public:
  // Called from time to time with the share of the present pass that is done, from 0 to 1. True
  // ends the pass after the present edit.
  using Poll = std::function<bool(double)>;
  static constexpr int kPower = EditProposer::kPower;
  using Options = EditProposer::Options;
  DecimationPasses(DecimationState& state, Options options, std::size_t threads, Poll poll);

  // Edge collapses far below the limit, in sweeps over the mesh, until a sweep gains little. The
  // edges of a sweep do not touch. The new vertex is the optimum of the planes' quadrics. Returns
  // the number of collapses.
  std::size_t sweep();
  // Edge collapses, the one that adds least to the energy first, until the limit and the guards
  // permit no more. With `again` what was refused is tried again where the mesh has changed since,
  // once the others are done. Returns the number of collapses.
  std::size_t collapse(bool again = false);
  // Rounds of collapses, flips and relocations that lower Hoppe's energy (power 2). Ends after
  // eight rounds, or after one without a collapse in which the other edits are fewer than one for
  // each hundred triangles. Returns the number of edits.
  std::size_t descend();
  // Moves each vertex to where the energy of its points is least. Returns the number of moved
  // vertices.
  std::size_t relocate(int power);
  // Moves vertices onto the planes that the triangles around them follow, or half, a quarter or an
  // eighth of the way there if the limits do not permit all of it. Returns the number of moved
  // vertices.
  std::size_t move_into_place();
  // Moves vertices so that the true edges, of the options, are nearer to those of the mesh. Returns
  // the number of moved vertices.
  std::size_t move_toward_edges();
  bool has_true_edges() const { return !options_.true_edges.empty(); }
  // Flips each edge whose flip lowers the energy. Returns the number of flips.
  std::size_t flip(int power);
  // Tries collapses that break the limit, and relocates vertices and flips edges around them to
  // restore it. Collapses that still break it are undone. Returns the number of collapses that
  // stay.
  std::size_t collapse_and_mend();

  // The passes that ErrorEquidistribution uses (equidistribution_passes.cpp).

  // Greatest squared distance / limit^2 that each triangle answers for: of its points, its vertices
  // and its edges.
  std::vector<double> worst_of(const std::vector<std::uint32_t>& slots);
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

  void use(LocalSearch::Steps steps);
  const FeatureEdges& features() const { return options_.features; }
  // No edit but a split changes a triangle at these, until free() is called or the passes restart.
  struct Place {
    Point at;
    double radius;
  };
  void hold_around(const std::vector<Place>& places);
  void free() { options_.held.clear(); }
  // After a restored state: these are its features, and steps are as at first.
  void restart(const FeatureEdges& features);

  // The triangles with a corner that is not fixed.
  std::vector<std::uint32_t> free_slots() const;

  bool stopped() const { return stopped_; }

 private:
  using Collapse = EditProposer::Collapse;
  using Edge = std::array<std::uint32_t, 2>;

  using Share = std::array<double, 2>;  // of the present pass, from and to
  using Part = std::optional<Share>;    // none for what is too short to be told of

  void mark_fixed();
  bool poll_now(double done);
  bool poll(double done);
  bool poll(std::size_t at, std::size_t of);
  // What one of the threads found.
  struct Found {
    bool any = false;
    MeshEdit edit;
    DecimationState::BackVerdict back;
    KnownEdges::Map looked_at;
  };
  using Propose = std::function<bool(EditProposer&, std::size_t)>;
  using Make = std::function<void(const MeshEdit&, DecimationState::BackVerdict&)>;
  void propose_batch(std::size_t first, std::size_t last, std::size_t threads,
                     const Propose& propose, const Make& make);
  void propose_each(std::size_t count, const Part& part, const Propose& propose,
                    const Make& make = nullptr);
  template <class Item, class ProposeItem>
  std::size_t edit_each(std::vector<Item> items, const Share& share, const ProposeItem& propose);
  std::size_t flip_each(std::vector<Edge> edges, int power, const Share& share);
  std::size_t relocate_each(std::vector<std::uint32_t> vertices, int power, const Share& share);
  // A place of a triangle and the point of the reference or the cloud that it should be near.
  struct Witness {
    std::array<double, 3> at{};  // barycentric
    Point wanted = Point::Zero();
    double share = 0;  // squared distance / limit^2
  };
  Witness worst_place(std::uint32_t slot) const;
  double energy_of(std::uint32_t slot, double worst, int power) const;
  using Judge = std::function<bool(EditProposer&, const Edge&, Collapse&)>;
  std::vector<Collapse> judge_each(const std::vector<Edge>& edges, const Part& part,
                                   const Judge& judge);
  std::vector<Collapse> judge_each(const std::vector<Edge>& edges, const Part& part, int power);
  std::vector<Edge> cheapest_collapses(std::size_t most, int power);
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
  void make_collapse(std::uint32_t a, std::uint32_t b);
  void push(const std::vector<Edge>& edges, const Part& part);
  bool try_plain_collapse(std::uint32_t a, std::uint32_t b, double most);
  bool apply_collapse(const Collapse& collapse);
  bool settled();
  void apply(bool keep_undo);
  bool mend(std::uint32_t vertex);
  bool all_within(const std::vector<std::uint32_t>& points) const;
  std::vector<Edge> edges() const;
  std::vector<Edge> take_changed();

  DecimationState& state_;
  Options options_;
  Poll poll_;
  KnownEdges known_;
  std::vector<EditProposer> proposers_;  // of each thread
  LocalSearch& search_;                  // of the thread that makes the edits
  MeshEdit& edit_;
  std::vector<Found> batch_;
  IndependentEdits independent_;
  std::uint32_t spare_ = kNoIndex;  // a vertex that no triangle has
  std::priority_queue<Collapse> queue_;
  struct Refused {
    Edge edge;
    std::uint64_t stamp;  // the last edit before
  };
  std::vector<Refused> refused_;
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
