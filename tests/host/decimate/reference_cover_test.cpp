#include "host/decimate/reference_cover.h"

#include <gtest/gtest.h>

#include <limits>

#include "host/decimate/decimation_state.h"
#include "host/decimate/local_search.h"
#include "sw_model/certify/surface_distance.h"
#include "tests/host/support/surfaces.h"
#include "tests/support/stimuli.h"

namespace emax::test {
namespace {

// The greatest distance from the mesh of points spread over a triangle, by every triangle.
double sampled_distance(const std::array<Point, 3>& triangle, const TriangleMesh& mesh) {
  constexpr int kSteps = 6;
  double greatest = 0;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
      const Point p =
          triangle[0] + u * (triangle[1] - triangle[0]) + v * (triangle[2] - triangle[0]);
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        least = std::min(least, squared_distance(p, mesh.view().corners(t)));
      }
      greatest = std::max(greatest, std::sqrt(least));
    }
  }
  return greatest;
}

// How many triangles of the reference have a point farther than the limit from the mesh.
std::size_t beyond(const TriangleMesh& reference, const TriangleMesh& mesh, double limit) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < reference.triangles.size(); ++t) {
    if (sampled_distance(reference.view().corners(t), mesh) > limit) ++count;
  }
  return count;
}

struct Edits {
  std::size_t made = 0, refused = 0;
};

// Collapses at random, with vertices anywhere near, which the cover permits or not.
Edits random_collapses(DecimationState& state, Random& random, int tries, double jitter,
                       std::vector<EditUndo>* undo = nullptr) {
  LocalSearch search(state);
  MeshEdit edit;
  Edits edits;
  const auto vertices = static_cast<std::uint32_t>(state.mesh().vertex_slots());
  for (int i = 0; i < tries; ++i) {
    const std::uint32_t a = random.below(vertices);
    if (!state.mesh().used(a)) continue;
    std::vector<std::uint32_t> ring;
    state.mesh().neighbours(a, ring);
    const std::uint32_t b = ring[random.below(static_cast<std::uint32_t>(ring.size()))];
    if (!search.prepare_collapse(a, b)) continue;
    const Point at =
        0.5 * (state.mesh().position(a) + state.mesh().position(b)) +
        jitter * Point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    Fit fit;
    if (!search.evaluate(at, 4, fit) || !search.finish(fit, true, edit)) continue;
    if (!state.permits(edit)) {
      ++edits.refused;
      continue;
    }
    if (undo != nullptr) undo->emplace_back();
    state.apply(edit, undo == nullptr ? nullptr : &undo->back());
    ++edits.made;
  }
  return edits;
}

DecimationState::Guards any_normal(bool recalls = false) {
  DecimationState::Guards guards;
  guards.normal_cosine = -1;
  guards.recalls = recalls;
  return guards;
}

// Few large triangles, so that corners say little of the inside.
std::vector<TriangleMesh> references() {
  return {bumpy(8, 12), sheet(7, 0.5), cube(2), joined(cube(1), sheet(5, 0.2), {3, 0, 0})};
}

TEST(ReferenceCover, WhatItPermitsKeepsEveryPointOfTheReference) {
  constexpr std::uint64_t kSeed = 91;
  for (const bool recalls : {false, true}) {
    std::size_t refused = 0;
    for (const TriangleMesh& reference : references()) {
      for (const double limit : {0.02, 0.1, 0.3}) {
        SCOPED_TRACE(testing::Message()
                     << "seed " << kSeed << ", limit " << limit << ", recalls " << recalls);
        Random random(kSeed);
        DecimationState state(reference, reference.vertices, nullptr, limit * limit,
                              any_normal(recalls), nullptr, reference.triangles);
        ASSERT_EQ(state.unproven(), 0u);
        for (int round = 0; round < 10; ++round) {
          refused += random_collapses(state, random, 40, 0.5 * limit).refused;
          EXPECT_EQ(state.unproven(), 0u);
          EXPECT_EQ(beyond(reference, state.mesh().compact(), limit), 0u);
        }
        const TriangleMesh mesh = state.mesh().compact();
        EXPECT_TRUE(decided_distance(reference.view(), ExactMesh(mesh.view()), limit * (1 + 1e-9))
                        .within(limit * (1 + 1e-9)));
      }
    }
    EXPECT_GT(refused, 50u);
  }
}

