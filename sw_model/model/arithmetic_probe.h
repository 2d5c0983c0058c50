#pragma once

#include <cfenv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "hls/kernel/point_triangle.h"
#include "sw_model/base/float_bits.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/probe_pairs.h"

namespace emax {
// Static: each translation unit probes the flags it was compiled with.
namespace {

// The kernel's own source on the processor's binary32. Not inlined, so that the change of mode
// around the call holds for all of it; flattened, so that it is this unit's compilation of the
// source and not one that the linker took from another.
[[gnu::noinline, gnu::flatten]] float native_squared_distance(const TriangleRecord<float>& record,
                                                              const Vector3<float>& point) {
  return squared_distance(record, (record.tag & kSegmentFlag) != 0, point);
}

// The operands are hidden from the compiler, which would multiply them itself.
[[gnu::noinline]] float native_product(float a, float b) {
  volatile float hidden_a = a, hidden_b = b;
  return hidden_a * hidden_b;
}

// What is wrong with binary32 arithmetic as compiled and as set in this thread, in plain words;
// nothing where all is right. Looks at the rounding mode, at flushing outside and inside the guard,
// and at contraction.
[[maybe_unused]] std::optional<std::string> probe_arithmetic() {
  if (std::fegetround() != FE_TONEAREST) return "the rounding mode is not to nearest";
  volatile float one = 1.0f, half_step = 0x1p-24f;
  if (one + half_step != 1.0f || one - half_step * 0.5f != 1.0f) {
    return "binary32 does not round to nearest even";
  }
  volatile double smallest = std::numeric_limits<double>::denorm_min();
  if (flush_mode_is_on() || smallest * 1.0 == 0.0 || native_product(0x1p-100f, 0x1p-40f) == 0.0f) {
    return "subnormals are flushed where they must not be (a library built with -ffast-math?)";
  }
  {
    const ScopedFlushMode flush;
    // Tiny after rounding at unbounded exponent: just below the smallest normal is flushed, what
    // rounds up to it is kept, and a subnormal operand counts as zero.
    const float below = native_product(bits_float(0x3f7fffff), bits_float(kSmallestNormal));
    const float kept = native_product(bits_float(0x3f800001), bits_float(kSmallestNormal));
    const float operand = native_product(0x1p100f, bits_float(1));
    if (below != 0.0f || float_bits(kept) != 0x00800001 || operand != 0.0f) {
      return "the guard around kernel calls does not flush subnormals as the contract says";
    }
  }
  // Rounding each product shows in these bits; contracting any of them changes some.
  ProbePairs pairs;
  for (int i = 0; i < 64; ++i) {
    const TriangleRecord<float> record = pairs.record();
    const Vector3<float> point = pairs.point();
    const ScopedFlushMode flush;
    if (float_bits(native_squared_distance(record, point)) != pair_squared_bits(point, record)) {
      return "the kernel's arithmetic differs from the model: a multiplication and an addition "
             "were "
             "contracted, or operations were reordered (build with -ffp-contract=off)";
    }
  }
  return std::nullopt;
}

}  // namespace
}  // namespace emax
