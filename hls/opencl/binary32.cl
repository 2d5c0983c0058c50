// The operators that emax_lower's functions call, with the bits of docs/numerics.md: binary32 to
// nearest even, each operation rounded by itself, subnormals flushed here and not by the device's
// mode. Values are vectors of LANES points; a true condition is not zero.
#pragma OPENCL FP_CONTRACT OFF

#if LANES == 1
typedef float real;
typedef int condition;
typedef uint word;
#define as_real as_float
#define as_word as_uint
#else
#define JOIN_(name, lanes) name##lanes
#define JOIN(name, lanes) JOIN_(name, lanes)
typedef JOIN(float, LANES) real;
typedef JOIN(int, LANES) condition;
typedef JOIN(uint, LANES) word;
#define as_real JOIN(as_float, LANES)
#define as_word JOIN(as_uint, LANES)
#endif

#define SIGN 0x80000000u
#define SMALLEST_NORMAL 0x00800000u
#define INFINITY_WORD 0x7f800000u
#define ONE_NAN 0x7fc00000u

// A word in every lane.
word splat_word(const uint value) { return (word)(value); }
real splat(const uint value) { return as_real((word)(value)); }
condition bit_of(const uint value, const int bit) {
  return (condition)((value >> bit & 1u) != 0 ? -1 : 0);
}

word magnitude_word(const real value) { return as_word(value) & ~SIGN; }
real signed_zero(const real value) { return as_real(as_word(value) & SIGN); }

real fp_flushed(const real value) {
  return select(value, signed_zero(value), magnitude_word(value) < SMALLEST_NORMAL);
}
real fp_canonical(const real value) {
  return select(value, splat(ONE_NAN), magnitude_word(value) > INFINITY_WORD);
}
real fp_magnitude(const real value) { return as_real(magnitude_word(value)); }
real fp_negate(const real value) { return as_real(as_word(value) ^ SIGN); }
condition fp_is_number(const real value) { return magnitude_word(value) <= INFINITY_WORD; }
condition fp_less(const real a, const real b) { return a < b; }

// A sum of normal operands that is less than the smallest normal number is exact.
real fp_add(const real a, const real b) { return fp_flushed(a + b); }
real fp_subtract(const real a, const real b) { return fp_flushed(a - b); }

// A product just below the smallest normal number can round up to it for want of digits. Scaled by
// 2^64 it keeps all digits and shows its side. Neither operand of such a product is above 2, so
// nothing overflows where it counts.
real fp_multiply(const real a, const real b) {
  const real product = a * b;
  const real scaled = a * 0x1p64f * b;
  const word size = magnitude_word(product);
  const condition tiny =
      (size < SMALLEST_NORMAL) |
      ((size == SMALLEST_NORMAL) & (magnitude_word(scaled) < as_uint(0x1p-62f)));
  return select(product, signed_zero(product), tiny);
}
real fp_square(const real a) { return fp_multiply(a, a); }

// Of the bits of docs/numerics.md only where the device rounds them correctly
// (-cl-fp32-correctly-rounded-divide-sqrt). A quotient
// of mantissas below 1 is less than 1 - 2^-24, so none rounds up to the smallest normal number.
real fp_divide(const real a, const real b) { return fp_flushed(a / b); }
real fp_square_root(const real a) { return sqrt(a); }
