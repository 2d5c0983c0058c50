#include "host/genocop/sobol.h"

#include <array>

#include "host/genocop/random_stream.h"

namespace emax {
namespace {

constexpr unsigned kBits = 32;

// Primitive polynomials and first direction numbers, dimensions 2 to 40, as published with
// Joe & Kuo 2008, "Constructing Sobol sequences with better two-dimensional projections".
struct Direction {
  unsigned degree;
  unsigned coefficients;
  std::array<std::uint32_t, 8> first;
};
constexpr std::array<Direction, kSobolDimensions - 1> kDirections = {{
    {1, 0, {{1}}},
    {2, 1, {{1, 3}}},
    {3, 1, {{1, 3, 1}}},
    {3, 2, {{1, 1, 1}}},
    {4, 1, {{1, 1, 3, 3}}},
    {4, 4, {{1, 3, 5, 13}}},
    {5, 2, {{1, 1, 5, 5, 17}}},
    {5, 4, {{1, 1, 5, 5, 5}}},
    {5, 7, {{1, 1, 7, 11, 19}}},
    {5, 11, {{1, 1, 5, 1, 1}}},
    {5, 13, {{1, 1, 1, 3, 11}}},
    {5, 14, {{1, 3, 5, 5, 31}}},
    {6, 1, {{1, 3, 3, 9, 7, 49}}},
    {6, 13, {{1, 1, 1, 15, 21, 21}}},
    {6, 16, {{1, 3, 1, 13, 27, 49}}},
    {6, 19, {{1, 1, 1, 15, 7, 5}}},
    {6, 22, {{1, 3, 1, 15, 13, 25}}},
    {6, 25, {{1, 1, 5, 5, 19, 61}}},
    {7, 1, {{1, 3, 7, 11, 23, 15, 103}}},
    {7, 4, {{1, 3, 7, 13, 13, 15, 69}}},
    {7, 7, {{1, 1, 3, 13, 7, 35, 63}}},
    {7, 8, {{1, 3, 5, 9, 1, 25, 53}}},
    {7, 14, {{1, 3, 1, 13, 9, 35, 107}}},
    {7, 19, {{1, 3, 1, 5, 27, 61, 31}}},
    {7, 21, {{1, 1, 5, 11, 19, 41, 61}}},
    {7, 28, {{1, 3, 5, 3, 3, 13, 69}}},
    {7, 31, {{1, 1, 7, 13, 1, 19, 1}}},
    {7, 32, {{1, 3, 7, 5, 13, 19, 59}}},
    {7, 37, {{1, 1, 3, 9, 25, 29, 41}}},
    {7, 41, {{1, 3, 5, 13, 23, 1, 55}}},
    {7, 42, {{1, 3, 7, 3, 13, 59, 17}}},
    {7, 50, {{1, 3, 1, 3, 5, 53, 69}}},
    {7, 55, {{1, 1, 5, 5, 23, 33, 13}}},
    {7, 56, {{1, 1, 7, 7, 1, 61, 123}}},
    {7, 59, {{1, 1, 7, 9, 13, 61, 49}}},
    {7, 62, {{1, 3, 3, 5, 3, 55, 33}}},
    {8, 14, {{1, 3, 1, 15, 31, 13, 49, 245}}},
    {8, 21, {{1, 3, 5, 15, 31, 59, 63, 97}}},
    {8, 22, {{1, 3, 1, 11, 11, 11, 77, 249}}},
}};

std::array<std::uint32_t, kBits> direction_numbers(std::size_t dimension) {
  std::array<std::uint32_t, kBits> v{};
  if (dimension == 0) {
    for (unsigned bit = 0; bit < kBits; ++bit) v[bit] = std::uint32_t{1} << (kBits - 1 - bit);
    return v;
  }
  const Direction& d = kDirections[dimension - 1];
  for (unsigned bit = 0; bit < kBits; ++bit) {
    if (bit < d.degree) {
      v[bit] = d.first[bit] << (kBits - 1 - bit);
      continue;
    }
    v[bit] = v[bit - d.degree] ^ (v[bit - d.degree] >> d.degree);
    for (unsigned k = 1; k < d.degree; ++k) {
      if ((d.coefficients >> (d.degree - 1 - k) & 1u) != 0) v[bit] ^= v[bit - k];
    }
  }
  return v;
}

}  // namespace

std::vector<double> sobol_point(std::uint64_t seed, std::uint32_t index, std::size_t dimensions) {
  RandomStream shift(seed, 0, RandomStream::Purpose::kSobol);
  RandomStream beyond(seed, std::uint64_t{index} + 1, RandomStream::Purpose::kSobol);
  std::vector<double> point(dimensions);
  for (std::size_t d = 0; d < dimensions; ++d) {
    if (d >= kSobolDimensions) {
      point[d] = beyond.uniform();
      continue;
    }
    const auto v = direction_numbers(d);
    auto value = static_cast<std::uint32_t>(shift.bits());
    for (unsigned bit = 0; bit < kBits; ++bit) {
      if ((index >> bit & 1u) != 0) value ^= v[bit];
    }
    // The middle of the cell, so that no point lies on the bounds of a domain.
    point[d] = (static_cast<double>(value) + 0.5) * 0x1p-32;
  }
  return point;
}

}  // namespace emax
