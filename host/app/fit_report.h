#pragma once

#include <cstddef>
#include <span>

#include "host/app/facts.h"
#include "host/optimize/reference_fit.h"

namespace emax {

// Prints the estimates of the scan, the surface that was made of it and the changes of that
// surface; prints nothing if no surface was made.
void print_fit(Facts& facts, const ReferenceFit& fit, double epsilon);

// Prints which flat holes were closed; prints nothing where there were none.
void print_on_planes(Facts& facts, const ClosedOnPlanes& made);

// Prints how many holes were closed, and where a border could not be closed.
void print_closed(Facts& facts, std::size_t holes, std::span<const OpenBorder> open);

}  // namespace emax
