#include "host/report/error_ply.h"

#include <gtest/gtest.h>

#include <cstring>

#include "host/files/cloud_file.h"
#include "host/files/mesh_file.h"
#include "host/picture/colour.h"
#include "tests/support/temporary_folder.h"

namespace emax {
namespace {

TEST(ErrorPly, IsReadBackWithDistancesAndColours) {
  const test::TemporaryFolder folder;
  const std::vector<Point> points = {{0.1, 0.2, 0.3}, {4, 5, 6}, {-7, 8, 1e10}};
  const std::vector<double> distances = {0, 0.125, 0.3};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {2, 1, 0}};
  write_error_ply(folder / "mesh.ply", points, distances, 0.25, triangles);
  const TriangleMesh mesh = read_mesh(folder / "mesh.ply");
  EXPECT_EQ(mesh.vertices, points);
  EXPECT_EQ(mesh.triangles, triangles);

  write_error_ply(folder / "cloud.ply", points, distances, 0.25);
  EXPECT_EQ(read_cloud(folder / "cloud.ply").points, points);
  EXPECT_FALSE(holds_triangles(folder / "cloud.ply"));
  EXPECT_TRUE(holds_triangles(folder / "mesh.ply"));
  const std::string bytes = test::bytes_of(folder / "cloud.ply");
  const std::size_t body = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size(), body + 3 * 35);
  EXPECT_NE(bytes.find("property double distance\n"), std::string::npos);
  const Colour expected[] = {viridis(0), viridis(0.5), viridis(1)};
  for (std::size_t i = 0; i < 3; ++i) {
    double distance = -1;
    std::memcpy(&distance, bytes.data() + body + 35 * i + 24, sizeof distance);
    EXPECT_EQ(distance, distances[i]);
    EXPECT_EQ(std::memcmp(bytes.data() + body + 35 * i + 32, expected[i].data(), 3), 0) << i;
  }
}

TEST(ErrorPly, OfNoDistanceAtAllIsDarkBlue) {
  const test::TemporaryFolder folder;
  const std::vector<Point> points = {{1, 2, 3}};
  const std::vector<double> distances = {0};
  write_error_ply(folder / "cloud.ply", points, distances, 0);
  const std::string bytes = test::bytes_of(folder / "cloud.ply");
  EXPECT_EQ(std::memcmp(bytes.data() + bytes.size() - 3, viridis(0).data(), 3), 0);
}

}  // namespace
}  // namespace emax
