#include "host/decimate/independent_edits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>

#include "host/decimate/edit_proposer.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

using Edge = IndependentEdits::Edge;
constexpr double kEditLimit = 0.1;
constexpr int kPower = 8;

// A coarse mesh within points of a finer one, with the edges counted between all of its vertices.
class IndependentParts : public testing::TestWithParam<bool> {
 protected:
  IndependentParts()
      : reference_(GetParam() ? bumpy(40, 60) : sheet(40, 0.4)),
        mesh_(GetParam() ? bumpy(12, 18) : sheet(12, 0.4)),
        back_(reference_, kEditLimit),
        state_(mesh_, reference_.vertices, &back_, kEditLimit * kEditLimit, {}) {}

  std::vector<std::uint32_t> vertices() const {
    std::vector<std::uint32_t> all(mesh_.vertices.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }
  std::vector<Edge> edges() const {
    std::set<Edge> all;
    for (const Triangle& t : mesh_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        all.insert({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
      }
    }
    return {all.begin(), all.end()};
  }
  std::set<std::uint32_t> within_two(std::uint32_t vertex) const {
    std::set<std::uint32_t> near = {vertex};
    for (int i = 0; i < 2; ++i) {
      const std::set<std::uint32_t> inner = near;
      for (const Triangle& t : mesh_.triangles) {
        if (std::ranges::any_of(t, [&](std::uint32_t v) { return inner.contains(v); })) {
          near.insert(t.begin(), t.end());
        }
      }
    }
    return near;
  }
  std::set<std::uint32_t> corners_at(const Edge& edge) const {
    std::set<std::uint32_t> corners;
    for (const Triangle& t : mesh_.triangles) {
      if (has(t, edge[0]) && has(t, edge[1])) corners.insert(t.begin(), t.end());
    }
    return corners;
  }

  // What is proposed for an item of its own proposer, which knows no edges.
  static bool propose_for(EditProposer& proposer, std::uint32_t vertex) {
    return proposer.relocation(vertex, kPower, true);
  }
  static bool propose_for(EditProposer& proposer, const Edge& edge) {
    return proposer.flip(edge[0], edge[1], kPower, true);
  }
  template <class Item>
  std::optional<MeshEdit> proposal(const Item& item) const {
    const EditProposer::Options options;
    const KnownEdges none;
    EditProposer proposer(state_, options, none);
    proposer.search().use(LocalSearch::Steps::kNewton);
    if (!propose_for(proposer, item)) return std::nullopt;
    return proposer.edit();
  }
  template <class Item>
  std::vector<std::optional<MeshEdit>> proposals(const std::vector<Item>& items) const {
    std::vector<std::optional<MeshEdit>> all;
    for (const Item& item : items) all.push_back(proposal(item));
    return all;
  }

  // How many of the items are proposed otherwise as soon as those before them are made.
  template <class Item>
  std::size_t disturbed(const std::vector<Item>& items, std::size_t& made) {
    const std::vector<std::optional<MeshEdit>> before = proposals(items);
    std::size_t others = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const std::optional<MeshEdit> now = proposal(items[i]);
      others += same(before[i], now) ? 0 : 1;
      if (!now || !state_.permits(*now)) continue;
      state_.apply(*now);
      ++made;
    }
    return others;
  }
  static bool same(const std::optional<MeshEdit>& a, const std::optional<MeshEdit>& b) {
    if (!a || !b) return !a && !b;
    return a->vertex == b->vertex && a->position == b->position && a->removed == b->removed &&
           a->added == b->added &&
           std::ranges::equal(a->answers, b->answers, [](const auto& x, const auto& y) {
             return x.point == y.point && x.added == y.added && x.slot == y.slot &&
                    x.squared_distance == y.squared_distance;
           });
  }

  TriangleMesh reference_, mesh_;
  BackBound back_;
  DecimationState state_;
};

TEST_P(IndependentParts, OfVerticesAreMoreThanTwoEdgesApartAndTakeAllInTheEnd) {
  IndependentEdits independent(state_.mesh());
  std::vector<std::uint32_t> left = vertices(), seen;
  while (!left.empty()) {
    const std::vector<std::uint32_t> part = independent.take(left);
    ASSERT_FALSE(part.empty());
    std::set<std::uint32_t> near;
    for (const std::uint32_t v : part) {
      EXPECT_FALSE(near.contains(v)) << v;
      near.merge(within_two(v));
    }
    for (const std::uint32_t v : left) EXPECT_TRUE(near.contains(v)) << v;
    seen.insert(seen.end(), part.begin(), part.end());
  }
  std::ranges::sort(seen);
  EXPECT_EQ(seen, vertices());
}

TEST_P(IndependentParts, OfEdgesShareNoVertexOfTheirTrianglesAndTakeAllInTheEnd) {
  IndependentEdits independent(state_.mesh());
  std::vector<Edge> left = edges(), seen;
  while (!left.empty()) {
    const std::vector<Edge> part = independent.take(left);
    std::set<std::uint32_t> touched;
    for (const Edge& e : part) {
      for (const std::uint32_t v : corners_at(e)) EXPECT_TRUE(touched.insert(v).second) << v;
    }
    seen.insert(seen.end(), part.begin(), part.end());
  }
  std::ranges::sort(seen);
  std::vector<Edge> all = edges();
  std::erase_if(all, [&](const Edge& e) { return corners_at(e).size() < 4; });
  EXPECT_EQ(seen, all);
}

TEST_P(IndependentParts, AreProposedTheSameBeforeAndAfterTheOthers) {
  IndependentEdits independent(state_.mesh());
  std::size_t moved = 0, flipped = 0;
  for (std::vector<std::uint32_t> left = vertices(); !left.empty();) {
    EXPECT_EQ(disturbed(independent.take(left), moved), 0u);
  }
  for (std::vector<Edge> left = edges(); !left.empty();) {
    EXPECT_EQ(disturbed(independent.take(left), flipped), 0u);
  }
  EXPECT_GT(moved, 50u);
  EXPECT_GT(flipped, 5u);
}

// The comparison sees edits that do disturb each other.
TEST_P(IndependentParts, AreNeededSinceNeighboursDisturbEachOther) {
  std::size_t moved = 0, flipped = 0;
  EXPECT_GT(disturbed(vertices(), moved), 20u);
  EXPECT_GT(disturbed(edges(), flipped), 1u);
}

INSTANTIATE_TEST_SUITE_P(ClosedAndOpen, IndependentParts, testing::Bool());

}  // namespace
}  // namespace emax::test
