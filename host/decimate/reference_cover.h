#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "host/decimate/assigned_points.h"
#include "host/decimate/mesh_edit.h"
#include "host/decimate/slot_tree.h"
#include "host/decimate/triangle_sheet.h"

namespace emax {

// Keeps every point of a reference surface, the insides of its triangles included, within a limit
// of a mesh while the mesh is edited (docs/numerics.md, "The reference within ε of the mesh").
//
// The distance to one triangle of the mesh is convex. A part of a reference triangle whose corners
// lie within the limit of one triangle of the mesh therefore lies within it altogether. Each
// triangle of the reference is cut into such parts: along the sides of the mesh's triangles where
// these lie over it as a sheet (SheetWalk), else between the triangles that its corners are near
// to. The cover records the triangles of the mesh that it rests on. An edit is permitted if every
// triangle of the reference that rests on a removed triangle can be proven again from the triangles
// around the edit. "Yes" is proven except for roundings of a few units in the last place of the
// coordinates, which the caller subtracts from the limit. "No" may also mean that the budget is
// spent.
//
// O(1) for most triangles of the reference that rest on removed triangles, else about linear in the
// triangles of the mesh that lie over them. Not for concurrent use.
class ReferenceCover {
 public:
  // Corners of `triangles` are indices into `points`. Both must outlive the cover.
  // `recalls`: an edit is also judged with the triangles of the mesh that a triangle of the
  // reference rested on before and that are still there. Where surfaces meet at an edge, as a
  // column and a floor do, the column's may not be around an edit on the floor.
  ReferenceCover(std::span<const Triangle> triangles, std::span<const Point> points,
                 double squared_limit, bool recalls = false);
  ~ReferenceCover();

  // Tries to prove every triangle of the reference for the mesh as it is. O(log n) a triangle.
  void begin(const EditableMesh& mesh, const SlotTree& tree);

  // Number of triangles of the reference that are not proven. The test of an edit ignores them.
  std::size_t unproven() const { return unproven_; }
  bool proven(std::uint32_t triangle) const { return first_of_[triangle] != kNoIndex; }

  // The vertex of the edit must already be in its new place in `mesh`. With `tolerant` the edit is
  // always permitted, and triangles that cannot be proven become unproven.
  bool permits(const EditableMesh& mesh, const AssignedPoints& assigned, const MeshEdit& edit,
               bool tolerant);

  // The data that undo() needs to undo an edit.
  struct Undo {
    std::vector<std::uint32_t> triangles;                           // of the reference
    std::vector<std::pair<std::uint32_t, std::uint32_t>> supports;  // and their slots
  };

  // Applies the edit last permitted; `placed` holds the slots of its added triangles.
  void apply(std::span<const std::uint32_t> placed, Undo* undo);
  void undo(const Undo& undo);
  // The triangles that the edit last permitted, with `tolerant`, leaves unproven.
  std::span<const std::uint32_t> given_up() const { return given_up_; }
  // Tries to prove a triangle of the reference again, with the whole mesh.
  bool prove(std::uint32_t triangle, const EditableMesh& mesh, const SlotTree& tree);

 private:
  // An entry in the lists of both: a triangle of the reference rests on one of the mesh.
  struct Support {
    std::uint32_t triangle, slot;
    std::uint32_t next_of_triangle;
    std::uint32_t next_of_slot, previous_of_slot;
  };
  struct Corner {
    Point at;
    std::uint32_t near;  // a triangle of the mesh within the limit
  };
  using Piece = std::array<Corner, 3>;
  class Around;

  bool prove_after(std::uint32_t triangle, const AssignedPoints& assigned, Around& around);
  bool prove_piece(const Piece& whole, Around& around);
  bool prove_thoroughly(const Piece& whole, Around& around);
  bool prove_parts(const Piece& whole, Around& around);
  bool follow(const TrianglePlane& plane, std::uint32_t from, Around& around);
  bool part_within(const TrianglePlane& plane, const std::vector<PlanarCorner>& part,
                   std::uint32_t id, Around& around);
  bool rests_on(const Piece& piece, std::uint32_t id, const Around& around) const;
  Corner labelled(const Point& at, std::initializer_list<std::uint32_t> likely,
                  Around& around) const;
  bool cover(const Piece& whole, Around& around);
  // Where a piece may be cut.
  struct Seam {
    std::uint32_t one = kNoIndex, other = kNoIndex;  // triangles of the mesh
    std::array<std::uint32_t, 2> edge{};             // that they share
    bool adjacent = false;
  };
  static Seam seam_under(const Piece& piece, const Around& around);
  static std::optional<std::array<double, 3>> sides_of_plane(const Piece& piece, const Seam& seam,
                                                             const Around& around);
  static std::array<double, 3> sides_by_distance(const Piece& piece, const Seam& seam,
                                                 const Around& around);
  bool cut(const Piece& piece, Around& around);
  bool cut(const Piece& piece, const Seam& seam, const std::array<double, 3>& side,
           double least_part, Around& around);
  bool halve(const Piece& piece, Around& around);
  void use(std::uint32_t id);
  void add_support(std::uint32_t triangle, std::uint32_t slot);
  void drop_supports(std::uint32_t triangle);

  std::span<const Triangle> triangles_;
  std::span<const Point> points_;
  double squared_limit_;
  bool recalls_;
  std::vector<Support> supports_;
  std::uint32_t free_ = kNoIndex;        // the free entries, a list through next_of_triangle
  std::vector<std::uint32_t> first_of_;  // of each triangle of the reference
  std::vector<std::uint32_t> first_at_;  // of each slot
  std::size_t unproven_ = 0;

  // Of the edit last permitted.
  std::vector<std::uint32_t> affected_, given_up_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> anew_;  // triangle and id

  // Scratch.
  std::unique_ptr<Around> around_;
  std::unique_ptr<SheetWalk<Around>> walk_;
  int cuts_ = 0;                 // made for the present triangle
  bool cuts_elsewhere_ = false;  // where a plane between two triangles cuts nothing
  std::vector<std::uint32_t> used_;
  std::vector<Corner> corners_;
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> answer_of_;  // of each point, in the edit; or kNoIndex
  std::vector<std::uint32_t> seen_;       // the last edit that tested each triangle
  std::uint32_t search_ = 0;
};

}  // namespace emax
