#pragma once

#include "host/optimize/reference_fit.h"

namespace emax {

// What the scan is like, which surface was made of it and what was done to that; nothing where no
// surface was made.
void print_fit(const ReferenceFit& fit, double epsilon);

}  // namespace emax
