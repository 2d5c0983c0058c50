#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/decimate/decimation_state.h"
#include "host/decimate/local_distance.h"

namespace emax {

// How an edit would fare: its energy is the sum over its points of (distance / epsilon)^power.
struct Fit {
  Point position = Point::Zero();
  double energy = 0;
  double worst = 0;  // greatest squared distance / epsilon^2
};

// Finds the best form of one local edit of a state: prepare one, fit it, take its MeshEdit.
// Distances are those to the edit's own triangles; only points beyond the limit also look at the
// triangles around them.
class LocalSearch {
 public:
  struct Options {
    int power = 4;       // of the energy, even
    int steps = 4;       // of reweighted least squares at most
    double gain = 0.02;  // the share of the energy that a step must gain for another to follow
  };

  // `spring` times the edges' squared lengths is part of the energy, in units of epsilon^2.
  explicit LocalSearch(const DecimationState& state, double spring = 0)
      : state_(state), spring_(spring) {}

  // Each false when the topology forbids the edit.
  bool prepare_collapse(std::uint32_t a, std::uint32_t b);  // b is drawn into a
  bool prepare_relocation(std::uint32_t vertex);
  bool prepare_flip(std::uint32_t a, std::uint32_t b);

  // The sum as it stands, over the points of the edit prepared.
  double energy_before(int power) const;

  // Positions to start from.
  Point quadric_optimum() const;

  // The best position found from `start`, which counts itself; false when no shape was permitted.
  bool fit(const Point& start, const Options& options, Fit& best);
  // Energy of a position, or of a flip, as it is.
  bool evaluate(const Point& position, int power, Fit& result);

  // Fills the edit for the position last evaluated or fitted; `limit`: whether every point has to
  // come within the limit, and then false when one does not.
  bool finish(const Fit& fit, bool limit, MeshEdit& edit);

  // Whether the mesh is still about as fine as the cloud here: then errors are far from the limit,
  // and one good position is enough.
  bool fine() const { return ids_.size() < 3 * added_.size(); }

 private:
  void begin(std::uint32_t vertex, std::uint32_t other);
  void replace(std::uint32_t slot, std::uint32_t corner);  // which becomes the moving vertex
  void take_points();
  void take_edges();
  double spring_after(const Point& position) const;
  bool shape(const Point& position);
  Fit measured(const Point& position, int power);
  bool step(const Options& options, Fit& at) const;
  bool serve_elsewhere(std::uint32_t point, MeshEdit::Answer& answer) const;

  const DecimationState& state_;
  const double spring_;
  double lengths_before_ = 0;        // squared, of the edges that change
  std::vector<std::uint32_t> ring_;  // the vertices joined to the moving one, or a flipped edge's
  std::vector<std::uint32_t> other_ring_;
  std::uint32_t vertex_ = kNoIndex;
  std::uint32_t other_ = kNoIndex;  // the vertex drawn in
  std::vector<std::uint32_t> removed_;
  std::vector<Triangle> added_;     // the moving vertex first
  std::vector<Point> normals_;      // of the triangles they replace
  std::vector<std::uint32_t> ids_;  // of the points
  bool watch_back_ = false;         // whether the vertex counts as a point of the reference
  LocalPoints points_;
  BackBound::Sight sight_;  // of the moving vertex where it was last measured
  std::vector<LocalFrame> frames_;
};

}  // namespace emax
