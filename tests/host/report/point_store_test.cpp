#include "host/report/point_store.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/messages.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

TEST(DistanceStore, GivesTheSameFromMemoryAndFromAFile) {
  test::Random random(303);
  std::vector<double> distances(300000);
  for (double& d : distances) d = random.uniform(0, 1);
  for (const std::uint64_t memory : {std::uint64_t{300000 * 8}, std::uint64_t{0}}) {
    DistanceStore store(distances.size(), memory, "scan.xyz");
    EXPECT_EQ(store.is_in_memory(), memory > 0);
    const std::span<const double> all = distances;
    store.put(200000, all.subspan(200000));
    store.put(0, all.first(1000));
    store.put(1000, all.subspan(1000, 199000));
    const double other = 7;
    store.put(299999, {&other, 1});
    std::vector<double> read;
    for (int twice = 0; twice < 2; ++twice) {
      read.clear();
      store.read(
          [&](std::span<const double> some) { read.insert(read.end(), some.begin(), some.end()); });
    }
    EXPECT_EQ(read.back(), 7);
    read.back() = distances.back();
    EXPECT_EQ(read, distances);
  }
}

TEST(DistanceStore, SaysWhereThereIsNoRoom) {
  const char* const before = std::getenv("TMPDIR");
  const std::string folder = before != nullptr ? before : "";
  setenv("TMPDIR", "/proc", 1);
  const std::string message = test::message_of([] { DistanceStore(10, 0, "scan.xyz"); });
  before != nullptr ? setenv("TMPDIR", folder.c_str(), 1) : unsetenv("TMPDIR");
  test::expect_clear(message,
                     "scan.xyz: ", "the distances of its points cannot be written into /proc",
                     "make room there, or name another folder by TMPDIR");
}

}  // namespace
}  // namespace emax
