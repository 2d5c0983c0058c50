#include <gtest/gtest.h>

#include "hls/kernel/command_words.h"
#include "sw_model/model/emax_model.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

TriangleRecord<float> random_record(test::Random& random) {
  const auto number = [&random] { return static_cast<float>(random.uniform(-1, 1)); };
  const auto vector = [&number] {
    const float x = number(), y = number(), z = number();
    return Vector3<float>{x, y, z};
  };
  const auto edge = [&random, &number] {
    const float y = number(), z = number();
    return PlanarEdge<float>{{y, z}, static_cast<float>(random.uniform(0, 1))};
  };
  const Vector3<float> v1 = vector(), normal = vector(), in_plane = vector(), along = vector();
  const auto length = static_cast<float>(random.uniform(0, 1));
  const PlanarEdge<float> edge13 = edge(), edge23 = edge();
  return {v1,     normal, in_plane, along,
          length, edge13, edge23,   random.below(8) == 0 ? kSegmentFlag : 0};
}

// FNV-1a over the bits of pairs whose numbers need no mathematical library: a fingerprint of the
// kernel's arithmetic that is the same on every machine.
std::uint64_t fingerprint(bool swap_edges) {
  test::Random random(7);
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (int i = 0; i < 20000; ++i) {
    TriangleRecord<float> record = random_record(random);
    const Point p = random.point(-1, 1);
    if (swap_edges && i % 777 == 0) std::swap(record.edge13, record.edge23);
    hash = (hash ^ pair_squared_bits({static_cast<float>(p.x()), static_cast<float>(p.y()),
                                      static_cast<float>(p.z())},
                                     record)) *
           0x100000001b3u;
  }
  return hash;
}

// If this fails, the kernel's bits have changed: raise kKernelVersion and record its fingerprint.
TEST(KernelVersion, ChangesWithTheBits) {
  constexpr Word kVersion = 1;
  constexpr std::uint64_t kFingerprint = 0x4a096ecbe03a1872;
  ASSERT_EQ(kKernelVersion, kVersion);
  EXPECT_EQ(fingerprint(false), kFingerprint) << "0x" << std::hex << fingerprint(false);
}

TEST(KernelVersion, FingerprintSeesAFewWrongRecords) {
  EXPECT_NE(fingerprint(true), fingerprint(false));
}

}  // namespace
}  // namespace emax
