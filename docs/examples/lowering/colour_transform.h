// R'G'B' to Y'CbCr by ITU-R BT.709, with luma limited to [0, 1].
#pragma once

#include "hls/kernel/scalar.h"

template <class Scalar>
struct Rgb {
  Scalar red, green, blue;
};

template <class Scalar>
struct Ycbcr {
  Scalar y, cb, cr;
};

template <class Scalar>
Ycbcr<Scalar> colour_transform(const Rgb<Scalar>& in) {
  using emax::select;
  const Scalar zero(0.0f), one(1.0f);
  const Scalar luma =
      Scalar(0.2126f) * in.red + Scalar(0.7152f) * in.green + Scalar(0.0722f) * in.blue;
  const Scalar cb = (in.blue - luma) * Scalar(1.0f / 1.8556f);
  const Scalar cr = (in.red - luma) * Scalar(1.0f / 1.5748f);
  const Scalar above = select(one < luma, one, luma);
  return {select(luma < zero, zero, above), cb, cr};
}
