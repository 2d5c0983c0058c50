#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/picture/view.h"

namespace emax {

// A mesh, and points coloured by how far they are from it.
struct DeviationScene {
  MeshView mesh;  // at least one triangle
  std::vector<Point> points;
  std::vector<double> deviations;      // of the points
  std::vector<std::uint32_t> nearest;  // the triangle nearest to each point
  bool is_signed = false;              // colours from -reach to reach; otherwise from 0
  double reach = 1;                    // above 0; what lies beyond has the last colour
  std::string unit;                    // shown above the legend; may be empty
};

struct PictureSize {
  std::uint32_t width, height;  // at least 200 pixels each
};

// The picture as PNG: the mesh in grey with its edges where these can be told apart, the points as
// discs in the light of the mesh, on the right a legend. Needs no display. The same bytes for any
// number of threads. Points that are far from the mesh do not make it small: they may lie outside
// of the picture. O(triangles + points + pixels).
std::string deviation_picture(const DeviationScene& scene, const View& view, PictureSize size,
                              std::size_t threads);

}  // namespace emax
