// Names for Google Highway's targets and tables of what is compiled once for each. Included after
// hwy/foreach_target.h, in the part that is compiled once.
#pragma once

#include <hwy/highway.h>

#include <string_view>

#if HWY_TARGETS & HWY_AVX3
#define EMAX_FOR_AVX3(ENTRY) ENTRY(HWY_AVX3, "avx512", N_AVX3)
#else
#define EMAX_FOR_AVX3(ENTRY)
#endif
#if HWY_TARGETS & HWY_AVX2
#define EMAX_FOR_AVX2(ENTRY) ENTRY(HWY_AVX2, "avx2", N_AVX2)
#else
#define EMAX_FOR_AVX2(ENTRY)
#endif
#if HWY_TARGETS & HWY_SSE4
#define EMAX_FOR_SSE4(ENTRY) ENTRY(HWY_SSE4, "sse4", N_SSE4)
#else
#define EMAX_FOR_SSE4(ENTRY)
#endif
#if HWY_TARGETS & HWY_NEON
#define EMAX_FOR_NEON(ENTRY) ENTRY(HWY_NEON, "neon", N_NEON)
#else
#define EMAX_FOR_NEON(ENTRY)
#endif
#if HWY_TARGETS & HWY_EMU128
#define EMAX_FOR_PLAIN(ENTRY) ENTRY(HWY_EMU128, "plain", N_EMU128)
#elif HWY_TARGETS & HWY_SCALAR
#define EMAX_FOR_PLAIN(ENTRY) ENTRY(HWY_SCALAR, "plain", N_SCALAR)
#else
#define EMAX_FOR_PLAIN(ENTRY)
#endif

// ENTRY(bit, name, namespace) for every target that was compiled, best first.
#define EMAX_FOR_EACH_SIMD_TARGET(ENTRY) \
  EMAX_FOR_AVX3(ENTRY)                   \
  EMAX_FOR_AVX2(ENTRY) EMAX_FOR_SSE4(ENTRY) EMAX_FOR_NEON(ENTRY) EMAX_FOR_PLAIN(ENTRY)
