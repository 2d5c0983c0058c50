// Clouds that are read in pieces are those that are read whole.

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "file_bytes.h"
#include "host/files/cloud_file.h"
#include "tests/support/messages.h"
#include "tests/support/scan_bytes.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

class CloudPieces : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

// A cloud read in pieces, put together again.
PointCloud joined_pieces(const std::filesystem::path& path, const CloudReadOptions& options,
                         std::size_t piece_points) {
  std::vector<Point> points;
  std::vector<std::uint32_t> indices;
  PointCloud whole = read_cloud_in_pieces(path, options, piece_points, [&](PointCloud piece) {
    EXPECT_LE(piece.points.size(), piece_points);
    EXPECT_FALSE(piece.points.empty());
    EXPECT_TRUE(piece.normals.empty());
    points.insert(points.end(), piece.points.begin(), piece.points.end());
    for (std::size_t i = 0; i < piece.points.size(); ++i) {
      indices.push_back(piece.index_in_file(i));
    }
  });
  whole.points = std::move(points);
  whole.file_index = std::move(indices);
  return whole;
}

void expect_same_in_pieces(const std::filesystem::path& path, bool skip_invalid = false) {
  const PointCloud whole = read_cloud(path, {skip_invalid});
  for (const std::size_t piece_points : {1, 2, 3, 1000}) {
    SCOPED_TRACE(path.string() + " in pieces of " + std::to_string(piece_points));
    const PointCloud joined = joined_pieces(path, {skip_invalid}, piece_points);
    ASSERT_EQ(joined.points, whole.points);
    for (std::size_t i = 0; i < whole.points.size(); ++i) {
      EXPECT_EQ(joined.index_in_file(i), whole.index_in_file(i));
    }
    EXPECT_EQ(joined.unit, whole.unit);
    EXPECT_EQ(joined.resolution, whole.resolution);
    EXPECT_EQ(describe(joined.left_out), describe(whole.left_out));
  }
}

constexpr std::string_view kTextPly =
    "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 0 0 1\n1 0 nan 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n5 5 5 0 0 1\n"
    "3 0 1 2\n4 0 1 2 3\n";

TEST_F(CloudPieces, AreTheWhole) {
  expect_same_in_pieces(folder_.write("a.ply", kTextPly), true);
  expect_same_in_pieces(folder_.write("a.xyz", "1 2 3 0 0 1\n4 5 6 0 0 1\n7 8 9 0 0 1\n"));
  expect_same_in_pieces(folder_.write("a.pts", "2\n1 2 3 4\n5 6 7 8\n"));
  expect_same_in_pieces(folder_.write("a.obj", "v 1 2 3\nv nan 5 6\nv 7 8 9\nf 1 2 3\n"), true);
  expect_same_in_pieces(
      folder_.write("a.ptx",
                    "2\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n5 0 0 1\n"
                    "1 2 3 0.5\n0 0 0 0.5\n4 5 6 0.5\n7 8 nan 0.5\n"),
      true);
  expect_same_in_pieces(folder_.write("a.e57", e57_pages(e57_content())));
  expect_same_in_pieces(folder_.write(
      "a.las", las_bytes({{0, 0, 0, 2}, {1, 0, 0, 0x80 | 2}, {2, 0, 0, 2}, {3, 1, 0, 2}})));
  for (const auto& entry : std::filesystem::directory_iterator(EMAX_TEST_DATA)) {
    const std::string ending = entry.path().extension().string();
    if (std::ranges::find(cloud_endings(), ending) == cloud_endings().end()) continue;
    expect_same_in_pieces(entry.path());
  }
}

// Every second piece, or every third, and whether the others may stay unread.
void expect_same_pieces_chosen(const std::filesystem::path& path, bool skip_invalid = false) {
  for (const std::size_t piece_points : {1, 2, 1000}) {
    std::vector<PointCloud> all;
    const PointCloud whole =
        read_cloud_in_pieces(path, {skip_invalid}, piece_points,
                             [&](PointCloud piece) { all.push_back(std::move(piece)); });
    for (const std::size_t each : {2, 3}) {
      SCOPED_TRACE(path.string() + " in pieces of " + std::to_string(piece_points));
      std::size_t asked = 0, given = 0;
      const PointCloud rest = read_cloud_in_pieces(
          path, {skip_invalid}, piece_points,
          [&](const PointCloud& piece) {
            ASSERT_LT(given, all.size());
            const PointCloud& expected = all[given++];
            const bool is_wanted = (asked - 1) % each == 0;
            EXPECT_EQ(piece.points, is_wanted ? expected.points : std::vector<Point>());
            EXPECT_EQ(piece.unwanted, is_wanted ? 0 : expected.points.size());
            if (is_wanted) {
              EXPECT_EQ(piece.index_in_file(0), expected.index_in_file(0));
            }
          },
          {[&] { return asked++ % each == 0; }, whole.left_out.empty()});
      EXPECT_EQ(given, all.size());
      EXPECT_EQ(describe(rest.left_out), describe(whole.left_out));
    }
  }
}

