#include "host/geometry/mesh_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>

#include "host/geometry/triangle_mesh.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

MeshTopology topology(const std::vector<Triangle>& triangles) {
  std::uint32_t vertices = 0;
  for (const Triangle& t : triangles) vertices = std::max({vertices, t[0] + 1, t[1] + 1, t[2] + 1});
  const std::vector<Point> points(vertices, Point::Zero());  // positions do not matter
  return topology_of({points, triangles});
}

// Squares of a grid of `rows` by `columns`, joined to the first across the ends that wrap around.
std::vector<Triangle> grid(std::uint32_t rows, std::uint32_t columns, bool wrap_rows,
                           bool wrap_columns) {
  const std::uint32_t width = columns + (wrap_columns ? 0 : 1);
  const std::uint32_t height = rows + (wrap_rows ? 0 : 1);
  const auto at = [&](std::uint32_t r, std::uint32_t c) { return r % height * width + c % width; };
  std::vector<Triangle> triangles;
  for (std::uint32_t r = 0; r < rows; ++r) {
    for (std::uint32_t c = 0; c < columns; ++c) {
      triangles.push_back({at(r, c), at(r, c + 1), at(r + 1, c + 1)});
      triangles.push_back({at(r, c), at(r + 1, c + 1), at(r + 1, c)});
    }
  }
  return triangles;
}

void append(std::vector<Triangle>& to, const std::vector<Triangle>& more) {
  std::uint32_t first = 0;
  for (const Triangle& t : to) first = std::max({first, t[0] + 1, t[1] + 1, t[2] + 1});
  for (const Triangle& t : more) to.push_back({t[0] + first, t[1] + first, t[2] + first});
}

