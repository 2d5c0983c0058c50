#include "host/files/mesh_file.h"

#include <bit>
#include <cmath>
#include <limits>

#include "file_bytes.h"
#include "host/files/cloud_file.h"
#include "host/geometry/merge_vertices.h"
#include "tests/support/messages.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

const std::vector<std::string> kNames{"a.ply", "a.obj", "a.stl", "a.off",
                                      "a.glb", "a.3mf", "a.dxf"};

// Equality of values would take -0 for 0.
void expect_same_bits(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(a.vertices[i][k]),
                std::bit_cast<std::uint64_t>(b.vertices[i][k]))
          << "vertex " << i;
    }
  }
}

TriangleMesh random_mesh(std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (int i = 0; i < 60; ++i) {
    const Point direction = random.point(-1, 1);
    mesh.vertices.push_back(std::ldexp(1.0, static_cast<int>(random.below(60))) * direction);
  }
  // Awkward for text, for 32 bit and for merging.
  mesh.vertices.push_back({-0.0, 5e-324, -1e-50});
  mesh.vertices.push_back({0.1, 10000000.001, 1.0 / 3});
  mesh.vertices.push_back({0.1, 10000000.0010000001, 1.0 / 3});
  mesh.vertices.push_back(mesh.vertices.front());
  const auto count = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 100; ++i) {
    mesh.triangles.push_back(
        Triangle{random.below(count), random.below(count), random.below(count)});
  }
  for (std::uint32_t last = 1; last <= 4; ++last) mesh.triangles.push_back({0, 1, count - last});
  return mesh;
}

TEST(MeshFile, ReadsBackExactlyWhatAsStoredTells) {
  const TemporaryFolder folder;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const TriangleMesh mesh = random_mesh(seed);
    for (const std::string& name : kNames) {
      SCOPED_TRACE(name + ", seed " + std::to_string(seed));
      const MeshFormat format = mesh_format(name);
      write_mesh(folder / name, mesh);
      EXPECT_EQ(bytes_of(folder / name), mesh_bytes(mesh, format));
      const TriangleMesh stored = as_stored(mesh, storage_of(format));
      expect_same_bits(read_mesh(folder / name), stored);
      expect_same_bits(as_stored(stored, storage_of(format)), stored);
      EXPECT_EQ(storage_of(format) == Storage::kBinary32, format == MeshFormat::kStl);
      if (storage_of(format) == Storage::kExact) expect_same_bits(stored, mesh);
    }
  }
}

TEST(MeshFile, StlRoundsMergesAndKeepsCollapsedTriangles) {
  // Vertices 1 and 3 fall together in 32 bit, 0 and 4 differ in the sign of zero, 5 is not used.
  const TriangleMesh mesh{
      {{0, 0, 0}, {16777216, 0, 0}, {0, 1, 0}, {16777217, 0, 0}, {-0.0, 0, 0}, {9, 9, 9}},
      {{2, 0, 1}, {4, 3, 1}}};
  const TriangleMesh stored = as_stored(mesh, Storage::kBinary32);
  EXPECT_EQ(stored.vertices, (std::vector<Point>{{0, 1, 0}, {0, 0, 0}, {16777216, 0, 0}}));
  EXPECT_EQ(stored.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 2, 2}}));
  EXPECT_EQ(storage_displacement(mesh, Storage::kBinary32), 1.0);
}

