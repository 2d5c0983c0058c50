#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "host/decimate/hoppe_energy.h"
#include "host/decimate/joining_distance.h"
#include "host/decimate/plane_parts.h"
#include "host/geometry/triangle_mesh.h"

namespace emax {

// How a mesh is made manifold: by manifold_part() or by cut_to_manifold().
enum class MadeManifold { kByDropping, kByCutting };

// A surface that decimation can start from and is bounded by: a mesh made manifold, with the far
// points of the cloud inserted.
struct ReferenceSurface {
  TriangleMesh mesh;
  // The changes of the mesh: counts of CutSurface or of ManifoldPart.
  std::size_t merged = 0, turned = 0, dropped = 0, split = 0, cut_edges = 0, cut_vertices = 0;
  std::size_t inserted = 0;             // points that `far` names
  std::vector<std::uint32_t> left_out;  // those of them that could not be inserted
};

// `far`: with joining_distance() decimation has room from the start. Throws Error for a mesh
// without a usable triangle, a cloud without points, or a cloud that does not belong to the mesh:
// most of its points are farther from the mesh than a tenth of its width. `interrupted` is polled
// from time to time; true ends the work with the mesh reached so far.
ReferenceSurface reference_surface(const TriangleMesh& mesh, std::span<const Point> cloud,
                                   const JoiningDistance& far,
                                   const std::function<bool()>& interrupted = nullptr,
                                   MadeManifold how = MadeManifold::kByDropping,
                                   std::size_t threads = 1);

struct DecimatedMesh {
  TriangleMesh mesh;
  std::vector<std::uint32_t> left_out;  // points farther than epsilon from the start
  bool interrupted = false;
  // Where the work ended early because of the rival: the triangles that all of it would have left,
  // estimated. Otherwise 0.
  std::size_t expected = 0;
};

// What roundings of distances depend on.
struct DataExtent {
  double width = 0;     // of the reference
  double greatest = 0;  // the greatest coordinate
};
DataExtent extent_of(const TriangleMesh& reference, const TriangleMesh& start,
                     std::span<const Point> cloud);

struct DecimationSettings {
  double epsilon = 0;  // greatest distance of a point of the cloud from the mesh
  bool two_sided = true;
  double epsilon_back = 0;  // the same for points of the mesh and the reference; 0: epsilon

  enum class Effort {
    kSweep,     // only edge collapses far below the bounds; leaves a few times the fewest triangles
    kCollapse,  // all collapses within the bounds
    // Also relocations, flips, and the collapses that these make possible. Under a two-sided bound
    // with a reference that is smooth against it, first spreads the error evenly
    // (ErrorEquidistribution).
    kRelax,
    // Spreads the error evenly, on any reference and for longer. Where that gains little, and with
    // kRelax where at most 400 triangles are left: like kRelax until nothing is gained, from
    // several local minima of the energy.
    kDeep,
  } effort = Effort::kRelax;
  // With kCollapse: for a mesh that is decimated further, which ends with fewer triangles where an
  // edge that was refused once stays.
  bool leaves_room = false;

  // Of the whole that a tile belongs to, so that all tiles have the same limits; zeros: its own.
  DataExtent extent;

  double normal_cosine = 0.2;  // least, between a triangle and the one it replaces
  double flatness = 1e-3;      // least height of a new triangle over its longest side

  // In degrees, 0 for none. Edges of the start over which its normals turn by more are features.
  // Each vertex of a feature keeps a feature edge within epsilon, and the corners where features
  // meet or end (VertexClass) stay in place.
  double feature_angle = 0;

  enum class Objective {
    kFewest,  // triangles
    kHoppe,   // least energy of Hoppe within the same bounds; ignores `effort`
  } objective = Objective::kFewest;
  // Whether nothing follows the collapses, so that all that can be made are.
  bool ends_with_collapses() const {
    return objective == Objective::kFewest && effort == Effort::kCollapse && !leaves_room;
  }
  HoppeWeights hoppe;

  // Planes, and curved shapes, that parts of the start follow, if any. A vertex amid triangles of
  // one of them lies on it, one between two on their line, one between three at their corner, where
  // the bounds permit that.
  std::shared_ptr<const PlaneParts> planes = nullptr;
  // With planes: spreads the error evenly as without them. This leaves fewer triangles on smooth
  // surfaces, and edges between a plane and a curved surface less near to the true ones.
  bool spread_on_planes = false;
  // With planes: spreads the error on them, also decimates without them, and takes the mesh with
  // fewer triangles.
  bool without_planes_too = false;

