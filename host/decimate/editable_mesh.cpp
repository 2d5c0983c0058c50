#include "host/decimate/editable_mesh.h"

#include <algorithm>

#include "sw_model/base/sort_once.h"
namespace emax {

EditableMesh::EditableMesh(const TriangleMesh& mesh)
    : positions_(mesh.vertices),
      triangles_(mesh.triangles.size(), Triangle{kNoIndex, kNoIndex, kNoIndex}),
      first_(mesh.vertices.size(), kNoIndex),
      next_(3 * mesh.triangles.size(), kNoIndex) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) set(t, mesh.triangles[t]);
  closed_ = true;
  for (std::uint32_t v = 0; v < mesh.vertices.size() && closed_; ++v) {
    closed_ = !used(v) || !find_boundary(v);
  }
}

std::uint32_t EditableMesh::add_vertex(const Point& at) {
  positions_.push_back(at);
  first_.push_back(kNoIndex);
  return static_cast<std::uint32_t>(positions_.size() - 1);
}

std::uint32_t EditableMesh::add_slot() {
  triangles_.push_back({kNoIndex, kNoIndex, kNoIndex});
  next_.resize(next_.size() + 3, kNoIndex);
  return static_cast<std::uint32_t>(triangles_.size() - 1);
}

void EditableMesh::set(std::uint32_t slot, const Triangle& triangle) {
  triangles_[slot] = triangle;
  for (std::uint32_t i = 0; i < 3; ++i) {
    next_[3 * slot + i] = first_[triangle[i]];
    first_[triangle[i]] = 3 * slot + i;
  }
  ++alive_;
}

void EditableMesh::clear(std::uint32_t slot) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    std::uint32_t* link = &first_[triangles_[slot][i]];
    while (*link != 3 * slot + i) link = &next_[*link];
    *link = next_[*link];
  }
  triangles_[slot] = {kNoIndex, kNoIndex, kNoIndex};
  --alive_;
}

void EditableMesh::slots_at(std::uint32_t vertex, std::vector<std::uint32_t>& slots) const {
  slots.clear();
  for_each_slot_at(vertex, [&](std::uint32_t slot) { slots.push_back(slot); });
}

void EditableMesh::neighbours(std::uint32_t vertex, std::vector<std::uint32_t>& vertices) const {
  vertices.clear();
  for_each_slot_at(vertex, [&](std::uint32_t slot) {
    for (const std::uint32_t v : triangles_[slot]) {
      if (v != vertex) vertices.push_back(v);
    }
  });
  sort_once(vertices);
}

std::array<std::uint32_t, 2> EditableMesh::slots_at_edge(std::uint32_t a, std::uint32_t b) const {
  std::array<std::uint32_t, 2> found = {kNoIndex, kNoIndex};
  std::size_t count = 0;
  for_each_slot_at(a, [&](std::uint32_t slot) {
    if (has(triangles_[slot], b) && count < 2) found[count++] = slot;
  });
  return found;
}

bool EditableMesh::find_boundary(std::uint32_t vertex) const {
  // In a consistently oriented closed fan every neighbour of the vertex comes once after it and
  // once before it, so the sums of both are equal.
  std::uint32_t after = 0, before = 0, count = 0;
  bool boundary = false;
  for_each_slot_at(vertex, [&](std::uint32_t slot) {
    const Triangle& t = triangles_[slot];
    const std::size_t i = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
    after += t[(i + 1) % 3];
    before += t[(i + 2) % 3];
    ++count;
  });
  if (after != before || count < 3) return true;
  // Equal sums do not prove that the fan is closed.
  for_each_slot_at(vertex, [&](std::uint32_t slot) {
    const Triangle& t = triangles_[slot];
    const std::size_t i = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
    if (!boundary) boundary = slots_at_edge(vertex, t[(i + 1) % 3])[1] == kNoIndex;
  });
  return boundary;
}

bool EditableMesh::collapsible(std::uint32_t a, std::uint32_t b) const {
  const std::array<std::uint32_t, 2> sides = slots_at_edge(a, b);
  if (sides[0] == kNoIndex) return false;
  std::array<std::uint32_t, 2> apex = {opposite(triangles_[sides[0]], a, b), kNoIndex};
  const bool inner = sides[1] != kNoIndex;
  if (inner) {
    apex[1] = opposite(triangles_[sides[1]], a, b);
    if (on_boundary(a) && on_boundary(b)) return false;
  }
  // The collapse joins the edges from an apex to a and to b. At least one of the two must have
  // another triangle.
  for (const std::uint32_t c : apex) {
    if (c == kNoIndex) continue;
    if (slots_at_edge(a, c)[1] == kNoIndex && slots_at_edge(b, c)[1] == kNoIndex) return false;
  }
  if (inner) {
    // An edge between the apexes in the links of both a and b: the mesh is a tetrahedron there.
    std::array<bool, 2> joined = {false, false};
    std::size_t which = 0;
    for (const std::uint32_t v : {a, b}) {
      for_each_slot_at(v, [&](std::uint32_t slot) {
        const Triangle& t = triangles_[slot];
        if (has(t, apex[0]) && has(t, apex[1])) joined[which] = true;
      });
      ++which;
    }
    if (joined[0] && joined[1]) return false;
  }
  // Common neighbours other than the apexes.
  std::vector<std::uint32_t> of_a, of_b;
  neighbours(a, of_a);
  neighbours(b, of_b);
  return std::ranges::none_of(of_a, [&](std::uint32_t v) {
    return v != b && v != apex[0] && v != apex[1] && std::ranges::binary_search(of_b, v);
  });
}

std::vector<std::uint32_t> EditableMesh::alive_slots() const {
  std::vector<std::uint32_t> slots;
  for (std::uint32_t slot = 0; slot < triangles_.size(); ++slot) {
    if (alive(slot)) slots.push_back(slot);
  }
  return slots;
}

TriangleMesh EditableMesh::compact() const {
  TriangleMesh mesh;
  std::vector<std::uint32_t> number(positions_.size(), kNoIndex);
  for (std::uint32_t v = 0; v < positions_.size(); ++v) {
    if (!used(v)) continue;
    number[v] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(positions_[v]);
  }
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    if (!alive(t)) continue;
    const Triangle& from = triangles_[t];
    mesh.triangles.push_back({number[from[0]], number[from[1]], number[from[2]]});
  }
  return mesh;
}

}  // namespace emax