TEST(MeshFile, StorageDisplacementDecidesWhatMayBeStored) {
  const TriangleMesh mesh{{{10000000.001, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}};
  const double displacement = storage_displacement(mesh, Storage::kBinary32);
  EXPECT_NEAR(displacement, 0.001, 1e-8);
  for (const MeshFormat exact : {MeshFormat::kPly, MeshFormat::kObj, MeshFormat::kOff,
                                 MeshFormat::kThreeMf, MeshFormat::kDxf}) {
    EXPECT_EQ(storage_displacement(mesh, storage_of(exact)), 0);
    EXPECT_NO_THROW(require_storable(mesh, exact, 1e-300, "out.ply"));
  }
  EXPECT_NO_THROW(require_storable(mesh, MeshFormat::kStl, 101 * displacement, "out.stl"));
  expect_clear(
      message_of([&] { require_storable(mesh, MeshFormat::kStl, 99 * displacement, "out.stl"); }),
      "out.stl: ", "32 bits of STL", ".ply");
  const TriangleMesh beyond{{{1e39, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}};
  EXPECT_THROW(require_storable(beyond, MeshFormat::kStl, 1e300, "out.stl"), Error);
}

TEST(MeshFile, ReadsWhatOthersWrite) {
  const TemporaryFolder folder;
  const std::vector<Point> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<Triangle> fan{{0, 1, 2}, {0, 2, 3}};
  const auto expect_square = [&](std::string_view name, std::string_view bytes) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = read_mesh(folder.write(name, bytes));
    EXPECT_EQ(mesh.vertices, square);
    EXPECT_EQ(mesh.triangles, fan);
  };
  expect_square("quad.off", "OFF\n4 1 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 0.5 0.5 0.5 1\n");
  expect_square("quad.obj",
                "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ng g1\n"
                "f 1/1/1 2//1 -2/1 -1\n");
  expect_square("early.obj", "f 1 2 3\nf 1 3 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n");
  expect_square("quad.ply",
                "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\n"
                "property uchar red\nelement vertex 4\nproperty double x\nproperty double y\n"
                "property double z\nend_header\n4 0 1 2 3 255\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n");
  expect_square("text.stl",
                "solid my part\n  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n"
                "      vertex 1 0 0\n      vertex 1.0e0 1 0\n    endloop\n  endfacet\n"
                "  facet normal nan 0 1\n    outer loop\n      vertex -0 0 0\n      vertex 1 1 0\n"
                "      vertex 0 1 0\n    endloop\n  endfacet\nendsolid my part\n");
  // A binary file whose header begins like text.
  std::string binary = "solid but binary";
  binary.resize(80, '\0');
  append(binary, std::uint32_t{2});
  for (const Triangle& t : fan) {
    for (int k = 0; k < 3; ++k) append(binary, 0.0f);
    for (const std::uint32_t corner : t) {
      for (int k = 0; k < 3; ++k) append(binary, static_cast<float>(square[corner][k]));
    }
    append(binary, std::uint16_t{77});
  }
  expect_square("binary.stl", binary);
}

const std::string kStripHeader =
    "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
    "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";

std::string text_strips(const std::string& corners) {
  return "ply\nformat ascii 1.0\n" + kStripHeader + "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n" +
         corners + "\n";
}

TEST(MeshFile, StripsOfAPlyFileBecomeTrianglesThatFaceOneWay) {
  const TemporaryFolder folder;
  struct Case {
    std::vector<std::int32_t> corners;
    std::vector<Triangle> triangles;
  };
  const std::vector<Case> cases{
      {{0, 1, 2}, {{0, 1, 2}}},
      {{0, 1, 2, 3, 4, 5}, {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}}},
      // Every strip begins anew with the winding of its first triangle.
      {{0, 1, 2, 3, -1, 2, 3, 4, -1}, {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}},
      {{-1, 0, 1, 2, -1, -1, 3, 4, 5}, {{0, 1, 2}, {3, 4, 5}}},
      // A repeated corner stitches: it makes no triangle, and turns the next one.
      {{0, 1, 2, 2, 3, 4}, {{0, 1, 2}, {3, 2, 4}}}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::vector<std::int32_t>& corners = cases[i].corners;
    std::string text = std::to_string(corners.size());
    for (const std::int32_t corner : corners) text += ' ' + std::to_string(corner);
    const TriangleMesh mesh = read_mesh(folder.write("a.ply", text_strips(text)));
    EXPECT_EQ(mesh.triangles, cases[i].triangles) << "case " << i;
    ASSERT_EQ(mesh.vertices.size(), 6u);
    for (const bool big_endian : {false, true}) {
      std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                          "_endian 1.0\n" + kStripHeader;
      for (const Point& v : mesh.vertices) {
        for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(v[k]), big_endian);
      }
      append(bytes, static_cast<std::int32_t>(corners.size()), big_endian);
      for (const std::int32_t corner : corners) append(bytes, corner, big_endian);
      EXPECT_EQ(read_mesh(folder.write("b.ply", bytes)).triangles, cases[i].triangles)
          << "case " << i << (big_endian ? ", big endian" : ", little endian");
      const std::filesystem::path cut = folder.write("c.ply", bytes.substr(0, bytes.size() - 1));
      expect_clear(message_of([&] { read_mesh(cut); }), cut.string(), "tristrips 0: a list of",
                   "truncated");
    }
  }
}

