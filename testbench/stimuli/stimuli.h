#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sw_model/base/mesh_view.h"
#include "testbench/stimuli/random.h"

namespace emax::test {

using emax::Random;

// A cloud and a mesh, with one sentence of reason.
struct Stimulus {
  std::string name;
  std::vector<Point> cloud;
  std::vector<Point> vertices;
  std::vector<Triangle> triangles;

  MeshView mesh() const { return {vertices, triangles}; }
};

// All stimuli: random, degenerate, sliver, duplicated, far from the origin, like a surface.
std::vector<Stimulus> all_stimuli(std::uint64_t seed);

// The stimulus with this name. Throws std::out_of_range.
Stimulus named_stimulus(const std::string& name, std::uint64_t seed);

// A bumpy sphere of rings x segments vertices, closed and consistently oriented.
Stimulus bumpy_sphere(std::uint32_t rings, std::uint32_t segments, std::size_t points,
                      std::uint64_t seed);

}  // namespace emax::test
