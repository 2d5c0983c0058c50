#include "host/decimate/independent_edits.h"

#include <algorithm>

namespace emax {

void IndependentEdits::begin() {
  blocked_.resize(std::max(blocked_.size(), mesh_.vertex_slots()), 0);
  ++part_;
}

void IndependentEdits::block_around(std::uint32_t vertex) {
  mesh_.for_each_slot_at(vertex, [&](std::uint32_t slot) {
    for (const std::uint32_t v : mesh_.triangle(slot)) block(v);
  });
}

std::vector<std::uint32_t> IndependentEdits::take(std::vector<std::uint32_t>& left) {
  begin();
  std::vector<std::uint32_t> taken, ring;
  std::erase_if(left, [&](std::uint32_t v) {
    if (blocked(v)) return false;
    taken.push_back(v);
    mesh_.neighbours(v, ring);
    for (const std::uint32_t w : ring) block_around(w);
    return true;
  });
  return taken;
}

std::vector<IndependentEdits::Edge> IndependentEdits::take(std::vector<Edge>& left) {
  begin();
  std::vector<Edge> taken;
  std::erase_if(left, [&](const Edge& e) {
    const auto sides = mesh_.slots_at_edge(e[0], e[1]);
    if (sides[1] == kNoIndex) return true;
    const bool free = std::ranges::none_of(sides, [&](std::uint32_t slot) {
      return std::ranges::any_of(mesh_.triangle(slot), [&](std::uint32_t v) { return blocked(v); });
    });
    if (!free) return false;
    taken.push_back(e);
    for (const std::uint32_t slot : sides) {
      for (const std::uint32_t v : mesh_.triangle(slot)) block(v);
    }
    return true;
  });
  return taken;
}

}  // namespace emax