TEST(MeshFile, VerticesOfAMeshFileAreACloud) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = random_mesh(9);
  for (const std::string name : {"a.ply", "a.obj", "a.off"}) {
    write_mesh(folder / name, mesh);
    EXPECT_EQ(read_cloud(folder / name).points, mesh.vertices) << name;
  }
}

TEST(MeshFile, NamesWhatElseAFileSaysOfItsMesh) {
  const TemporaryFolder folder;
  const auto attributes = [&](std::string_view name, std::string_view bytes) {
    return read_mesh_file(folder.write(name, bytes)).attributes;
  };
  using Names = std::vector<std::string>;
  const std::string off = "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
  EXPECT_EQ(attributes("a.off", "OFF\n" + off), Names{});
  EXPECT_EQ(attributes("a.off", "OFF\n" + off + " 0.5 0.5 0.5\n"), Names{"colours"});
  EXPECT_EQ(attributes("a.off",
                       "CNOFF\n3 1 0\n0 0 0 0 0 1 9 9 9\n1 0 0 0 0 1 9 9 9\n"
                       "0 1 0 0 0 1 9 9 9\n3 0 1 2 7\n"),
            (Names{"normals", "colours"}));
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(attributes("a.obj", obj), Names{});
  EXPECT_EQ(attributes("a.obj", "mtllib a.mtl\no part\ng side\ns 1\nvt 0 0\nvn 0 0 1\n" + obj +
                                    "usemtl red\nf 1/1/1 2/1/1 3/1/1\nl 1 2\n"),
            (Names{"materials", "groups", "smoothing groups", "texture coordinates", "normals",
                   "lines"}));
  EXPECT_EQ(attributes("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n"),
            Names{"colours"});
  EXPECT_EQ(attributes("a.obj", "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n"), Names{})
      << "weights";
  const auto ply = [&](const std::string& vertex, const std::string& face, const std::string& more,
                       const std::string& body) {
    return attributes("a.ply",
                      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                      "property float y\nproperty float z\n" +
                          vertex + "element face 1\nproperty list uchar int vertex_index\n" + face +
                          more + "end_header\n" + body);
  };
  EXPECT_EQ(ply("", "", "element edge 0\nproperty int a\n", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
            Names{});
  EXPECT_EQ(ply("property uchar red\nproperty uchar alpha\nproperty float nx\n"
                "property float quality\nproperty float s\n",
                "property list uchar float texcoord\nproperty int texnumber\nproperty int flags\n",
                "element edge 1\nproperty int a\n",
                "0 0 0 9 9 0 1 0\n1 0 0 9 9 0 1 0\n0 1 0 9 9 0 1 0\n3 0 1 2 2 0 0 7 1\n5\n"),
            (Names{"colours", "normals", "\"quality\"", "texture coordinates", "materials",
                   "\"flags\"", "\"edge\""}));
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  EXPECT_EQ(attributes("a.stl", "solid\n" + facet + "endsolid\n"), Names{});
  EXPECT_EQ(attributes("a.stl", "solid a\n" + facet + "endsolid\nsolid b\n" + facet + "endsolid\n"),
            Names{"groups"});
  std::string stl = mesh_bytes({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, MeshFormat::kStl);
  EXPECT_EQ(attributes("b.stl", stl), Names{});
  stl.back() = '\x80';
  EXPECT_EQ(attributes("b.stl", stl), Names{"colours"});
}

TEST(MeshFile, VerticesOfNoTriangleNeedNotBeFinite) {
  const TemporaryFolder folder;
  const std::string vertices = "OFF\n5 1 0\n0 nan 0\n0 0 0\n1 0 0\n0 inf 1\n0 1 0\n3 ";
  const TriangleMesh mesh = read_mesh(folder.write("a.off", vertices + "1 2 4\n"));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{1, 2, 4}}));
  EXPECT_EQ(mesh.vertices,
            (std::vector<Point>{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}}));
  const std::filesystem::path bad = folder.write("b.off", vertices + "1 2 3\n");
  expect_clear(message_of([&] { read_mesh(bad); }), bad.string(), "line 3: a coordinate is NaN",
               "finite");
}

