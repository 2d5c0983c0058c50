#pragma once

#include <vector>

#include "host/geometry/triangle_mesh.h"

namespace emax::test {

// A surface that is known, and the places from which it is scanned. Lengths in metres, z upwards.
struct Scene {
  TriangleMesh mesh;            // seen from both sides; parts may touch and run through each other
  std::vector<Point> stations;  // of the scanner's mirror
};

// A hall of 40 x 20 x 8 m with twelve round columns, a flight of stairs and pipes below the
// ceiling.
Scene hall();
// 200 x 200 m of hills, seen from four places among them.
Scene terrain();
// A mesh, scaled to a height of 2 m, that stands on the ground; seen from four sides and above.
Scene statue(TriangleMesh mesh);

}  // namespace emax::test
