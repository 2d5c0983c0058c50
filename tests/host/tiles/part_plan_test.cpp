#include "host/tiles/part_plan.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory>
#include <new>

#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

// A plan is written before the extent of its parts is known. Whatever was in memory before, it can
// be read: numbers that are not finite could not.
TEST(PartPlan, CanBeReadBeforeItsExtentIsKnown) {
  const test::TemporaryFolder folder;
  alignas(PartPlan) std::array<std::byte, sizeof(PartPlan)> memory;
  std::memset(memory.data(), 0xff, memory.size());
  PartPlan* plan = new (memory.data()) PartPlan();
  write_plan(folder.path(), *plan);
  std::destroy_at(plan);
  const PartPlan read = read_plan(folder.path());
  EXPECT_TRUE(read.extent.low.isZero() && read.extent.high.isZero());
  EXPECT_EQ(read.extent.reach, 0);
}

}  // namespace
}  // namespace emax
