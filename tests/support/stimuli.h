#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "sw_model/mesh_view.h"

namespace emax::test {

// Seeded numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t bits() { return engine_(); }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  std::uint32_t below(std::uint32_t end) {
    return static_cast<std::uint32_t>((engine_() >> 32) * end >> 32);
  }
  Point point(double low, double high) {
    const double x = uniform(low, high), y = uniform(low, high), z = uniform(low, high);
    return {x, y, z};
  }

 private:
  std::mt19937_64 engine_;
};

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
