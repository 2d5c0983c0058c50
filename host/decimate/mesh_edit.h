#pragma once

#include <cstdint>
#include <vector>

#include "host/decimate/editable_mesh.h"

namespace emax {

// One edit: it replaces the triangles `removed` by `added`, may move one vertex, and gives the
// points of the removed triangles to others.
struct MeshEdit {
  struct Answer {
    std::uint32_t point;
    std::uint32_t added;  // index in `added`, or kNoIndex
    std::uint32_t slot;   // if `added` is kNoIndex: a triangle that stays
    double squared_distance;
  };

  std::uint32_t vertex = kNoIndex;  // the one that moves
  Point position = Point::Zero();
  std::vector<std::uint32_t> removed;
  std::vector<Triangle> added;
  std::vector<Answer> answers;

  void clear() {
    vertex = kNoIndex;
    removed.clear();
    added.clear();
    answers.clear();
  }
};

}  // namespace emax
