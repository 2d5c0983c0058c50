#include "host/tiles/tile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>

#include "sw_model/base/deliberate_fault.h"
#include "tests/host/support/decimation.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

// The left half of a wavy sheet is free.
Tile half_of_a_sheet() {
  Tile tile;
  tile.mesh = sheet(30, 0.3);
  const auto is_free = [&](const Triangle& t) {
    return std::ranges::all_of(t, [&](std::uint32_t v) { return tile.mesh.vertices[v][0] <= 0; });
  };
  std::vector<Triangle>& triangles = tile.mesh.triangles;
  const auto stay = std::stable_partition(triangles.begin(), triangles.end(), is_free);
  tile.free = static_cast<std::size_t>(stay - triangles.begin());
  for (std::uint32_t v = 0; v < tile.mesh.vertices.size(); ++v) tile.vertices.push_back(v);
  tile.reference = tile.mesh;
  tile.covered = tile.mesh.triangles.size();
  return tile;
}

TEST(Tile, LeavesWhatIsNotFree) {
  const Tile tile = half_of_a_sheet();
  std::set<std::uint32_t> seam;  // vertices of both
  std::set<std::uint32_t> stay;
  for (std::size_t t = tile.free; t < tile.mesh.triangles.size(); ++t) {
    stay.insert(tile.mesh.triangles[t].begin(), tile.mesh.triangles[t].end());
  }
  for (std::size_t t = 0; t < tile.free; ++t) {
    for (const std::uint32_t v : tile.mesh.triangles[t]) {
      if (stay.contains(v)) seam.insert(v);
    }
  }
  using Effort = DecimationSettings::Effort;
  for (const Effort effort : {Effort::kSweep, Effort::kRelax, Effort::kDeep}) {
    const DecimatedTile result = decimate_tile(tile, with(0.03, effort));
    EXPECT_LT(result.triangles.size(), tile.free);
    EXPECT_GT(result.triangles.size(), seam.size());
    std::set<std::uint32_t> used;
    for (const Triangle& t : result.triangles) used.insert(t.begin(), t.end());
    EXPECT_TRUE(std::ranges::includes(used, seam));
    // The seam's alone are those that were there; the others are new.
    EXPECT_LT(*used.rbegin(), tile.mesh.vertices.size() + result.added.size());
    for (const std::uint32_t v : used) {
      EXPECT_TRUE(v >= tile.mesh.vertices.size() || seam.contains(v));
    }
  }
}

TEST(TileFault, AMovedSeamIsSeen) {
  const DeliberateFault fault(Fault::kMovesSeams);
  EXPECT_THROW(decimate_tile(half_of_a_sheet(), with(0.03)), std::logic_error);
}

}  // namespace
}  // namespace emax::test
