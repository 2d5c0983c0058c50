#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace emax {

inline constexpr std::size_t kSobolDimensions = 40;

// Point `index` (below 2^32) of Sobol's sequence in [0, 1)^dimensions, with the direction numbers
// of Joe & Kuo 2008, shifted digitally by bits that depend on the seed. In each dimension any 2^k
// points that begin at a multiple of 2^k lie one in each of 2^k equal slices. Dimensions beyond
// kSobolDimensions are drawn at random.
std::vector<double> sobol_point(std::uint64_t seed, std::uint32_t index, std::size_t dimensions);

}  // namespace emax
