#include "host/decimate/decimation_state.h"

#include <gtest/gtest.h>

#include <limits>

#include "host/decimate/local_search.h"
#include "host/geometry/mesh_validity.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

constexpr double kStateLimit = 0.03;

std::uint32_t mesh_slot_at(const EditableMesh& mesh, std::uint32_t vertex) {
  std::uint32_t found = kNoIndex;
  mesh.for_each_slot_at(vertex, [&](std::uint32_t slot) { found = slot; });
  return found;
}

// Everything that is kept in step, made anew from the triangles and the points.
void expect_in_step(const DecimationState& state, const BackBound& back) {
  const EditableMesh& mesh = state.mesh();
  const AssignedPoints& assigned = state.assigned();
  ASSERT_TRUE(check_mesh(mesh.compact().view()).valid());

  std::vector<std::vector<std::uint32_t>> slots_at(mesh.vertex_slots());
  std::size_t alive = 0, listed = 0;
  for (std::uint32_t slot = 0; slot < mesh.slots(); ++slot) {
    assigned.for_each(slot, [&](std::uint32_t p) {
      ASSERT_EQ(assigned.owner(p), slot);
      ++listed;
    });
    if (!mesh.alive(slot)) continue;
    ++alive;
    for (const std::uint32_t v : mesh.triangle(slot)) slots_at[v].push_back(slot);
    bool found = false;
    const SlotTree::Box box = state.tree().rounded(bounds_of(mesh.corners(slot)));
    state.tree().for_each_overlap(box, [&](std::uint32_t s, const SlotTree::Box& its) {
      found = found || (s == slot && its == box);
      return true;
    });
    ASSERT_TRUE(found);
  }
  ASSERT_EQ(alive, mesh.triangles());
  for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
    std::vector<std::uint32_t> slots;
    mesh.slots_at(v, slots);
    std::sort(slots.begin(), slots.end());
    ASSERT_EQ(slots, slots_at[v]);
    if (!mesh.used(v)) continue;
    // The nearest triangle, or another one that is within the limit too.
    const BackBound::Sight sight = state.sight(v);
    ASSERT_GE(sight.share, back.sight(mesh.position(v)).share - 1e-9);
    const double squared =
        squared_distance(mesh.position(v), back.reference().corners(sight.triangle));
    ASSERT_NEAR(sight.share, squared / (kStateLimit * kStateLimit), 1e-9);
    ASSERT_LE(sight.share, 1);
    const auto [p, q, r] = mesh.corners(mesh_slot_at(mesh, v));
    ASSERT_EQ(state.area_normal(mesh_slot_at(mesh, v)), (q - p).cross(r - p));
  }
  std::size_t owned = 0;
  for (std::uint32_t p = 0; p < assigned.size(); ++p) {
    if (assigned.owner(p) == kNoIndex) continue;
    ++owned;
    ASSERT_TRUE(mesh.alive(assigned.owner(p)));
    ASSERT_NEAR(assigned.squared_distance(p),
                squared_distance(state.point(p), mesh.corners(assigned.owner(p))), 1e-13);
  }
  ASSERT_EQ(owned, listed);
  for (std::uint32_t p = 0; p < assigned.size(); p += 97) {
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t slot = 0; slot < mesh.slots(); ++slot) {
      if (mesh.alive(slot)) {
        least = std::min(least, squared_distance(state.point(p), mesh.corners(slot)));
      }
    }
    const auto nearest =
        state.tree().nearest(mesh, state.point(p), std::numeric_limits<double>::infinity());
    ASSERT_EQ(nearest.squared_distance, least);
  }
}

struct Snapshot {
  explicit Snapshot(const DecimationState& state)
      : triangles(state.mesh().all_triangles().begin(), state.mesh().all_triangles().end()) {
    for (std::uint32_t v = 0; v < state.mesh().vertex_slots(); ++v) {
      positions.push_back(state.mesh().used(v) ? state.mesh().position(v) : Point::Zero());
    }
    for (std::uint32_t p = 0; p < state.assigned().size(); ++p) {
      owners.push_back(state.assigned().owner(p));
      squared.push_back(state.assigned().squared_distance(p));
    }
  }
  bool operator==(const Snapshot&) const = default;