  // Where the start has vertices that stay, with the triangles between three and the edges between
  // two of them.
  std::vector<Point> fixed;

  std::size_t threads = 1;  // the result is the same for any number

  // Polled from time to time; true ends the work with the mesh reached so far, which is valid and
  // within the bounds.
  std::function<bool()> interrupted = nullptr;
  // Triangles of a mesh that the result is to beat; 0: none. Where the passes that are left will
  // hardly leave fewer (Race), the work ends with the mesh reached so far.
  std::size_t rival = 0;
  // Called after each pass with its name, the number of edits and the triangles left.
  std::function<void(const char*, std::size_t, std::size_t)> progress = nullptr;
  // Called from time to time with an estimate of the share of the work that is done, from 0 to 1,
  // and the triangles left. With kDeep the time of the last part is not known.
  std::function<void(double, std::size_t)> advanced = nullptr;
  // Called once in long work, of TiledDecimator alone, with a mesh within the bounds.
  std::function<void(DecimatedMesh)> early = nullptr;
};

// Decimation under a certified bound: as few triangles as can be found such that every point of the
// cloud lies within epsilon of the mesh, and every point of the mesh, the insides of its triangles
// included, within epsilon_back of the reference. Points of the cloud that were too far at the
// start are excepted. The result is manifold and consistently oriented, has the topology of the
// start, and no self-intersections or slivers. All of this holds after every edit; spreading
// the error evenly loosens the limits for a time and keeps the last mesh within them.
//
// Under a two-sided bound every point of the reference, the insides of its triangles included, also
// stays within epsilon of the mesh (ReferenceCover).
//
// Each triangle answers for the points of the cloud nearest to it; under a two-sided bound the
// reference's vertices and the middles of its long edges count as points. The energy is the sum
// over these points of (distance / epsilon)^4. An edge collapse puts its vertex where the energy is
// least, by reweighted least squares from the optimum of the planes' quadrics. Collapses are made
// in the order of the increase of the energy, the least first. A collapse is made if all points
// stay within epsilon of the new triangles, the new triangles stay within epsilon_back of the
// reference (BackBound), and nothing intersects. Vertices are then relocated and edges flipped to
// lower the energy. At last, collapses that break the bound are tried; they are undone unless
// relocations and flips around them restore the bound.
//
// While errors are far below epsilon, collapses are made in sweeps along a space-filling curve. The
// edges of one sweep do not touch.
//
// The same input and settings give the same bytes. About O(n log n) in the triangles of the start.
// Data that depend only on the reference and the cloud are kept from run to run. Not for concurrent
// use.
class BoundedDecimator {
 public:
  // `reference` is as reference_surface() gives it. It and the cloud must outlive the decimator.
  // Under a two-sided bound its first `covered` triangles stay near the mesh.
  BoundedDecimator(const TriangleMesh& reference, std::span<const Point> cloud,
                   std::size_t covered = ~std::size_t{0})
      : reference_(reference),
        cloud_(cloud),
        covered_(std::min(covered, reference.triangles.size())) {}

  // Throws Error for an epsilon that is not positive or within roundings of the coordinates.
  DecimatedMesh run(const DecimationSettings& settings) const { return run(reference_, settings); }

  // Starts from another mesh, as manifold_part() gives it. Where that mesh breaks the back bound,
  // the result may break it, too.
  DecimatedMesh run(const TriangleMesh& start, const DecimationSettings& settings) const;

 private:
  friend class DecimationSequence;
  struct Prepared;

  DecimatedMesh run_twice(const TriangleMesh& start, const DecimationSettings& settings) const;
  const Prepared& prepared(double limit, double back_limit) const;
  // If `reach` exceeds epsilon, points up to `reach` from the start hold collapses back, too.
  DecimatedMesh run(const TriangleMesh& start, const DecimationSettings& settings,
                    double reach) const;

  const TriangleMesh& reference_;
  std::span<const Point> cloud_;
  std::size_t covered_;
  mutable std::shared_ptr<Prepared> prepared_;
};

}  // namespace emax