TEST_F(CloudPieces, ThatAreNotWantedHaveNoPoints) {
  expect_same_pieces_chosen(folder_.write("a.ply", kTextPly), true);
  expect_same_pieces_chosen(folder_.write("a.xyz", "1 2 3\n4 5 6\n7 8 9\n1 2 4\n1 2 5\n"));
  expect_same_pieces_chosen(folder_.write("a.obj", "v 1 2 3\nv nan 5 6\nv 7 8 9\n"), true);
  expect_same_pieces_chosen(folder_.write(
      "a.las", las_bytes({{0, 0, 0, 2}, {1, 0, 0, 0x80 | 2}, {2, 0, 0, 2}, {3, 1, 0, 2}})));
  expect_same_pieces_chosen(
      folder_.write("b.las", las_bytes({{0, 0, 0, 2}, {1, 0, 0, 2}, {2, 0, 0, 2}, {3, 1, 0, 2}})));
  for (const auto& entry : std::filesystem::directory_iterator(EMAX_TEST_DATA)) {
    const std::string ending = entry.path().extension().string();
    if (std::ranges::find(cloud_endings(), ending) == cloud_endings().end()) continue;
    expect_same_pieces_chosen(entry.path());
  }
  expect_same_pieces_chosen(folder_.path(), true);
}

// What is not read may be damaged.
TEST_F(CloudPieces, ThatAreNotWantedAreNotRead) {
  std::string pcd =
      "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 4\nHEIGHT 1\n"
      "POINTS 4\nDATA binary\n";
  std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  for (const float x : {0.0f, 1.0f, std::numeric_limits<float>::quiet_NaN(), 3.0f}) {
    for (std::string* bytes : {&pcd, &ply}) {
      for (const float value : {x, 0.0f, 0.0f}) append(*bytes, value);
    }
  }
  for (const auto& path : {folder_.write("a.pcd", pcd), folder_.write("a.ply", ply)}) {
    SCOPED_TRACE(path.string());
    const auto choose = [&](bool is_complete) {
      std::size_t asked = 0;
      std::vector<double> found;
      read_cloud_in_pieces(path, {}, 1,
                           [&](const PointCloud& piece) {
                             for (const Point& point : piece.points) found.push_back(point[0]);
                           },
                           {[&] { return asked++ != 2; }, is_complete});
      return found;
    };
    EXPECT_EQ(choose(true), (std::vector<double>{0, 1, 3}));
    EXPECT_NE(message_of([&] { choose(false); }), "");
  }
}

TEST_F(CloudPieces, OfAFolderAreTheWhole) {
  folder_.write("1.ply", kTextPly);
  folder_.write("2.xyz", "1 2 3\n4 5 6\n");
  folder_.write("3.ptx",
                "1\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n5 0 0 1\n"
                "0 0 0 0.5\n4 5 6 0.5\n");
  expect_same_in_pieces(folder_.path(), true);
}

TEST_F(CloudPieces, AreRefusedAsTheWhole) {
  const auto file = folder_.write("a.ply", kTextPly);
  const auto ignore = [](const PointCloud&) {};
  const auto in_pieces = [&](const std::filesystem::path& path) {
    return message_of([&] { read_cloud_in_pieces(path, {}, 2, ignore); });
  };
  EXPECT_EQ(in_pieces(file), message_of([&] { read_cloud(file); }));
  const auto empty = folder_.write("b.xyz", "1 2 nan\n");
  EXPECT_EQ(message_of([&] { read_cloud_in_pieces(empty, {true}, 2, ignore); }),
            message_of([&] { read_cloud(empty, {true}); }));
}

// Lines and values on both sides of the ends of the windows in which a file is read.
TEST_F(CloudPieces, FilesLongerThanAWindow) {
  std::vector<Point> expected;
  std::string text = '#' + std::string(700000, ' ') + '\n';
  std::string binary =
      "ply\nformat binary_little_endian 1.0\ncomment x\nelement vertex 40000\n"
      "property uchar mark\nproperty double x\nproperty double y\nproperty double z\n"
      "end_header\n";
  for (int i = 0; i < 40000; ++i) {
    expected.emplace_back(i, i / 7.0, -3e-7 * i);
    text += fmt::format("{} {} {}\n", expected.back()[0], expected.back()[1], expected.back()[2]);
    append(binary, std::uint8_t{7});
    for (int k = 0; k < 3; ++k) append(binary, expected.back()[k]);
  }
  EXPECT_EQ(read_cloud(folder_.write("a.xyz", text)).points, expected);
  EXPECT_EQ(read_cloud(folder_.write("a.ply", binary)).points, expected);
  EXPECT_EQ(joined_pieces(folder_ / "a.xyz", {}, 777).points, expected);
  EXPECT_EQ(joined_pieces(folder_ / "a.ply", {}, 777).points, expected);
}

}  // namespace
}  // namespace emax::test
