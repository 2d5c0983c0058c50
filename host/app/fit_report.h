#pragma once

#include <cstddef>
#include <span>

#include "host/optimize/reference_fit.h"

namespace emax {

// What the scan is like, which surface was made of it and what was done to that; nothing where no
// surface was made.
void print_fit(const ReferenceFit& fit, double epsilon);

// What was done to make a surface closed, and where it could not be.
void print_closed(std::size_t holes, std::span<const OpenBorder> open);

}  // namespace emax