const std::vector<Triangle> kClosed{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

TEST(MeshTopology, NothingHasNothing) { EXPECT_EQ(topology({}), (MeshTopology{0, 0, 0})); }

TEST(MeshTopology, SphereIsClosed) { EXPECT_EQ(topology(kClosed), (MeshTopology{1, 0, 0})); }

TEST(MeshTopology, TorusHasOneHandle) {
  EXPECT_EQ(topology(grid(4, 5, true, true)), (MeshTopology{1, 0, 1}));
}

TEST(MeshTopology, TwoToriJoinedThroughAHoleHaveTwoHandles) {
  // The same triangle is taken from both, and the holes are sewn together.
  std::vector<Triangle> one = grid(4, 5, true, true), other = one;
  const Triangle hole = one.back();
  one.pop_back();
  other.pop_back();
  for (Triangle& t : other) {
    std::swap(t[1], t[2]);
    for (std::uint32_t& v : t) {
      if (std::ranges::count(hole, v) == 0) v += 20;
    }
  }
  one.insert(one.end(), other.begin(), other.end());
  EXPECT_EQ(topology(one), (MeshTopology{1, 0, 2}));
}

TEST(MeshTopology, BordersAreCountedByLoop) {
  EXPECT_EQ(topology({{0, 1, 2}}), (MeshTopology{1, 1, 0}));              // a disc
  EXPECT_EQ(topology(grid(3, 6, false, true)), (MeshTopology{1, 2, 0}));  // an annulus
  std::vector<Triangle> plate = grid(5, 9, false, false);
  plate.erase(plate.begin() + 2 * (2 * 9 + 2));
  plate.erase(plate.begin() + 2 * (2 * 9 + 6));
  EXPECT_EQ(topology(plate), (MeshTopology{1, 3, 0}));  // two holes in a plate
  std::vector<Triangle> torus = grid(4, 5, true, true);
  torus.pop_back();
  EXPECT_EQ(topology(torus), (MeshTopology{1, 1, 1}));
}

TEST(MeshTopology, HolesThatMeetAtAVertexAreOneLoopOfTheCutSurface) {
  // Two opposite triangles of a fan of six taken away: two fans are left at the middle, and the
  // hole between them runs through both of its copies.
  std::vector<Triangle> plate = grid(4, 4, false, false);
  const std::uint32_t middle = 2 * 5 + 2;
  std::vector<std::size_t> fan;
  for (std::size_t t = 0; t < plate.size(); ++t) {
    if (std::ranges::count(plate[t], middle) != 0) fan.push_back(t);
  }
  ASSERT_EQ(fan.size(), 6u);
  plate.erase(plate.begin() + static_cast<std::ptrdiff_t>(fan[5]));
  plate.erase(plate.begin() + static_cast<std::ptrdiff_t>(fan[0]));
  EXPECT_EQ(topology(plate), (MeshTopology{1, 2, 0}));
}

TEST(MeshTopology, ComponentsAreCountedAndGenusIsTheirSum) {
  std::vector<Triangle> all = grid(4, 5, true, true);
  append(all, grid(4, 5, true, true));
  append(all, kClosed);
  append(all, grid(3, 6, false, true));
  EXPECT_EQ(topology(all), (MeshTopology{4, 2, 2}));
}

TEST(MeshTopology, MoebiusStripIsCutWhereItsTrianglesDisagree) {
  // A strip of six squares whose end is joined to its begin upside down.
  std::vector<Triangle> strip = grid(1, 6, false, false);
  for (Triangle& t : strip) {
    for (std::uint32_t& v : t) {
      if (v == 6 || v == 13) v = v == 6 ? 7 : 0;
    }
  }
  EXPECT_EQ(topology(strip), (MeshTopology{1, 1, 0}));  // one cut across leaves a disc
}

TEST(MeshTopology, TriangleTurnedRoundIsAPieceOfItsOwn) {
  std::vector<Triangle> turned = kClosed;
  std::swap(turned[3][0], turned[3][1]);
  EXPECT_EQ(topology(turned), (MeshTopology{2, 2, 0}));
}

TEST(MeshTopology, BowTieIsTwoPieces) {
  EXPECT_EQ(topology({{0, 1, 2}, {0, 3, 4}}), (MeshTopology{2, 2, 0}));
}

TEST(MeshTopology, LeavesOnOneEdgeAreCutApart) {
  EXPECT_EQ(topology({{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}), (MeshTopology{3, 3, 0}));
  // Two closed pieces that share an edge: each is open along it after the cut.
  std::vector<Triangle> pair = kClosed;
  for (const Triangle& t : kClosed) {
    Triangle other = t;
    for (std::uint32_t& v : other) v = v < 2 ? v : v + 2;
    pair.push_back(other);
  }
  EXPECT_EQ(topology(pair), (MeshTopology{2, 2, 0}));
}

TEST(MeshTopology, TriangleOnBothSidesIsClosed) {
  EXPECT_EQ(topology({{0, 1, 2}, {0, 2, 1}}), (MeshTopology{1, 0, 0}));
}

TEST(MeshTopology, UnusedVerticesAndRepeatedIndicesAreNoPart) {
  std::vector<Triangle> faces = kClosed;
  faces.push_back({1, 1, 9});
  EXPECT_EQ(topology(faces), (MeshTopology{1, 0, 0}));
}

TEST(MeshTopology, IsSaidInWords) {
  EXPECT_EQ(describe(MeshTopology{1, 5, 0}), "1 component, 5 borders, genus 0");
  EXPECT_EQ(describe(MeshTopology{2, 1, 3}), "2 components, 1 border, genus 3");
  EXPECT_EQ(describe(MeshTopology{1, 0, 1}), "1 component, closed, genus 1");
}

// By the definition: half-edges are glued in a table, the vertices of the cut surface found by
// turning around corners, loops by walking along them, and genus piece by piece.
MeshTopology twin(const std::vector<Triangle>& all) {
  std::vector<Triangle> faces;
  for (const Triangle& t : all) {
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) faces.push_back(t);
  }
  using Half = std::size_t;  // 3 * face + side; the side begins at the corner of its number
  const auto from = [&](Half h) { return faces[h / 3][h % 3]; };
  const auto next = [](Half h) { return h % 3 == 2 ? h - 2 : h + 1; };
  const auto previous = [](Half h) { return h % 3 == 0 ? h + 2 : h - 1; };
  const Half count = 3 * faces.size();
  std::vector<std::optional<Half>> mate(count);
  for (Half h = 0; h < count; ++h) {
    std::vector<Half> along, against;
    for (Half g = 0; g < count; ++g) {
      if (from(g) == from(h) && from(next(g)) == from(next(h))) along.push_back(g);
      if (from(g) == from(next(h)) && from(next(g)) == from(h)) against.push_back(g);
    }
    if (along.size() == 1 && against.size() == 1) mate[h] = against[0];
  }
  // The corner at the begin of the half-edge h turns to the one that shares it across `mate`.
  std::vector<std::size_t> vertex(count, ~std::size_t{0}), piece(faces.size(), ~std::size_t{0});
  std::size_t vertices = 0, pieces = 0;
  for (Half h = 0; h < count; ++h) {
    if (vertex[h] != ~std::size_t{0}) continue;
    std::vector<Half> fan{h};
    vertex[h] = vertices;
    while (!fan.empty()) {
      const Half c = fan.back();
      fan.pop_back();
      const auto visit = [&](Half d) {
        if (vertex[d] == vertices) return;
        vertex[d] = vertices;
        fan.push_back(d);
      };
      if (mate[c]) visit(next(*mate[c]));
      if (mate[previous(c)]) visit(*mate[previous(c)]);
    }
    ++vertices;
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (piece[f] != ~std::size_t{0}) continue;
    std::vector<std::size_t> front{f};
    piece[f] = pieces;
    while (!front.empty()) {
      const std::size_t at = front.back();
      front.pop_back();
      for (Half h = 3 * at; h < 3 * at + 3; ++h) {
        if (!mate[h] || piece[*mate[h] / 3] == pieces) continue;
        piece[*mate[h] / 3] = pieces;
        front.push_back(*mate[h] / 3);
      }
    }
    ++pieces;
  }
  struct Sum {
    std::ptrdiff_t vertices = 0, edges = 0, faces = 0, loops = 0;
  };
  std::vector<Sum> sums(pieces);
  std::map<std::size_t, std::size_t> piece_of_vertex;
  std::vector<bool> walked(count, false);
  for (Half h = 0; h < count; ++h) {
    piece_of_vertex[vertex[h]] = piece[h / 3];
    Sum& sum = sums[piece[h / 3]];
    if (h % 3 == 0) ++sum.faces;
    if (!mate[h] || *mate[h] > h) ++sum.edges;
    if (mate[h] || walked[h]) continue;
    ++sum.loops;
    for (Half at = h; !walked[at];) {
      walked[at] = true;
      at = next(at);
      while (mate[at]) at = next(*mate[at]);
    }
  }
  for (const auto& [v, p] : piece_of_vertex) ++sums[p].vertices;
  MeshTopology topology;
  topology.components = pieces;
  for (const Sum& sum : sums) {
    const std::ptrdiff_t twice = 2 - sum.loops - (sum.vertices - sum.edges + sum.faces);
    EXPECT_EQ(twice % 2, 0);
    EXPECT_GE(twice, 0);
    topology.border_loops += static_cast<std::size_t>(sum.loops);
    topology.genus += static_cast<std::size_t>(twice) / 2;
  }
  return topology;
}

TEST(MeshTopology, RandomTriangleSoupsAsTheTwinHasThem) {
  std::array<std::size_t, 3> seen{};  // soups with several pieces, several loops, handles
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const std::uint32_t vertices = 4 + random.below(12);
    std::vector<Triangle> soup;
    for (std::uint32_t i = 0; i < 4 + seed % 37; ++i) {
      const std::uint32_t a = random.below(vertices), b = random.below(vertices),
                          c = random.below(vertices);
      soup.push_back({a, b, c});
    }
    const MeshTopology expected = twin(soup);
    EXPECT_EQ(topology(soup), expected);
    seen[0] += expected.components > 1;
    seen[1] += expected.border_loops > 1;
  }
  // Surfaces with triangles taken away, turned round and put down twice.
  for (std::uint32_t seed = 1; seed <= 120; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Triangle> soup = grid(4 + seed % 3, 5, seed % 2 == 0, seed % 5 != 0);
    append(soup, grid(3, 4, true, true));
    // Two tori meet in a triangle's place.
    if (seed % 3 == 0) {
      for (Triangle& t : soup) {
        for (std::uint32_t& v : t) v = v < soup.size() / 3 ? v : v - random.below(2);
      }
    }
    for (std::uint32_t change = random.below(8); change > 0; --change) {
      const std::uint32_t t = random.below(static_cast<std::uint32_t>(soup.size()));
      switch (random.below(3)) {
        case 0:
          soup.erase(soup.begin() + t);
          break;
        case 1:
          std::swap(soup[t][0], soup[t][1]);
          break;
        default:
          soup.push_back(soup[t]);
      }
    }
    const MeshTopology expected = twin(soup);
    EXPECT_EQ(topology(soup), expected);
    seen[2] += expected.genus > 0;
  }
  for (const std::size_t count : seen) EXPECT_GT(count, 20u);
}

}  // namespace
}  // namespace emax::test
