#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>

#include "sw_model/base/mesh_view.h"

namespace emax {

// Seeded numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t bits() { return engine_(); }
  std::uint32_t word() { return static_cast<std::uint32_t>(engine_() >> 32); }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  // `end` at most 2^32.
  std::uint32_t below(std::size_t end) {
    return static_cast<std::uint32_t>((engine_() >> 32) * end >> 32);
  }
  Point point(double low, double high) {
    const double x = uniform(low, high), y = uniform(low, high), z = uniform(low, high);
    return {x, y, z};
  }
  bool one_in(std::uint32_t n) { return below(n) == 0; }

 private:
  std::mt19937_64 engine_;
};

// The seed of one test, from its name and the seed of the whole run (FNV-1a).
constexpr std::uint64_t named_seed(std::string_view name, std::uint64_t seed) {
  std::uint64_t hash = 0xcbf29ce484222325u ^ (seed * 0x9e3779b97f4a7c15u);
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

}  // namespace emax