  std::vector<Triangle> triangles;
  std::vector<Point> positions;
  std::vector<std::uint32_t> owners;
  std::vector<double> squared;
};

class Edits : public testing::TestWithParam<bool> {
 protected:
  Edits()
      : mesh_(GetParam() ? bumpy(16, 24) : without_vertex(sheet(20, 0.3), 189)),
        back_(mesh_, kStateLimit),
        state_(mesh_, mesh_.vertices, &back_, kStateLimit * kStateLimit, {}),
        search_(state_) {}

  // One random edit of the kind, kept or not within the limit; whether it was made.
  bool edit(int kind, bool limit, EditUndo* undo) {
    const EditableMesh& mesh = state_.mesh();
    std::uint32_t slot = 0;
    do slot = random_.below(static_cast<std::uint32_t>(mesh.slots()));
    while (!mesh.alive(slot));
    const Triangle t = mesh.triangle(slot);
    Fit fit;
    LocalSearch::Options options;
    if (kind == 3) return split(slot, undo);
    const bool prepared = kind == 0   ? search_.prepare_collapse(t[0], t[1])
                          : kind == 1 ? search_.prepare_relocation(t[0])
                                      : search_.prepare_flip(t[0], t[1]);
    if (!prepared) return false;
    const Point start = kind == 0 ? search_.quadric_optimum() : mesh.position(t[0]);
    if (kind == 2 ? !search_.evaluate(start, 4, fit) : !search_.fit(start, options, fit)) {
      return false;
    }
    MeshEdit edit;
    if (!search_.finish(fit, limit, edit) || !state_.permits(edit)) return false;
    state_.apply(edit, undo);
    return true;
  }

  bool split(std::uint32_t slot, EditUndo* undo) {
    const auto [a, b, c] = state_.mesh().corners(slot);
    const Triangle t = state_.mesh().triangle(slot);
    MeshEdit edit;
    edit.position = (a + b + c) / 3;
    edit.vertex = state_.add_vertex(edit.position);
    edit.removed = {slot};
    edit.added = {{t[0], t[1], edit.vertex}, {t[1], t[2], edit.vertex}, {t[2], t[0], edit.vertex}};
    const std::array<std::array<Point, 3>, 3> shapes = {
        {{a, b, edit.position}, {b, c, edit.position}, {c, a, edit.position}}};
    state_.assigned().for_each(slot, [&](std::uint32_t p) {
      MeshEdit::Answer best{p, 0, kNoIndex, 1e300};
      for (std::uint32_t i = 0; i < 3; ++i) {
        const double squared = squared_distance(state_.point(p), shapes[i]);
        if (squared < best.squared_distance) best = {p, i, kNoIndex, squared};
      }
      edit.answers.push_back(best);
    });
    if (!state_.permits(edit)) return false;
    state_.apply(edit, undo);
    return true;
  }

  TriangleMesh mesh_;
  BackBound back_;
  DecimationState state_;
  LocalSearch search_;
  Random random_{21};
};

TEST_P(Edits, KeepEverythingInStep) {
  expect_in_step(state_, back_);
  std::array<int, 4> made{};
  for (int i = 0; i < 600; ++i) {
    const int kind = i % 8 == 7 ? 3 : i % 4 == 3 ? 2 : i % 2;
    if (!edit(kind, i % 5 != 0, nullptr)) continue;
    ++made[static_cast<std::size_t>(kind)];
    if (i % 5 == 4 || i < 40) expect_in_step(state_, back_);
    if (HasFatalFailure()) return;
    if (i % 100 == 99) state_.reassign();
  }
  for (const int count : made) EXPECT_GT(count, 20);
  expect_in_step(state_, back_);
}

