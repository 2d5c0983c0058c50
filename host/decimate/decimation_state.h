#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/decimate/assigned_points.h"
#include "host/decimate/back_bound.h"
#include "host/decimate/editable_mesh.h"
#include "host/decimate/local_distance.h"
#include "host/decimate/mesh_edit.h"
#include "host/decimate/reference_cover.h"
#include "host/decimate/slot_tree.h"
#include "host/features/shapes.h"

namespace emax {

// The data that undo() needs to undo an edit.
struct EditUndo {
  struct Slot {
    std::uint32_t slot;
    Triangle before;  // kNoIndex for a free slot
  };
  std::uint32_t vertex = kNoIndex;
  Point position = Point::Zero();
  BackBound::Sight sight;
  std::vector<Slot> slots;
  std::vector<MeshEdit::Answer> answers;  // only `slot` is set
  ReferenceCover::Undo cover;
};

// The mesh, the points that each triangle answers for, and the trees that the tests of edits use.
// apply() and undo() keep them consistent.
class DecimationState {
 public:
  struct Guards {
    double normal_cosine = 0.2;  // least, between a triangle and the one it replaces
    double flatness = 1e-3;      // least height of a triangle over its longest side
    double squared_reach = 0;    // if over the limit: points up to this far have a triangle
    bool recalls = false;        // ReferenceCover
    std::size_t guides = 1;      // one point in so many guides searches (AssignedPoints)
    std::size_t threads = 1;     // that find the nearest triangles; change no byte
  };

  // `mesh` is manifold and consistently oriented, without degenerate triangles. Where triangles
  // meet, edits do not increase the number of such pairs. `back` may be null, and must outlive the
  // state. Points farther than `squared_limit` from the mesh belong to no triangle. `reference`
  // holds triangles between points of the cloud: every edit keeps those of them within the limit of
  // the mesh that are within it at first. `interrupted` is polled from time to time; true leaves
  // the other points without a triangle.
  using Interrupted = std::function<bool()>;
  DecimationState(const TriangleMesh& mesh, std::span<const Point> cloud, const BackBound* back,
                  double squared_limit, const Guards& guards,
                  const Interrupted& interrupted = nullptr,
                  std::span<const Triangle> reference = {});

  const EditableMesh& mesh() const { return mesh_; }
  const AssignedPoints& assigned() const { return assigned_; }
  const SlotTree& tree() const { return tree_; }
  // Those of the cloud, then the witnesses.
  const Point& point(std::uint32_t i) const { return points_[i]; }
  std::span<const Point> cloud() const { return cloud_; }
  // The normal of the triangle in a slot; its length is twice the triangle's area.
  const Point& area_normal(std::uint32_t slot) const { return area_normals_[slot]; }
  const BackBound* back() const { return back_; }
  const BackBound::Sight& sight(std::uint32_t vertex) const { return sight_[vertex]; }
  double squared_limit() const { return squared_limit_; }

  // While the limits are loosened, points may go to `factor` > 1 times the limit and vertices to
  // `back_factor` times the back bound. The insides of triangles, of the mesh and of the reference,
  // are not tested then. Points that are no guides have no triangle until attach_others().
  void loosen(double factor, double back_factor);
  bool loosened() const { return permitted_ > 1; }
  // The greatest squared distance / limit^2 that points may have, 1 unless loosened.
  double permitted() const { return permitted_; }
  // Ends loosening. What is beyond its limit may stay as far, and edits do not increase the number
  // of triangles that break the back bound. O((triangles + points) log triangles).
  void tighten();
  // Until attach_others(), points that are no guides have no triangle. O(points).
  void detach_others();
  // Every point has a triangle again, one within the limit where there is one. Those beyond the
  // limit become guides; returns how many did. O(points log triangles), or O(1) where all points
  // are guides.
  std::size_t attach_others();
  // Every point, triangle and triangle of the reference has to keep its limit from now on. Returns
  // false, and changes nothing, where some do not. O(points + triangles).
  bool keep_limits();
  // Finds out which triangles break the back bound. Edits keep this up to date unless the limits
  // are loosened. O(triangles log triangles of the reference).
  void test_back_bound();
  bool breaks_back_bound(std::uint32_t slot) const {
    return slot < breaks_back_.size() && breaks_back_[slot] != 0;
  }
  bool permits_point(std::uint32_t point, double squared) const {
    return squared <= permitted_ * squared_limit_ ||
           (may_stay_beyond_ && squared <= assigned_.squared_distance(point));
  }

  const Guards& guards() const { return guards_; }

  // Shapes that parts of the mesh follow, and the number of each slot's shape, kNoIndex for none.
  // Edits leave each slot its shape, and parts of a triangle that is split have its shape.
  void follow(std::vector<Shape> shapes, std::vector<std::uint32_t> shape_of);
  bool follows_shapes() const { return !shape_of_.empty(); }
  std::uint32_t shape_of(std::uint32_t slot) const {
    return slot < shape_of_.size() ? shape_of_[slot] : kNoIndex;
  }
  const Shape& shape(std::uint32_t number) const { return shapes_[number]; }
  std::span<const Shape> shapes() const { return shapes_; }

  // Whether every point was assigned. False after an interrupt.
  bool complete() const { return complete_; }

