// The kernel: squared distances of points and triangles, in the arithmetic of the hardware, for a
// top function of your own or for software.
//
//   #include <emax/kernel.h>
//
//   emax::EmaxKernel<float> kernel;      // command words in, answer words out: serve()
//   float d2 = emax::squared_distance(record, false, point);
//
// Links with emax::kernel (header-only, C++14). For synthesis include "hls/kernel/emax_kernel.h"
// directly. sw_model makes the records (docs/kernel.md); docs/protocol.md defines commands and
// answers. Source: section 4 of the paper.
#ifndef EMAX_KERNEL_H
#define EMAX_KERNEL_H

#ifdef __FAST_MATH__
#error "emax: -ffast-math changes the kernel's roundings; compile this source without it"
#endif

#include "hls/kernel/emax_kernel.h"

#endif