TEST_P(Edits, AreUndoneToTheLastBit) {
  int made = 0;
  for (int series = 0; series < 60; ++series) {
    const Snapshot before(state_);
    const std::size_t vertices = state_.mesh().vertex_slots(), slots = state_.mesh().slots();
    std::vector<EditUndo> undo;
    for (int i = 0; i < 12; ++i) {
      undo.emplace_back();
      if (edit(static_cast<int>(random_.below(3)), false, &undo.back())) {
        ++made;
      } else {
        undo.pop_back();
      }
    }
    for (; !undo.empty(); undo.pop_back()) state_.undo(undo.back());
    ASSERT_EQ(state_.mesh().vertex_slots(), vertices);
    ASSERT_EQ(state_.mesh().slots(), slots);
    EXPECT_TRUE(Snapshot(state_) == before);
    expect_in_step(state_, back_);
    if (HasFatalFailure()) return;
    edit(0, true, nullptr);
  }
  EXPECT_GT(made, 150);
}

TEST_P(Edits, OfOneKindAfterSplitsAreUndoneToo) {
  EditUndo undo;
  const std::size_t triangles = state_.mesh().triangles();
  ASSERT_TRUE(split(5, &undo));
  EXPECT_EQ(state_.mesh().triangles(), triangles + 2);
  expect_in_step(state_, back_);
  state_.undo(undo);
  EXPECT_EQ(state_.mesh().triangles(), triangles);
  expect_in_step(state_, back_);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, Edits, testing::Bool(),
                         [](const auto& param) { return param.param ? "Closed" : "Open"; });

// A triangle of the reference whose corners the mesh has and whose inside lies under a tent.
class Tent : public testing::Test {
 protected:
  static constexpr double kSquaredLimit = kStateLimit * kStateLimit;

  explicit Tent(double height = 2.5 * kStateLimit)
      : mesh_{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0.1, -0.2, height}},
              {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}},
        cloud_(mesh_.vertices.begin(), mesh_.vertices.begin() + 3),
        state_(mesh_, cloud_, nullptr, kSquaredLimit, {}, nullptr, reference_) {}

  double to_mesh(const Point& p) const {
    double least = 1e300;
    for (std::size_t t = 0; t < 3; ++t) {
      least = std::min(least, squared_distance(p, mesh_.view().corners(t)));
    }
    return least;
  }

  const TriangleMesh mesh_;
  const std::vector<Point> cloud_;
  const std::vector<Triangle> reference_ = {{0, 1, 2}};
  DecimationState state_;
};

TEST_F(Tent, GetsAWitnessWhereTheReferenceIsFarthest) {
  ASSERT_EQ(state_.unproven(), 1u);
  const DecimationState::Snapshot before = state_.snapshot();
  ASSERT_EQ(state_.add_witnesses(), 1u);
  const AssignedPoints& assigned = state_.assigned();
  ASSERT_EQ(assigned.size(), 4u);
  double farthest = 0;
  for (int i = 0; i <= 100; ++i) {
    for (int j = 0; i + j <= 100; ++j) {
      farthest = std::max(farthest, to_mesh(cloud_[0] + i / 100.0 * (cloud_[1] - cloud_[0]) +
                                            j / 100.0 * (cloud_[2] - cloud_[0])));
    }
  }
  EXPECT_GT(to_mesh(state_.point(3)), 0.8 * farthest);
  EXPECT_DOUBLE_EQ(assigned.squared_distance(3), to_mesh(state_.point(3)));
  EXPECT_GT(assigned.squared_distance(3), kSquaredLimit);
  EXPECT_DOUBLE_EQ(squared_distance(state_.point(3), state_.mesh().corners(assigned.owner(3))),
                   to_mesh(state_.point(3)));
  state_.restore(before);
  EXPECT_EQ(state_.assigned().size(), 3u);
}

class FlatTent : public Tent {
 protected:
  FlatTent() : Tent(0.5 * kStateLimit) {}
};

TEST_F(FlatTent, NeedsNoWitness) {
  EXPECT_EQ(state_.unproven(), 0u);
  EXPECT_EQ(state_.add_witnesses(), 0u);
}

}  // namespace
}  // namespace emax::test
