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

// Random, degenerate, sliver, duplicated, far-from-origin and surface-like stimuli.
std::vector<Stimulus> all_stimuli(std::uint64_t seed);

// The one of them with that name. Throws std::out_of_range.
Stimulus named_stimulus(const std::string& name, std::uint64_t seed);

// A bumpy sphere of rings x segments vertices, closed and consistently oriented.
Stimulus bumpy_sphere(std::uint32_t rings, std::uint32_t segments, std::size_t points,
                      std::uint64_t seed);

}  // namespace emax::test
