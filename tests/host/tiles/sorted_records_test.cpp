// Records, bins and components on disk, beside the same in memory.
#include "host/tiles/sorted_records.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "host/geometry/disjoint_sets.h"
#include "host/tiles/component_count.h"
#include "host/tiles/record_bins.h"
#include "sw_model/base/deliberate_fault.h"
#include "tests/support/stimuli.h"

namespace emax {
namespace {

const NamedInput kInput = {"mesh.ply"};

TEST(SortedRecords, AreTakenInAscendingOrder) {
  test::Random random(401);
  for (const std::size_t size : {0u, 1u, 7u, 64u, 1000u, 20000u}) {
    for (const std::uint64_t memory :
         {std::uint64_t{0}, std::uint64_t{64}, std::uint64_t{4000}, std::uint64_t{1} << 20}) {
      SortedRecords<std::uint32_t> sorted(kInput, memory);
      std::vector<std::uint32_t> expected, found;
      for (std::size_t i = 0; i < size; ++i) {
        expected.push_back(random.below(1000));
        sorted.add(expected.back());
      }
      std::ranges::sort(expected);
      sorted.take([&](std::uint32_t r) { found.push_back(r); });
      EXPECT_EQ(found, expected) << size << " in " << memory << " bytes";
    }
  }
}

TEST(RecordBins, GiveWhatWasPutIntoEach) {
  test::Random random(402);
  for (const std::size_t bins : {1u, 3u, 40u}) {
    RecordBins<std::uint32_t> on_disk(kInput, bins, 0);
    std::vector<std::vector<std::uint32_t>> in_memory(bins);
    for (std::uint32_t i = 0; i < 60000; ++i) {
      const std::size_t bin = random.below(static_cast<std::uint32_t>(bins));
      on_disk.add(bin, i);
      in_memory[bin].push_back(i);
    }
    for (std::size_t bin = 0; bin < bins; ++bin) {
      const std::vector<std::uint32_t>& expected = in_memory[bin];
      ASSERT_EQ(on_disk.size(bin), expected.size());
      EXPECT_EQ(on_disk.read(bin), expected);
      std::vector<std::uint32_t> found;
      on_disk.for_each(bin, [&](std::uint32_t r) { found.push_back(r); });
      EXPECT_EQ(found, expected);
      const auto middle = expected.begin() + static_cast<std::ptrdiff_t>(expected.size() / 3);
      EXPECT_EQ(on_disk.read(bin, expected.size() / 3, expected.size() / 2),
                std::vector<std::uint32_t>(
                    middle, middle + static_cast<std::ptrdiff_t>(expected.size() / 2)));
    }
    EXPECT_EQ(on_disk.size(bins + 5), 0u);
  }
}

// Of random edges among all nodes, or among near ones.
std::pair<std::uint64_t, std::uint64_t> components(std::uint32_t nodes, std::size_t edges,
                                                   std::uint32_t reach, std::uint64_t memory,
                                                   std::uint64_t seed) {
  test::Random random(seed);
  DisjointSets in_memory(nodes);
  ComponentCount on_disk(kInput, memory);
  for (std::size_t i = 0; i < edges; ++i) {
    const std::uint32_t a = random.below(nodes);
    const std::uint32_t b = (a + random.below(reach)) % nodes;
    in_memory.join(a, b);
    on_disk.join(a, b);
  }
  std::uint64_t expected = 0;
  for (std::size_t i = 0; i < nodes; ++i) expected += in_memory.root(i) == i;
  return {on_disk.count(nodes), expected};
}

TEST(ComponentCount, IsThatOfTheSetsInMemory) {
  for (const std::uint64_t memory : {0u, 300u, 5000u, 1000000u}) {
    for (const std::uint32_t nodes : {1u, 5u, 200u, 3000u}) {
      for (const double share : {0.0, 0.3, 0.6, 1.5}) {
        for (const std::uint32_t reach : {3u, nodes}) {
          const auto edges = static_cast<std::size_t>(share * nodes);
          const auto [found, expected] = components(nodes, edges, reach, memory, 403 + reach);
          EXPECT_EQ(found, expected)
              << nodes << " nodes, " << edges << " edges, " << memory << " bytes";
        }
      }
    }
  }
}

TEST(ComponentCountFault, EdgesThatAreNotPassedOnAreNoticed) {
  const DeliberateFault fault(Fault::kForgetsPassedEdges);
  const auto [found, expected] = components(3000, 3000, 3000, 300, 404);
  EXPECT_NE(found, expected);
}

}  // namespace
}  // namespace emax
