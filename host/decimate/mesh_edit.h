#pragma once

#include <cstdint>
#include <vector>

#include "host/decimate/editable_mesh.h"

namespace emax {

// One edit: the triangles of `removed` give way to `added`, in which one vertex may have moved, and
// the points that they answered for are answered for anew.
struct MeshEdit {
  struct Answer {
    std::uint32_t point;
    std::uint32_t added;  // index in `added`, or
    std::uint32_t slot;   // where `added` is kNoIndex, a triangle that stays
    double squared_distance;
  };

  std::uint32_t vertex = kNoIndex;  // which moves
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
