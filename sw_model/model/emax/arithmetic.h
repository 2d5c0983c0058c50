// Whether this translation unit computes as the kernel's numbers demand.
//
//   #include <emax/arithmetic.h>
//
//   if (const auto fault = emax::probe_arithmetic()) throw std::runtime_error(*fault);
//
// Links with emax::measure. Use it where a source of your own instantiates the kernel
// (emax/kernel.h): the targets of emax bring -ffp-contract=off, and this finds what was added after
// it: -ffast-math, contraction, a library that sets flush-to-zero. docs/numerics.md has the
// contract.
#pragma once

#ifdef __FAST_MATH__
#error "emax: -ffast-math changes the kernel's roundings; compile this source without it"
#endif

#include "sw_model/model/arithmetic_probe.h"
