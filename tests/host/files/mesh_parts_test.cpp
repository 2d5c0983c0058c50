#include "host/files/mesh_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "file_bytes.h"
#include "host/files/mesh_file.h"
#include "tests/support/messages.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

using Corners = std::vector<std::array<Point, 3>>;

Corners corners_of(const TriangleMesh& mesh) {
  Corners corners;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    corners.push_back(mesh.view().corners(i));
  }
  return corners;
}

// A PLY file of big-endian floats with other properties and elements, and of polygons that are not
// convex.
std::string polygons() {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement camera 1\nproperty uchar id\n"
      "element vertex 35\nproperty uchar red\nproperty float z\nproperty float x\n"
      "property float y\nelement face 20\nproperty uchar flags\n"
      "property list ushort uint vertex_index\nproperty list uchar float texcoord\nend_header\n";
  const auto put = [&bytes](auto number) { test::append(bytes, number, true); };
  put(std::uint8_t{7});
  test::Random random(12);
  for (int v = 0; v < 35; ++v) {
    put(std::uint8_t{200});
    for (int k = 0; k < 3; ++k) put(static_cast<float>(random.uniform(-1, 1)));
  }
  for (std::uint32_t f = 0; f < 20; ++f) {
    put(std::uint8_t{1});
    const auto corners = static_cast<std::uint16_t>(3 + f % 6);
    put(corners);
    for (std::uint32_t k = 0; k < corners; ++k) put((f * 11 + k * 3) % 35);
    put(std::uint8_t{2});
    put(0.5f);
    put(0.25f);
  }
  return bytes;
}

TEST(MeshParts, AreTheWholeMesh) {
  const test::TemporaryFolder folder;
  const test::Stimulus s = test::bumpy_sphere(12, 16, 0, 5);
  write_mesh(folder / "sphere.ply", {s.vertices, s.triangles});
  write_mesh(folder / "sphere.stl", {s.vertices, s.triangles});
  folder.write("polygons.ply", polygons());
  for (const char* file : {"sphere.ply", "sphere.stl", "polygons.ply"}) {
    const TriangleMesh all = read_mesh(folder / file);
    const Corners whole = corners_of(all);
    const MeshParts mesh(folder / file);
    EXPECT_EQ(mesh.vertices().value_or(all.vertices.size()), all.vertices.size());
    ASSERT_TRUE(mesh.promised()) << file;
    EXPECT_LE(*mesh.promised(), whole.size());
    for (const std::size_t most : {1u, 7u, 100u, 1000u}) {
      Corners found;
      const std::uint64_t triangles = mesh.read(most, [&](const MeshPart& part) {
        EXPECT_EQ(part.first, found.size());
        EXPECT_LE(part.mesh.triangles.size(), most + 5);  // the last polygon has up to 6 triangles
        EXPECT_LE(part.mesh.vertices.size(), 3 * part.mesh.triangles.size());
        for (const auto& corners : corners_of(part.mesh)) found.push_back(corners);
        EXPECT_EQ(part.vertex_numbers.size(), mesh.vertices() ? part.mesh.vertices.size() : 0);
        for (std::size_t v = 0; v < part.vertex_numbers.size(); ++v) {
          EXPECT_EQ(part.mesh.vertices[v], all.vertices[part.vertex_numbers[v]]);
        }
      });
      EXPECT_EQ(triangles, whole.size());
      EXPECT_EQ(found, whole) << file << " in parts of " << most;
    }
  }
}

TEST(MeshParts, NamesFilesThatAreHeldWhole) {
  const test::TemporaryFolder folder;
  folder.write("text.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  folder.write("late.ply",
               "ply\nformat binary_little_endian 1.0\nelement face 0\n"
               "property list uchar int vertex_indices\nelement vertex 0\nproperty float x\n"
               "property float y\nproperty float z\nend_header\n");
  folder.write("strips.ply",
               "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\n"
               "property float y\nproperty float z\nelement tristrips 0\n"
               "property list int int vertex_indices\nend_header\n");
  folder.write("text.stl", "solid a\nendsolid a\n");
  folder.write("mesh.off", "OFF\n0 0 0\n");
  for (const char* file : {"text.ply", "late.ply", "strips.ply", "text.stl", "mesh.off"}) {
    EXPECT_FALSE(MeshParts(folder / file).promised()) << file;
  }
}

class DamagedMeshParts : public testing::Test {
 protected:
  DamagedMeshParts() {
    const test::Stimulus s = test::bumpy_sphere(6, 8, 0, 6);
    bytes_ = mesh_bytes({s.vertices, s.triangles}, MeshFormat::kPly);
    triangles_ = s.triangles.size();
    vertices_ = s.vertices.size();
  }

  // The same message as where the mesh is read whole, after the parts before.
  std::string message(const std::string& bytes, std::size_t parts_before) {
    folder_.write("mesh.ply", bytes);
    std::size_t parts = 0;
    const std::string found = test::message_of(
        [&] { MeshParts(folder_ / "mesh.ply").read(10, [&](const MeshPart&) { ++parts; }); });
    EXPECT_EQ(found, test::message_of([&] { read_mesh(folder_ / "mesh.ply"); }));
    EXPECT_EQ(parts, parts_before);
    return found;
  }
  std::size_t face_at(std::size_t face) const { return bytes_.size() - (triangles_ - face) * 13; }

  test::TemporaryFolder folder_;
  std::string bytes_;
  std::size_t triangles_, vertices_;
};

TEST_F(DamagedMeshParts, CutOffWithinAPart) {
  test::expect_clear(message(bytes_.substr(0, face_at(25) + 6), 2), (folder_ / "mesh.ply").string(),
                     "face 25: a list of 3 values does not fit", "truncated");
  // A face whose list has no room is noticed where it stands.
  std::string longer = bytes_;
  longer[face_at(triangles_ - 1)] = 100;
  test::expect_clear(message(longer, (triangles_ - 1) / 10), (folder_ / "mesh.ply").string(),
                     "a list of 100 values does not fit", "truncated");
}

TEST_F(DamagedMeshParts, AnIndexOutOfRangeInALaterPart) {
  const auto wrong = static_cast<std::uint32_t>(vertices_);
  std::memcpy(bytes_.data() + face_at(33) + 5, &wrong, sizeof wrong);
  test::expect_clear(message(bytes_, 3), (folder_ / "mesh.ply").string(), "face 33: vertex index",
                     "export it again");
}

TEST_F(DamagedMeshParts, AVertexThatIsNotFinite) {
  const double wrong = std::numeric_limits<double>::quiet_NaN();
  std::memcpy(bytes_.data() + face_at(0) - 24, &wrong, sizeof wrong);  // x of the last vertex
  std::size_t first_part = 0;
  const test::Stimulus s = test::bumpy_sphere(6, 8, 0, 6);
  while (std::ranges::find(s.triangles[first_part], vertices_ - 1) ==
         s.triangles[first_part].end()) {
    ++first_part;
  }
  test::expect_clear(message(bytes_, first_part / 10), (folder_ / "mesh.ply").string(),
                     "a coordinate is NaN or infinite", "mend the mesh");
}

}  // namespace
}  // namespace emax
