#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax {

inline constexpr std::uint32_t kNoIndex = ~0u;

// A manifold triangle mesh that is edited in place. Triangles are stored in slots; those of a
// vertex form a list through their corners. Slots and vertices keep their numbers; compact() skips
// free ones. Every operation costs O(triangles around the vertices it names). Several threads
// may read at once.
class EditableMesh {
 public:
  explicit EditableMesh(const TriangleMesh& mesh);

  std::size_t slots() const { return triangles_.size(); }
  std::size_t vertex_slots() const { return positions_.size(); }
  std::size_t triangles() const { return alive_; }

  // Whether the mesh had no boundary at first. Edits keep the topology, so it never gets one then.
  bool closed() const { return closed_; }

  bool alive(std::uint32_t slot) const { return triangles_[slot][0] != kNoIndex; }
  bool used(std::uint32_t vertex) const { return first_[vertex] != kNoIndex; }
  std::vector<std::uint32_t> alive_slots() const;
  const Triangle& triangle(std::uint32_t slot) const { return triangles_[slot]; }
  const Point& position(std::uint32_t vertex) const { return positions_[vertex]; }
  std::span<const Point> positions() const { return positions_; }
  std::span<const Triangle> all_triangles() const { return triangles_; }  // free slots: kNoIndex
  std::array<Point, 3> corners(std::uint32_t slot) const {
    const Triangle& t = triangles_[slot];
    return {positions_[t[0]], positions_[t[1]], positions_[t[2]]};
  }

  void move(std::uint32_t vertex, const Point& to) { positions_[vertex] = to; }
  std::uint32_t add_vertex(const Point& at);
  std::uint32_t add_slot();                                // the new slot is free
  void set(std::uint32_t slot, const Triangle& triangle);  // the slot must be free
  void clear(std::uint32_t slot);                          // makes the slot free

  template <class Visit>
  void for_each_slot_at(std::uint32_t vertex, const Visit& visit) const {
    for (std::uint32_t corner = first_[vertex]; corner != kNoIndex; corner = next_[corner]) {
      visit(corner / 3);
    }
  }
  // These replace the contents of the vector.
  void slots_at(std::uint32_t vertex, std::vector<std::uint32_t>& slots) const;
  void neighbours(std::uint32_t vertex, std::vector<std::uint32_t>& vertices) const;  // sorted

  // The triangles with both vertices: at most two in a manifold. Missing ones are kNoIndex.
  std::array<std::uint32_t, 2> slots_at_edge(std::uint32_t a, std::uint32_t b) const;
  // Whether the vertex lies on an edge of one triangle.
  bool on_boundary(std::uint32_t vertex) const { return !closed_ && find_boundary(vertex); }

  // Whether collapsing b into a keeps the topology. Tests the link condition, in which the boundary
  // counts as one more vertex joined to all boundary vertices. A component never vanishes.
  bool collapsible(std::uint32_t a, std::uint32_t b) const;

  // The used vertices and triangles in the order of their slots.
  TriangleMesh compact() const;

 private:
  bool find_boundary(std::uint32_t vertex) const;

  std::vector<Point> positions_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> first_;  // of each vertex, 3 * slot + place
  std::vector<std::uint32_t> next_;   // of each corner
  std::size_t alive_ = 0;
  bool closed_ = false;
};

// The vertex of the triangle that is neither a nor b.
inline std::uint32_t opposite(const Triangle& t, std::uint32_t a, std::uint32_t b) {
  return t[0] != a && t[0] != b ? t[0] : t[1] != a && t[1] != b ? t[1] : t[2];
}
inline bool has(const Triangle& t, std::uint32_t v) { return t[0] == v || t[1] == v || t[2] == v; }

}  // namespace emax
