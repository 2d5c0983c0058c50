#pragma once

#include <cstdint>

namespace emax {

// A number that depends on the bits that this machine computes: of a small surface, one mesh by
// every method of reconstruction and one by each decimator, made by a worker as any evaluation is,
// and of functions of the C library, whose code is chosen by the processor. About a second. Throws
// Error if no worker can be started.
std::uint32_t computed_probe();

}  // namespace emax