// A floor with a column that stands on it, open at the top, its walls in layers up to these
// heights. The vertices of the floor's middle ring are the second four.
TriangleMesh column_on_floor(double half, const std::vector<double>& layers) {
  TriangleMesh mesh;
  const auto add_ring = [&](double side, double z) {
    for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
      mesh.vertices.emplace_back(side * x, side * y, z);
    }
  };
  const auto join = [&](std::uint32_t inner, std::uint32_t outer) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t next = (i + 1) % 4;
      mesh.triangles.push_back({inner + i, outer + i, outer + next});
      mesh.triangles.push_back({inner + i, outer + next, inner + next});
    }
  };
  for (const double side : {half, 1.2, 3.0}) add_ring(side, 0);
  join(0, 4);
  join(4, 8);
  std::uint32_t below = 0;
  for (const double z : layers) {
    const auto above = static_cast<std::uint32_t>(mesh.vertices.size());
    add_ring(half, z);
    join(above, below);
    below = above;
  }
  return mesh;
}

// The corners of the reference's column are on the floor around an edit, but not all that lies over
// its walls higher up is around it.
TEST(ReferenceCover, RecallsWhatLaysOverASurfaceBesideTheEdit) {
  constexpr double kLimit = 0.05;
  const TriangleMesh reference = column_on_floor(0.5, {1});
  std::array<int, 2> permitted = {};
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
    Random random(seed);
    TriangleMesh mesh = column_on_floor(0.5, {0.1, 0.4, 0.7, 1});
    for (Point& v : mesh.vertices) {
      v += 0.5 * kLimit * Point(random.uniform(-1, 1), random.uniform(-1, 1), 0);
    }
    for (const bool recalls : {false, true}) {
      DecimationState state(mesh, reference.vertices, nullptr, kLimit * kLimit, any_normal(recalls),
                            nullptr, reference.triangles);
      EXPECT_EQ(state.unproven(), 0u);
      LocalSearch search(state);
      for (std::uint32_t i = 4; i < 8; ++i) {
        ASSERT_TRUE(search.prepare_collapse(i + 4, i));
        MeshEdit edit;
        Fit fit;
        ASSERT_TRUE(search.evaluate(state.mesh().position(i + 4), 4, fit));
        if (!search.finish(fit, true, edit)) continue;
        permitted[recalls ? 1 : 0] += state.permits(edit) ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(permitted[1], 40);
  EXPECT_LT(permitted[0], 40);
}

// The deliberate fault: without the cover the same edits lead beyond the limit between the points.
TEST(ReferenceCover, WithoutItTheInsideOfTheReferenceIsLost) {
  constexpr double kLimit = 0.1;
  std::size_t lost = 0;
  for (const TriangleMesh& reference : references()) {
    Random random(92);
    DecimationState state(reference, reference.vertices, nullptr, kLimit * kLimit, any_normal());
    random_collapses(state, random, 400, 0.5 * kLimit);
    lost += beyond(reference, state.mesh().compact(), kLimit);
  }
  EXPECT_GT(lost, 10u);
}

TEST(ReferenceCover, UndoneEditsLeaveItAsItWas) {
  constexpr double kLimit = 0.2;
  const TriangleMesh reference = sheet(9, 0.4);
  const auto state_of = [&] {
    return DecimationState(reference, reference.vertices, nullptr, kLimit * kLimit, any_normal(),
                           nullptr, reference.triangles);
  };
  DecimationState untouched = state_of(), edited = state_of();
  Random first(93);
  std::vector<EditUndo> undo;
  ASSERT_GT(random_collapses(edited, first, 300, 0.1, &undo).made, 20u);
  for (; !undo.empty(); undo.pop_back()) edited.undo(undo.back());
  EXPECT_EQ(edited.unproven(), 0u);
  // What may be done now is what might have been done at first.
  Random one(94), other(94);
  const Edits expected = random_collapses(untouched, one, 300, 0.1);
  const Edits found = random_collapses(edited, other, 300, 0.1);
  EXPECT_EQ(found.made, expected.made);
  EXPECT_EQ(found.refused, expected.refused);
  EXPECT_TRUE(same_bytes(edited.mesh().compact(), untouched.mesh().compact()));
}

// A mesh that is not the reference: what is beyond the limit at first is not proven, the rest is.
TEST(ReferenceCover, SaysWhatIsNotProvenAtFirst) {
  const TriangleMesh reference = joined(sheet(9, 0), sheet(3, 0), {0, 0, 5});
  const TriangleMesh mesh = sheet(4, 0);
  const DecimationState state(mesh, reference.vertices, nullptr, 0.01, any_normal(), nullptr,
                              reference.triangles);
  EXPECT_EQ(state.unproven(), 8u);
}

// Two triangles over thousands of the mesh, which has a hole narrower than twice the limit: no
// sheet lies over either, and the cuts that an edit may take are too few.
TEST(ReferenceCover, ProvesLargeTrianglesInPartsAtFirst) {
  constexpr std::uint32_t kSide = 61;
  const TriangleMesh whole = sheet(kSide, 0);
  const TriangleMesh torn = without_vertex(whole, kSide * (kSide / 3) + kSide / 4);
  const TriangleMesh large = sheet(2, 0);
  const SurfaceDistance distance = surface_distance(large.view(), ExactMesh(torn.view()));
  for (const double factor : {1.1, 0.9}) {
    const double limit = factor > 1 ? factor * distance.upper : factor * distance.lower;
    const EditableMesh mesh(torn);
    ReferenceCover cover(large.triangles, large.vertices, limit * limit);
    cover.begin(mesh, SlotTree(mesh));
    EXPECT_EQ(cover.unproven() == 0, factor > 1) << factor;
  }
}

// Of a scan of a hall, in metres: the corners of a part lie, but for rounding, on the plane between
// the two triangles of the mesh, and beyond the limit of one of them. Cut along that plane, the
// part stayed as it was until no cuts were left.
TEST(ReferenceCover, CutsElsewhereWhereThePlaneBetweenTrianglesCutsNothing) {
  const TriangleMesh reference{{{20.369444766337484, 17.602390940529833, 7.9901230552110221},
                                {20.344082639098168, 17.627841532737019, 7.9839521164034561},
                                {20.342970711562899, 17.627889325275863, 7.9812567491280548}},
                               {{2, 1, 0}}};
  const TriangleMesh mesh{{{20.343526675330533, 17.62786542900644, 7.982604432765756},
                           {20.369514142701806, 17.61446663825576, 7.985455241484771},
                           {20.368112086098986, 17.601649961477055, 7.983323074169125},
                           {20.36754, 17.62283, 8.00116}},
                          {{2, 0, 1}, {2, 1, 3}}};
  constexpr double kLimit = 0.0049999249;
  ASSERT_TRUE(decided_distance(reference.view(), ExactMesh(mesh.view()), kLimit).within(kLimit));
  const EditableMesh edited(mesh);
  ReferenceCover cover(reference.triangles, reference.vertices, kLimit * kLimit);
  cover.begin(edited, SlotTree(edited));
  EXPECT_EQ(cover.unproven(), 0u);
}

// The twin begins with the mesh that edits without proofs left.
TEST(ReferenceCover, FindsInTheEndWhatDeferredProofsLetThrough) {
  std::size_t proven = 0, not_proven = 0;
  for (const TriangleMesh& reference : references()) {
    for (const double limit : {0.02, 0.1, 0.3}) {
      Random random(17);
      DecimationState state(reference, reference.vertices, nullptr, limit * limit, any_normal(),
                            nullptr, reference.triangles);
      state.defer_proofs();
      random_collapses(state, random, 60, 0.5 * limit);
      const bool holds = state.prove_deferred();
      const DecimationState twin(state.mesh().compact(), reference.vertices, nullptr, limit * limit,
                                 any_normal(), nullptr, reference.triangles);
      EXPECT_EQ(holds, twin.unproven() == 0);
      EXPECT_TRUE(!holds || beyond(reference, state.mesh().compact(), limit) == 0);
      (holds ? proven : not_proven) += 1;
    }
  }
  EXPECT_GT(proven, 0u);
  EXPECT_GT(not_proven, 0u);
}

}  // namespace
}  // namespace emax::test
