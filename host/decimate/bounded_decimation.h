#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "host/decimate/hoppe_energy.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

// How a mesh becomes manifold: by manifold_part() or by cut_to_manifold().
enum class MadeManifold { kByDropping, kByCutting };

// A surface that decimation may start from and be held to: a mesh made manifold, with the far
// points of the cloud inserted.
struct ReferenceSurface {
  TriangleMesh mesh;
  // What became of the mesh: counts of CutSurface, or of ManifoldPart.
  std::size_t merged = 0, turned = 0, dropped = 0, split = 0, cut_edges = 0, cut_vertices = 0;
  std::size_t inserted = 0;             // points that were farther than `far`
  std::vector<std::uint32_t> left_out;  // points that still are, and could not be inserted
};

// `far`: epsilon / 2 leaves decimation room at once. Throws Error for a mesh without a usable
// triangle, a cloud without points, or one that does not belong to the mesh: most of its points
// are farther from it than a tenth of its width. `interrupted` is polled now and then; true ends
// the work with the mesh at hand.
ReferenceSurface reference_surface(const TriangleMesh& mesh, std::span<const Point> cloud,
                                   double far, const std::function<bool()>& interrupted = nullptr,
                                   MadeManifold how = MadeManifold::kByDropping);

struct DecimationSettings {
  double epsilon = 0;  // every point of the cloud stays within this of the mesh,
  bool two_sided = true;
  double epsilon_back = 0;  // and every point of the mesh within this of the reference; 0: epsilon

  enum class Effort {
    kSweep,     // edge collapses far below the bounds, which leave a few times the fewest triangles
    kCollapse,  // and the others
    kRelax,     // and vertices relocated, edges flipped, collapses that these make possible
    kDeep,      // the same until nothing is gained, from several local minima of the energy; so
                // does kRelax where at most 400 triangles are left
  } effort = Effort::kRelax;

  double normal_cosine = 0.2;  // least, between a triangle and the one that it replaces
  double flatness = 1e-3;      // least height of a new triangle over its longest side

  // In degrees; over 0, edges of the start over which its normals turn by more are features: they
  // and the corners where they meet or end stay (VertexClass).
  double feature_angle = 0;

  enum class Objective {
    kFewest,  // triangles
    kHoppe,   // the least of Hoppe's energy, within the same bounds; `effort` does not matter
  } objective = Objective::kFewest;
  HoppeWeights hoppe;

  // Polled now and then; true ends the work with the mesh at hand, which is valid and within the
  // bounds.
  std::function<bool()> interrupted = nullptr;
  // Called after each pass with its name, how many edits it made and the triangles left.
  std::function<void(const char*, std::size_t, std::size_t)> progress = nullptr;
  // Called now and then with a guess at the share of the work that is done, from 0 to 1, and the
  // triangles left; with kDeep, how long the end takes is not known.
  std::function<void(double, std::size_t)> advanced = nullptr;
};

struct DecimatedMesh {
  TriangleMesh mesh;
  std::vector<std::uint32_t> left_out;  // points farther than epsilon from the mesh it started from
  bool interrupted = false;
};

// Decimation under a certified bound: as few triangles as can be found such that every point of the
// cloud, but for those that were too far at the start, lies within epsilon of the mesh and every
// point of the mesh, the inside of its triangles included, within epsilon_back of the reference.
// The result is manifold and consistently oriented, of the topology of the start, without
// self-intersections or slivers. All of it holds after every edit.
//
// Under a two-sided bound every point of the reference, the inside of its triangles included, also
// stays within epsilon of the mesh (ReferenceCover).
//
// Each triangle answers for the points of the cloud nearest to it, under a two-sided bound also for
// the reference's vertices and the middles of its long edges. An edge collapse puts its vertex
// where the sum over the points around it of (distance / epsilon)^4 is least, by reweighted least
// squares from the optimum of the planes' quadrics, and is made, least increase first, if all of
// these points stay within epsilon of the new triangles, those within epsilon_back of the reference
// (BackBound), and nothing intersects. Vertices are then relocated and edges flipped to lower the
// sum, and collapses that break the bound are tried and undone unless relocations and flips around
// mend it.
//
// While errors are far below epsilon, collapses are made in sweeps along a space-filling curve,
// each of edges that do not touch.
//
// Same input and settings, same bytes. About O(n log n) in the triangles of the start. What depends
// on the reference and the cloud alone is kept from run to run; not for concurrent use.
class BoundedDecimator {
 public:
  // `reference` is as reference_surface() gives it; it and the cloud outlive the decimator.
  BoundedDecimator(const TriangleMesh& reference, std::span<const Point> cloud)
      : reference_(reference), cloud_(cloud) {}

  // Throws Error for an epsilon that is not positive or within roundings of the coordinates.
  DecimatedMesh run(const DecimationSettings& settings) const { return run(reference_, settings); }

  // From another mesh, as manifold_part() gives it. Where that one breaks the back bound the result
  // may too.
  DecimatedMesh run(const TriangleMesh& start, const DecimationSettings& settings) const;

 private:
  friend class DecimationSequence;
  struct Prepared;

  const Prepared& prepared(double limit, double back_limit) const;
  // Points up to `reach` from the start, if that is more than epsilon, keep collapses off.
  DecimatedMesh run(const TriangleMesh& start, const DecimationSettings& settings,
                    double reach) const;

  const TriangleMesh& reference_;
  std::span<const Point> cloud_;
  mutable std::shared_ptr<Prepared> prepared_;
};

}  // namespace emax