TEST(MeshFile, DroppingUnusedVerticesKeepsTheOrderOfTheOthers) {
  TriangleMesh mesh{{{9, 9, 9}, {0, 0, 0}, {8, 8, 8}, {1, 0, 0}, {0, 1, 0}, {7, 7, 7}},
                    {{4, 1, 3}, {3, 3, 4}}};
  drop_unused_vertices(mesh.vertices, mesh.triangles);
  EXPECT_EQ(mesh.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{2, 0, 1}, {1, 1, 2}}));
}

TEST(MeshFile, BadMeshesAreRefused) {
  std::string stl(80, ' ');
  append(stl, std::uint32_t{1});
  const std::string whole = stl + std::string(50, '\0');
  std::string infinite = stl + std::string(12, '\0');
  append(infinite, std::numeric_limits<float>::infinity());
  infinite.resize(whole.size(), '\0');
  struct Case {
    std::string name, bytes, fault, remedy;
  };
  const std::vector<Case> cases{
      {"a.xyz", "1 2 3\n", "unknown ending \".xyz\"", ".ply, .obj, .stl, .off"},
      {"a.off", "OFF\n3 0 0\n1 2 3\n4 5 6\n7 8 8\n", "no triangles", "give a mesh"},
      {"a.obj", "v 1 2 3\nv 3 4 5\n", "no triangles", "give a mesh"},
      {"a.off", "OFF\n3 1 0\n1 2 3\n4 nan 6\n7 8 8\n3 0 1 2\n", "line 4: a coordinate is NaN",
       "finite"},
      {"a.off", "OFF\n3 1 0\n1 2 3\n4 5 6\n7 8 8\n3 0 1 3\n", "line 6: vertex index 3 is outside",
       "export"},
      {"a.ply", text_strips("4 0 1 2 6"), "line 16: vertex index 6 is outside 0..6 - 1", "export"},
      {"a.ply", text_strips("4 0 0 0 6"), "vertex index 6", "export"},
      {"a.ply", text_strips("4 0 1 2 -2"), "vertex index -2", "export"},
      {"a.ply", text_strips("6 0 1 2 -1 4 5"), "a strip of 2 corners", "export"},
      {"a.ply", text_strips("5 0 1 2 3"), "a list of 5 values", "export"},
      {"a.ply", text_strips("3 0 1 2 3"), "5 values where 4", "export"},
      {"a.ply", text_strips("2 -1 -1"), "no triangles", "give a mesh"},
      {"a.stl", "OFF\n3 0 0\n1 2 3\n", "a .off file", "rename it to .off"},
      {"a.stl", "too short", "84 bytes", "export"},
      {"a.stl", whole.substr(0, whole.size() - 1), "promises 1 triangles", "truncated"},
      {"a.stl", whole + " ", "promises 1 triangles", "truncated"},
      {"a.stl", infinite, "triangle 0: a coordinate is NaN or infinite", "finite"},
      {"a.stl", "solid x\n", "\"endsolid\" must follow", "truncated"},
      {"a.stl", "solid x\nendsolid\n", "no triangles", "give a mesh"},
      {"a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\n", "\"vertex\" must follow",
       "truncated"},
      {"a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2\n", "line 4: \"vertex\"",
       "export"},
      {"a.stl", "solid x\nfacet normal 0 0\n", "line 2: \"facet normal\"", "export"},
      {"a.stl", "solid x\nfacet normal 0 0 1\nouter hoop\n", "line 3: \"outer loop\"", "export"},
      {"a.stl", "solid x\nendsolid\nmore\n", "line 3: \"solid\"", "export"}};
  const TemporaryFolder folder;
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name + ": " + c.fault);
    const std::filesystem::path path = folder.write(c.name, c.bytes);
    expect_clear(message_of([&] { read_mesh(path); }), path.string() + ": ", c.fault, c.remedy);
  }
  const std::filesystem::path missing = folder / "missing.stl";
  expect_clear(message_of([&] { read_mesh(missing); }), missing.string(), "no such file", "path");
  expect_clear(message_of([&] { mesh_format("out.gltf"); }), "out.gltf", "unknown ending", ".ply");
}

}  // namespace
}  // namespace emax::test