  // Whether the triangle is not a sliver; false for a frame that is not finite.
  bool well_shaped(const LocalFrame& f) const {
    const double longest = std::max({f.length12, f.edge13.length, f.edge23.length});
    return f.length12 * f.edge13.length * f.edge13.direction.y >
           guards_.flatness * longest * longest;
  }

  // Whether the added triangles keep the back bound, the triangles of the reference stay within the
  // limit, and no more pairs of triangles meet than before. Points are not checked. With
  // `tolerant`, triangles of the reference may go beyond the limit; given_up() then lists them, and
  // prove() can prove them again.
  bool permits(const MeshEdit& edit, bool tolerant = false) {
    return permits(edit, judge_back(edit, 0), tolerant);
  }
  // The part of it that is about the back bound. It reads the mesh around the edit alone. Safe for
  // concurrent use by threads of different numbers, below that of use_threads().
  struct BackVerdict {
    bool keeps = true;
    BackBound::Sight moved;         // of the vertex's new position
    std::vector<char> added_break;  // of each added triangle
  };
  void use_threads(std::size_t threads);  // 1 at first
  BackVerdict judge_back(const MeshEdit& edit, std::size_t thread) const;
  // With what judge_back() gave, since when nothing has changed that it reads.
  bool permits(const MeshEdit& edit, BackVerdict back, bool tolerant = false);
  std::span<const std::uint32_t> given_up() const {
    return cover_ ? cover_->given_up() : std::span<const std::uint32_t>{};
  }
  bool prove(std::uint32_t reference_triangle) {
    return cover_->prove(reference_triangle, mesh_, tree_);
  }
  // Until prove_deferred(), the insides of the reference's triangles are not tested.
  void defer_proofs() { cover_.reset(); }
  // Returns whether all of them are proven. O(n log n).
  bool prove_deferred() {
    cover_reference();
    return unproven() == 0;
  }
  // Tries to prove every triangle of the reference that is not proven.
  void prove_all();
  // Makes a point of the farthest of 45 places on each triangle of the reference that is not
  // proven, if that is beyond the limit. Edits then bring the mesh near it. Returns the number of
  // points. O(log n) a place.
  std::size_t add_witnesses();
  // The triangles that answer for the corners of those that are not proven; sorted.
  std::vector<std::uint32_t> around_unproven() const;
  // Number of triangles of the reference that are not proven to be within the limit.
  std::size_t unproven() const { return cover_ ? cover_->unproven() : 0; }

  // Applies the edit that was last permitted.
  void apply(const MeshEdit& edit, EditUndo* undo = nullptr);
  void undo(const EditUndo& undo);

  // Assigns every point to its nearest triangle; returns false after an interrupt.
  bool reassign(const Interrupted& interrupted = nullptr);

  // A state to come back to. Numbers of vertices and slots stay valid; later witnesses are gone.
  struct Snapshot {
    EditableMesh mesh;
    AssignedPoints assigned;
    std::vector<BackBound::Sight> sight;
    std::vector<std::uint32_t> shape_of;
  };
  Snapshot snapshot() const { return {mesh_, assigned_, sight_, shape_of_}; }
  // Every limit holds as in the snapshot, which was taken without loosened limits. O(n log n).
  void restore(const Snapshot& snapshot);

  std::uint32_t add_vertex(const Point& at);
  // Moves a vertex that no triangle has to a place near another vertex.
  void place_vertex(std::uint32_t vertex, const Point& at, std::uint32_t near);

 private:
  // An added triangle as it is tested against others.
  struct Tested {
    SlotTree::Box box;
    Point corner, normal;
    double roundings;  // bound of the rounding of normal times distance, divided by the distance
  };
  SlotTree::Nearest nearest_of(std::uint32_t point, std::uint32_t hint) const;
  bool keeps_back_bound(const MeshEdit& edit, BackVerdict& verdict, std::size_t thread) const;
  void cover_reference();
  bool meets_another(const MeshEdit& edit);
  bool meets_itself(const MeshEdit& edit) const;
  std::size_t crossings(std::span<const Triangle> triangles,
                        std::span<const std::uint32_t> removed) const;
  void take_area_normals();
  void take_shapes(const MeshEdit& edit);
  void changed(std::uint32_t slot);

  EditableMesh mesh_;
  std::span<const Point> cloud_;
  std::vector<Point> points_;
  const BackBound* back_;
  double squared_limit_;
  double permitted_ = 1, permitted_back_ = 1;  // squared distance / limit^2
  bool may_stay_beyond_ = false;               // what is beyond its limit
  bool guides_alone_ = false;                  // the others have no triangle
  Guards guards_;
  std::span<const Triangle> reference_;
  AssignedPoints assigned_;
  SlotTree tree_;
  std::optional<ReferenceCover> cover_;
  std::vector<Point> area_normals_;  // of each slot
  std::vector<Shape> shapes_;
  std::vector<std::uint32_t> shape_of_;  // of each slot; empty where no shapes are followed
  bool complete_ = false;
  std::vector<BackBound::Sight> sight_;                       // of each vertex
  std::vector<std::shared_ptr<BackBound::Search>> searches_;  // of each thread
  BackVerdict judged_;                                        // of the edit last permitted
  std::vector<char> breaks_back_;      // of each slot; empty where all keep the bound
  std::vector<std::uint32_t> placed_;  // scratch: slots of the added triangles
  std::vector<Tested> tested_;
  std::vector<Triangle> removed_;
};

}  // namespace emax
