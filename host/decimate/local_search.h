#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "host/decimate/decimation_state.h"
#include "host/decimate/edge_samples.h"
#include "host/decimate/local_distance.h"
#include "host/decimate/shape_place.h"

namespace emax {

// The rating of an edit. Its energy is the sum over its points of (distance / epsilon)^power.
struct Fit {
  Point position = Point::Zero();
  double energy = 0;
  double worst = 0;  // greatest squared distance / epsilon^2
};

// Finds the best form of one local edit of a state: prepare an edit, fit it, take its MeshEdit.
// Distances are those to the edit's own triangles. Only for points beyond the limit the triangles
// around the edit are also tried. Several threads may search in one state, each for itself.
class LocalSearch {
 public:
  struct Options {
    int power = 4;          // of the energy, even
    int steps = 4;          // at most, of reweighted least squares
    double gain = 0.02;     // the least share of the energy that a step gains for another to follow
    bool in_place = false;  // the vertex stays in place()
  };

  // The energy includes `spring` times the edges' squared lengths, in units of epsilon^2.
  explicit LocalSearch(const DecimationState& state, double spring = 0,
                       const KnownEdges* known = nullptr)
      : state_(state), spring_(spring), samples_(state, known) {}

  // How a vertex approaches its optimum. kReweighted: least squares, weighted so that they
  // approximate the sum of powers, with a fixed damping. kNewton: Newton's steps on the sum of
  // powers with Levenberg's damping, which reach the optimum of high powers; the mesh's edges then
  // count too (EdgeSamples).
  enum class Steps { kReweighted, kNewton };
  void use(Steps steps);

  // Each returns false where the topology forbids the edit.
  bool prepare_collapse(std::uint32_t a, std::uint32_t b);  // b is drawn into a
  bool prepare_relocation(std::uint32_t vertex);
  bool prepare_flip(std::uint32_t a, std::uint32_t b);
  // `middle` is a vertex that no triangle has, at a place to start from.
  bool prepare_split(std::uint32_t a, std::uint32_t b, std::uint32_t middle);
  bool prepare_split(std::uint32_t slot, std::uint32_t middle);

  // The present energy of the points of the prepared edit.
  double energy_before(int power) const;

  // Where the prepared edit's vertex is on the shapes that its triangles follow; nothing where they
  // follow none, or shapes that share no place.
  const std::optional<ShapePlace>& place() const { return place_; }

  // A position to start from: the optimum of the planes' quadrics.
  Point quadric_optimum() const;

  // The best position found from `start`, which may be `start` itself; returns false if no shape
  // was permitted.
  bool fit(const Point& start, const Options& options, Fit& best);
  // The energy of a given position, or of a flip; returns false if the shape is not permitted or
  // the energy is not below `most`.
  bool evaluate(const Point& position, int power, Fit& result,
                double most = std::numeric_limits<double>::infinity());

  // Fills the edit for the position last evaluated or fitted. Returns false if the shape is not
  // permitted or, with `limit`, if a point is beyond the limit.
  bool finish(const Fit& fit, bool limit, MeshEdit& edit);

  // Greatest squared distance / epsilon^2 that a triangle answers for: of its points, its vertices
  // and its edges.
  double worst_of(std::uint32_t slot);

  // The edges that were looked at and that `known` did not know.
  KnownEdges::Map& fresh() { return samples_.fresh(); }

  // Whether the mesh is still about as fine as the cloud here. Errors are then far from the limit,
  // and one good position is enough.
  bool fine() const { return ids_.size() < 3 * added_.size(); }

 private:
  void begin(std::uint32_t vertex, std::uint32_t other);
  void replace(std::uint32_t slot, std::uint32_t corner);  // `corner` becomes the moving vertex
  void take_place();
  void take_points();
  void choose_guiding_points();
  void take_edges();
  double spring_after(const Point& position) const;
  bool shape(const Point& position);
  bool measure_at(const Point& position, int power, double most, Fit& fit);
  bool step(const Options& options, double damping, Fit& at) const;
  bool fit_by_newton(const Options& options, Fit& best);
  double share_of_middle(const std::array<Point, 3>& corners, std::uint32_t near) const;
  bool middles_are_near(const Point& position) const;
  bool answer(std::span<const std::uint32_t> ids, LocalPoints& points, bool limit,
              MeshEdit& edit) const;
  bool answer(std::span<const std::uint32_t> ids, bool limit, MeshEdit& edit);
  bool answer_all(bool limit, MeshEdit& edit);
  bool serve_elsewhere(std::uint32_t point, MeshEdit::Answer& answer) const;

  const DecimationState& state_;
  const double spring_;
  Steps steps_ = Steps::kReweighted;
  EdgeSamples samples_;
  double lengths_before_ = 0;        // squared, of the edges that change
  std::vector<std::uint32_t> ring_;  // neighbours of the moving vertex, or a flipped edge
  std::vector<std::uint32_t> other_ring_;
  std::uint32_t vertex_ = kNoIndex;
  std::uint32_t other_ = kNoIndex;  // the vertex that is drawn in
  std::vector<std::uint32_t> removed_;
  std::vector<Triangle> added_;  // the moving vertex first
  std::vector<Point> normals_;   // of the triangles that `added_` replaces
  std::optional<ShapePlace> place_;
  std::vector<std::uint32_t> ids_;  // of the guides among the points of the edit
  bool watch_back_ = false;         // whether the moving vertex's distance to the reference counts
  std::vector<std::uint32_t> others_;  // scratch: the points of the edit that are no guides
  LocalPoints points_;
  std::vector<std::uint32_t> guiding_ids_;  // of the points that the energy is a sum over
  LocalPoints guiding_;
  BackBound::Sight sight_;  // of the moving vertex at the position last measured
  std::vector<LocalFrame> frames_;
};

}  // namespace emax
