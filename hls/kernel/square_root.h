// The square root, for functions of one's own that are lowered; the kernel takes none.
#ifndef EMAX_HLS_KERNEL_SQUARE_ROOT_H
#define EMAX_HLS_KERNEL_SQUARE_ROOT_H

#include <cmath>

#include "hls/kernel/scalar.h"

namespace emax {

inline float square_root(float value) { return std::sqrt(value); }
inline double square_root(double value) { return std::sqrt(value); }

}  // namespace emax

#endif
