// A top function of one's own for an HLS compiler: points and one triangle record in, the squared
// distances out, one a cycle. C++14; below it, its C simulation.
#include "hls/kernel/hls_target.h"
#include "hls/kernel/point_triangle.h"

void distances_to_triangle(const emax::TriangleRecord<float>& record,
                           emax::Stream<emax::Vector3<float>>& points, emax::Stream<float>& squared,
                           unsigned count) {
  const bool segment = (record.tag & emax::kSegmentFlag) != 0;
  for (unsigned i = 0; i < count; ++i) {
    EMAX_HLS(PIPELINE II = 1)
    squared.write(emax::squared_distance(record, segment, points.read()));
  }
}

#ifndef __SYNTHESIS__
#include <cstdio>
#include <cstring>

int main() {
  // V1 = 0, V2 = (0, 0, 2), V3 = (0, 1, 1): the frame is that of the coordinates.
  const float half = 0.70710678f, root = 1.41421356f;
  const emax::TriangleRecord<float> record = {
      {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 2, {{half, half}, root}, {{half, -half}, root},
      0};
  emax::Stream<emax::Vector3<float>> points;
  emax::Stream<float> squared;
  points.write({2, 0.25f, 1});   // above the inside
  points.write({0, 0.25f, -3});  // nearest to V1
  points.write({0, 1, 2});       // nearest to the edge V2V3
  distances_to_triangle(record, points, squared, 3);
  while (!squared.empty()) {
    const float value = squared.read();
    unsigned word;
    std::memcpy(&word, &value, sizeof word);
    std::printf("%08x\n", word);
  }
}
#endif
