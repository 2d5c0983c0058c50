#include <gtest/gtest.h>

#include "hls/kernel/reduce.h"
#include "sw_model/base/float_bits.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/triangle_frame.h"
#include "sw_model/simd/emax_simd.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

std::vector<std::uint32_t> nearest_by(const SimdTarget& target,
                                      const std::vector<Vector3<float>>& points,
                                      const std::vector<TriangleRecord<float>>& records) {
  PointArrays arrays;
  for (const Vector3<float>& p : points) arrays.push_back(p);
  std::vector<std::uint32_t> nearest(points.size(), kInfinityWord);
  target.update_nearest(arrays, records, nearest);
  return nearest;
}

TEST(Simd, EveryTargetGivesTheModelsBits) {
  for (const test::Stimulus& s : test::all_stimuli(31)) {
    const Normalization normalization = normalization_of(s.cloud);
    const auto points = normalized_points(s.cloud, normalization);
    const auto records = make_records(s.mesh(), normalization);
    const auto expected = nearest_squared_bits(points, records);
    for (const SimdTarget& target : simd_targets()) {
      SCOPED_TRACE(s.name + ", seed 31, target " + std::string(target.name()));
      EXPECT_EQ(nearest_by(target, points, records), expected);
    }
  }
}

// Subnormal coordinates and products: only right with the flush mode on around the kernel.
TEST(Simd, FlushesLikeTheModel) {
  test::Random random(6);
  std::vector<Vector3<float>> points;
  for (int i = 0; i < 64; ++i) {
    const auto tiny = [&random] {
      return bits_float(static_cast<std::uint32_t>(random.bits()) & 0x83ffffffu);
    };
    const float x = tiny(), y = tiny(), z = tiny();
    points.push_back({x, y, z});
  }
  const std::vector<TriangleRecord<float>> records = {
      make_record(make_frame({Point(0, 0, 0), Point(1e-37, 0, 0), Point(0, 1e-37, 0)}), 0)};
  const auto expected = nearest_squared_bits(points, records);
  for (const SimdTarget& target : simd_targets()) {
    EXPECT_EQ(nearest_by(target, points, records), expected) << target.name();
    EXPECT_FALSE(flush_mode_is_on());
  }
}

TEST(Simd, PlainTargetIsAlwaysThere) { EXPECT_EQ(simd_targets().back().name(), "plain"); }

}  // namespace
}  // namespace emax
