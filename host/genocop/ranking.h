#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/genocop/random_stream.h"

namespace emax {

// Nonlinear ranking selection (Michalewicz 1996): rank 0, the best of count > 0, has probability
// c q, rank i c q (1-q)^i, with c = 1 / (1 - (1-q)^count). q in (0, 1).
std::vector<double> ranking_probabilities(std::size_t count, double q);

// An index drawn with the given probabilities (any sum > 0, none negative).
std::size_t select(std::span<const double> weights, RandomStream& random);

}  // namespace emax
