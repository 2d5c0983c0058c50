#include "host/decimate/editable_mesh.h"

#include <gtest/gtest.h>

#include <set>

#include "host/geometry/mesh_validity.h"
#include "tests/host/support/surfaces.h"

namespace emax::test {
namespace {

struct Topology {
  bool manifold;
  std::size_t components;
  long euler;
  bool boundary;
  std::size_t vertices;
};

Topology topology(const TriangleMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::set<std::uint32_t> vertices;
  std::set<std::set<std::uint32_t>> faces;
  for (const Triangle& t : mesh.triangles) {
    faces.insert({t[0], t[1], t[2]});
    for (std::size_t i = 0; i < 3; ++i) {
      vertices.insert(t[i]);
      edges.insert(std::minmax(t[i], t[(i + 1) % 3]));
    }
  }
  const MeshValidity v = check_mesh(mesh.view());
  const bool manifold =
      v.non_manifold_edges + v.non_manifold_vertices + v.inconsistent_edges == 0 &&
      faces.size() == mesh.triangles.size();
  return {manifold, v.components,
          static_cast<long>(vertices.size() + faces.size()) - static_cast<long>(edges.size()),
          v.boundary_edges > 0, vertices.size()};
}

std::vector<TriangleMesh> meshes() {
  TriangleMesh tetrahedron = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                              {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  TriangleMesh octahedron = bumpy(2, 4);
  TriangleMesh bipyramid = bumpy(2, 3);
  TriangleMesh triangle = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  TriangleMesh pair = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {2, 1, 3}}};
  // A strip around an axis, three quads long: its two boundaries are three edges each.
  TriangleMesh band = {{{1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 1, 1}, {-1, -1, 1}},
                       {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}, {2, 0, 5}, {0, 3, 5}}};
  return {tetrahedron,
          octahedron,
          bipyramid,
          triangle,
          pair,
          band,
          sheet(2, 0),
          sheet(4, 0),
          bumpy(6, 5),
          without_vertex(bumpy(6, 5), 8),
          without_vertex(sheet(5, 0), 12),
          joined(bumpy(3, 4), sheet(3, 0), {3, 0, 0})};
}

// Twin: the collapse made, and everything that topology is counted before and after.
TEST(EditableMesh, CollapsesExactlyWhatKeepsTheTopology) {
  std::size_t allowed = 0, refused = 0;
  for (const TriangleMesh& mesh : meshes()) {
    const EditableMesh editable(mesh);
    const Topology before = topology(mesh);
    for (std::uint32_t a = 0; a < mesh.vertices.size(); ++a) {
      for (std::uint32_t b = 0; b < mesh.vertices.size(); ++b) {
        if (a == b || editable.slots_at_edge(a, b)[0] == kNoIndex) continue;
        TriangleMesh after = mesh;
        std::erase_if(after.triangles, [&](const Triangle& t) { return has(t, a) && has(t, b); });
        for (Triangle& t : after.triangles) std::replace(t.begin(), t.end(), b, a);
        const Topology now = topology(after);
        const bool same = now.manifold && now.components == before.components &&
                          now.euler == before.euler && now.boundary == before.boundary &&
                          now.vertices + 1 == before.vertices;
        EXPECT_EQ(editable.collapsible(a, b), same)
            << mesh.vertices.size() << " vertices: " << a << " " << b;
        ++(same ? allowed : refused);
      }
    }
  }
  EXPECT_GT(allowed, 100u);
  EXPECT_GT(refused, 50u);
}

TEST(EditableMesh, KnowsItsBoundary) {
  for (const TriangleMesh& mesh : meshes()) {
    const EditableMesh editable(mesh);
    EXPECT_EQ(editable.closed(), check_mesh(mesh.view()).boundary_edges == 0);
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      if (!editable.used(v)) continue;
      bool open = false;
      std::vector<std::uint32_t> around;
      editable.neighbours(v, around);
      for (const std::uint32_t n : around) {
        int users = 0;
        for (const Triangle& t : mesh.triangles) users += has(t, v) && has(t, n) ? 1 : 0;
        open = open || users == 1;
      }
      EXPECT_EQ(editable.on_boundary(v), open);
    }
  }
}

TEST(EditableMesh, ComesBackAsItWas) {
  for (const TriangleMesh& mesh : meshes()) {
    const TriangleMesh back = EditableMesh(mesh).compact();
    EXPECT_EQ(back.triangles.size(), mesh.triangles.size());
    EXPECT_TRUE(same_bytes(EditableMesh(back).compact(), back));
  }
}

}  // namespace
}  // namespace emax::test
