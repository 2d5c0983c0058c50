#include "host/files/cloud_file.h"

#include <liblzf/lzf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "file_bytes.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Four points far from the origin with detail that 32 bit would lose.
const std::vector<Point> kFarPoints{{10000000.001, -20000000.002, 30000000.003},
                                    {10000000.125, -20000000.5, 30000000.75},
                                    {1.0 / 3, -2e-300, 4e300},
                                    {-0.0, 5, 6}};

class CloudFile : public testing::Test {
 protected:
  PointCloud read(std::string_view name, std::string_view bytes, bool skip_invalid = false) {
    return read_cloud(folder_.write(name, bytes), {skip_invalid});
  }
  TemporaryFolder folder_;
};

TEST_F(CloudFile, PlyTextIsReadTo64BitWhateverTheDeclaredType) {
  const PointCloud cloud = read("a.ply",
                                "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\n"
                                "element vertex 3\r\nproperty float x\r\nproperty float y\r\n"
                                "property float z\r\nproperty uchar red\r\nend_header\r\n"
                                "10000000.001 +2e0 3 255\r\n\r\n0.1 -0 1e-310 0\n4 5 6 7");
  const std::vector<Point> expected{{10000000.001, 2, 3}, {0.1, -0.0, 1e-310}, {4, 5, 6}};
  EXPECT_EQ(cloud.points, expected);
  EXPECT_TRUE(std::signbit(cloud.points[1][1]));
  EXPECT_TRUE(cloud.normals.empty());
  EXPECT_TRUE(cloud.file_index.empty());
}

TEST_F(CloudFile, PlyBinaryBothOrdersWithOtherElementsPropertiesAndLists) {
  for (const bool big_endian : {false, true}) {
    SCOPED_TRACE(big_endian);
    std::string bytes =
        std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
        "_endian 1.0\nobj_info x\nelement camera 1\nproperty list uint8 int16 rows\n"
        "property char one\nelement vertex 4\nproperty double z\nproperty short mark\n"
        "property list ushort float weights\nproperty double x\nproperty double y\n"
        "property float nx\nproperty float ny\nproperty float nz\n"
        "element face 1\nproperty uchar flag\nproperty list uchar uint vertex_index\nend_header\n";
    const auto add = [&](auto value) { append(bytes, value, big_endian); };
    add(std::uint8_t{2});
    add(std::int16_t{-7});
    add(std::int16_t{8});
    add(std::int8_t{-1});
    for (std::size_t i = 0; i < kFarPoints.size(); ++i) {
      const Point& p = kFarPoints[i];
      add(p[2]);
      add(std::int16_t{-300});
      add(static_cast<std::uint16_t>(i));
      for (std::size_t k = 0; k < i; ++k) add(1.5f);
      add(p[0]);
      add(p[1]);
      add(0.0f);
      add(0.6f);
      add(-0.8f);
    }
    add(std::uint8_t{9});
    add(std::uint8_t{4});
    for (std::uint32_t corner = 0; corner < 4; ++corner) add(corner);
    const PointCloud cloud = read("b.ply", bytes);
    EXPECT_EQ(cloud.points, kFarPoints);
    EXPECT_EQ(cloud.normals, std::vector<Point>(4, Point(0, 0.6f, -0.8f)));
  }
}

TEST_F(CloudFile, PlyCoordinatesOfEveryType) {
  const auto with_type = [&](const std::string& type, auto value) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty " + type +
                        " x\nproperty " + type + " y\nproperty " + type + " z\nend_header\n";
    for (int k = 0; k < 3; ++k) append(bytes, value);
    EXPECT_EQ(read("c.ply", bytes).points, std::vector<Point>{Point::Constant(double(value))})
        << type;
  };
  with_type("char", std::int8_t{-100});
  with_type("uint8", std::uint8_t{200});
  with_type("short", std::int16_t{-30000});
  with_type("uint16", std::uint16_t{60000});
  with_type("int", std::int32_t{-2000000001});
  with_type("uint32", std::uint32_t{4000000001});
  with_type("float32", 0.1f);
  with_type("double", 0.1);
}

std::string pcd_header(std::string_view sizes, std::string_view types, std::size_t points,
                       std::string_view data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z _ rgb normal_x normal_y normal_z\nSIZE " +
         std::string(sizes) + "\nTYPE " + std::string(types) + "\nCOUNT 1 1 1 2 1 1 1 1\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         std::to_string(points) + "\nDATA " + std::string(data) + "\n";
}

TEST_F(CloudFile, PcdTextAndBinary) {
  const PointCloud text =
      read("a.pcd", pcd_header("8 8 8 1 4 4 4 4", "F F F U U F F F", 2, "ascii") +
                        "10000000.001 2 3 0 0 255 1 0 0\n4 5 6 0 0 7 0 1 0\n");
  EXPECT_EQ(text.points, (std::vector<Point>{{10000000.001, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(text.normals, (std::vector<Point>{{1, 0, 0}, {0, 1, 0}}));

  // x as double, y as 64-bit integer, z as unsigned 16 bit.
  std::string bytes = pcd_header("8 8 2 1 4 4 4 4", "F I U U U F F F", 2, "binary");
  for (const double x : {10000000.001, -0.1}) {
    append(bytes, x);
    append(bytes, std::int64_t{-9007199254740991});
    append(bytes, std::uint16_t{65535});
    append(bytes, std::uint16_t{0});
    append(bytes, std::uint32_t{1});
    for (const float n : {0.0f, 0.0f, 1.0f}) append(bytes, n);
  }
  const PointCloud binary = read("b.pcd", bytes);
  EXPECT_EQ(binary.points, (std::vector<Point>{{10000000.001, -9007199254740991.0, 65535},
                                               {-0.1, -9007199254740991.0, 65535}}));
  EXPECT_EQ(binary.normals, std::vector<Point>(2, Point(0, 0, 1)));
}

TEST_F(CloudFile, PcdWithAFieldOfTruthValues) {
  const std::string header =
      "FIELDS seen x y z\nSIZE 1 4 4 4\nTYPE B F F F\nCOUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\nDATA ";
  EXPECT_EQ(read("a.pcd", header + "ascii\n1 1 2 3\n").points, std::vector<Point>{Point(1, 2, 3)});
  std::string binary = header + "binary\n\1";
  for (const float value : {1.0f, 2.0f, 3.0f}) append(binary, value);
  EXPECT_EQ(read("b.pcd", binary).points, std::vector<Point>{Point(1, 2, 3)});
}

std::string compressed_pcd(std::size_t points) {
  std::string data;  // all of x, all of y, ...
  for (int k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < points; ++i) append(data, 0.25 * double(i % 7) + 1e7 * k);
  }
  std::string packed(data.size() + 1000, '\0');
  const unsigned size = lzf_compress(data.data(), static_cast<unsigned>(data.size()), packed.data(),
                                     static_cast<unsigned>(packed.size()));
  packed.resize(size);
  std::string bytes = "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
                      std::to_string(points / 2) + "\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
                      std::to_string(points) + "\nDATA binary_compressed\n";
  append(bytes, size);
  append(bytes, static_cast<unsigned>(data.size()));
  return bytes + packed;
}

TEST_F(CloudFile, PcdCompressed) {
  const PointCloud cloud = read("c.pcd", compressed_pcd(1000));
  ASSERT_EQ(cloud.points.size(), 1000u);
  for (std::size_t i = 0; i < 1000; ++i) {
    const double x = 0.25 * double(i % 7);
    EXPECT_EQ(cloud.points[i], Point(x, x + 1e7, x + 2e7));
  }
}

// 50 points (i/10, 3/10 (i mod 7), 1/(i+1)) with the normal (0, 0.6, 0.8) and a curvature, all in
// 32 bit, as PCL's own writer compressed them.
TEST_F(CloudFile, PcdCompressedByPcl) {
  const PointCloud cloud = read_cloud(EMAX_TEST_DATA "/written_by_pcl_1.13.pcd");
  ASSERT_EQ(cloud.points.size(), 50u);
  for (int i = 0; i < 50; ++i) {
    const Point expected(0.1f * static_cast<float>(i), 0.3f * static_cast<float>(i % 7),
                         1.0f / static_cast<float>(i + 1));
    EXPECT_EQ(cloud.points[static_cast<std::size_t>(i)], expected) << i;
  }
  EXPECT_EQ(cloud.normals, std::vector<Point>(50, Point(0, 0.6f, 0.8f)));
}

TEST_F(CloudFile, PcdIgnoresWhatFollowsTheData) {
  const std::vector<Point> expected{{1, 2, 3}, {4, 5, 6}};
  const std::string header =
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ";
  const std::string text = header + "ascii\n1 2 3\n4 5 6\n";
  std::string binary = header + "binary\n";
  for (const float value : {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f}) append(binary, value);
  const std::vector<Point> packed = read("c.pcd", compressed_pcd(1000)).points;
  for (const std::string& tail :
       {std::string(1, 'x'), std::string(24, '\0'), std::string(4096, '\0'), std::string("7 8")}) {
    EXPECT_EQ(read("a.pcd", text + tail).points, expected);
    EXPECT_EQ(read("b.pcd", binary + tail).points, expected);
    EXPECT_EQ(read("c.pcd", compressed_pcd(1000) + tail).points, packed);
  }
}

TEST_F(CloudFile, PcdCompressedDamageIsSeen) {
  const std::string good = compressed_pcd(1000);
  const auto message = [&](std::string_view bytes) {
    return message_of([&] { read("d.pcd", bytes); });
  };
  const std::string name = (folder_ / "d.pcd").string();
  expect_clear(message(good.substr(0, good.size() - 1)), name, "promised", "export");
  std::string damaged = good;
  damaged[good.find("_compressed\n") + 12 + 8] = '\x7f';  // a long literal run, past the end
  for (std::size_t i = good.size() - 3; i < good.size(); ++i) damaged[i] = '\x01';
  expect_clear(message(damaged), name, "damaged", "export");
}

TEST_F(CloudFile, XyzSeparatorsCommentsAndColumns) {
  const std::vector<Point> expected{{10000000.001, -2, 3}, {4, 5, 6.5}};
  EXPECT_EQ(read("a.xyz", "# points\n10000000.001 -2 3\n\n  4\t5 6.5 # last\n").points, expected);
  EXPECT_EQ(read("a.asc", "// points\r\n10000000.001,-2, 3\r\n4,5,6.5 // last").points, expected);
  EXPECT_EQ(read("a.ASC", "10000000.001;-2;3;17\n4;5;6.5;18\n").points, expected);
  EXPECT_TRUE(read("a.xyz", "1 2 3 17\n4 5 6 18\n").normals.empty());

  const PointCloud normals = read("n.xyz", "1 2 3 0 0 1\n4 5 6 0.6 -0.8 0\n");
  EXPECT_EQ(normals.normals, (std::vector<Point>{{0, 0, 1}, {0.6, -0.8, 0}}));
  const PointCloud with_value = read("n.xyz", "1 2 3 0 0 1 99\n4 5 6 0.6 -0.8 0 98\n");
  EXPECT_EQ(with_value.normals, normals.normals);
  EXPECT_TRUE(read("c.xyz", "1 2 3 0 0 1\n4 5 6 255 128 0\n").normals.empty()) << "colours";
}

// Every row begins with the point; the normal is found where it stands.
TEST_F(CloudFile, XyzColumnsInAllCommonOrders) {
  struct Order {
    std::string name;
    std::string behind_first, behind_second;  // of the coordinates
    bool has_normal;
  };
  const std::vector<Order> orders{
      {"intensity", "-1200", "17.5", false},
      {"two values", "1 2", "3 4", false},
      {"colour", "255 0 0", "0 128 255", false},
      {"normal", "0 0 1", "0.6 -0.8 0", true},
      {"intensity, colour", "0.5 255 0 0", "0.25 0 128 255", false},
      {"intensity, normal", "0.5 0 0 1", "0.25 0.6 -0.8 0", true},
      {"normal, curvature", "0 0 1 0.01", "0.6 -0.8 0 0.02", true},
      {"colour with alpha, intensity", "255 0 0 255 7", "0 128 255 255 8", false},
      {"colour, normal", "255 0 0 0 0 1", "0 128 255 0.6 -0.8 0", true},
      {"normal, colour", "0 0 1 255 0 0", "0.6 -0.8 0 0 128 255", true},
      {"intensity, colour, normal", "9 255 0 0 0 0 1", "8 0 128 255 0.6 -0.8 0", true},
      {"many", "1 2 3 4 5 6 7 8 9 10 11 12", "1 2 3 4 5 6 7 8 9 10 11 13", false}};
  const std::vector<Point> points{{1.5, 2, 3}, {4, 5, 6.5}};
  const std::vector<Point> normals{{0, 0, 1}, {0.6, -0.8, 0}};
  for (const Order& order : orders) {
    for (const char separator : {' ', '\t', ',', ';'}) {
      SCOPED_TRACE(order.name + " separated by '" + separator + "'");
      std::string text = "1.5 2 3 " + order.behind_first + "\n4 5 6.5 " + order.behind_second;
      std::ranges::replace(text, ' ', separator);
      for (const std::string name : {"a.xyz", "a.asc", "a.txt"}) {
        const PointCloud cloud = read(name, text);
        EXPECT_EQ(cloud.points, points);
        EXPECT_EQ(cloud.normals, order.has_normal ? normals : std::vector<Point>());
      }
      EXPECT_EQ(read("a.pts", text).points, points);
      EXPECT_EQ(read("a.pts", "2\n" + text).points, points);
    }
  }
  EXPECT_EQ(read("b.pts", "1.5 2 3 9 255 0 0 0 0 1\n4 5 6.5 8 0 0 9 0.6 -0.8 0\n").normals,
            normals);
  EXPECT_TRUE(read("c.xyz", "1 2 3 255 0 0 0 0 1\n4 5 6 0 0 0 0 0 0.5\n").normals.empty());
}

TEST_F(CloudFile, PtsWithAndWithoutCount) {
  const std::vector<Point> expected{{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(read("a.pts", "2\n1 2 3 -1200 255 0 0\n4 5 6 -1100 0 255 0\n").points, expected);
  EXPECT_EQ(read("a.pts", "2\n1 2 3\n4 5 6\n").points, expected);
  EXPECT_EQ(read("a.pts", "1 2 3 7\n4 5 6 8\n").points, expected);
  EXPECT_TRUE(read("a.pts", "2\n1 2 3 0 0 1\n4 5 6 1 0 0\n").normals.empty()) << "dark colours";
}

TEST_F(CloudFile, ObjVerticesAndNormals) {
  const std::vector<Point> expected{{10000000.001, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  const PointCloud cloud =
      read("a.obj",
           "# cloud\nmtllib a.mtl\no thing\nv 10000000.001 2 3\nvn 0 0 1\nv 4 5 6 1.0\nvn 0 1 0\n"
           "v 7 8 9 0.5 0.5 0.5\nvn 1 0 0\nvt 0 0\ns off\nf 1//1 2//2 3//3\n");
  EXPECT_EQ(cloud.points, expected);
  EXPECT_EQ(cloud.normals, (std::vector<Point>{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}}));
  // As many normals as vertices, but not each vertex its own.
  EXPECT_TRUE(
      read("b.obj", "v 1 2 3\nv 4 5 6\nv 7 8 8\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\nf 1//2 2//1 3//3\n")
          .normals.empty());
  EXPECT_TRUE(read("c.obj", "v 1 2 3\nv 4 5 6\nvn 0 0 1\n").normals.empty());
}

TEST_F(CloudFile, OffVariants) {
  const std::vector<Point> expected{{10000000.001, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(read("a.off", "# made\nOFF # keyword\n2 0 0\n\n10000000.001 2 3\n4 5 6\n").points,
            expected);
  EXPECT_EQ(read("a.off", "OFF 2 0 0\n10000000.001 2 3\n4 5 6").points, expected);
  EXPECT_EQ(read("a.off", "COFF\n2 0 0\n10000000.001 2 3 255 0 0 255\n4 5 6 0 0 0 255\n").points,
            expected);
  const PointCloud normals = read("a.off", "NOFF\n2 0 0\n10000000.001 2 3 0 0 1\n4 5 6 0 1 0\n");
  EXPECT_EQ(normals.points, expected);
  EXPECT_EQ(normals.normals, (std::vector<Point>{{0, 0, 1}, {0, 1, 0}}));
  EXPECT_EQ(read("a.off", "CNOFF\n1 0 0\n1 2 3 0 0 1 0.5 0.5 0.5\n").normals,
            std::vector<Point>{Point(0, 0, 1)});
}

TEST_F(CloudFile, InvalidPointsAreRefusedOrSkippedWithTheirIndices) {
  struct Case {
    std::string name, bytes, place;
  };
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty double x\n"
      "property double y\nproperty double z\nend_header\n";
  for (const double value :
       {1.0, 2.0, 3.0, 4.0, kInfinite, 6.0, 7.0, 8.0, std::nan(""), 0.5, 0.25, 0.125}) {
    append(binary, value);
  }
  const std::vector<Case> cases{
      {"a.ply", binary, "vertex 1"},
      {"a.xyz", "1 2 3\n4 inf 6\n7 8 nan\n0.5 .25 0.125\n", "line 2"},
      {"a.pts", "4\n1 2 3 9\n4 -inf 6 9\n7 8 NaN 9\n0.5 .25 0.125 9\n", "line 3"},
      {"a.obj", "v 1 2 3\nv 4 Infinity 6\n\nv 7 8 nan\nv .5 .25 .125\n", "line 2"},
      {"a.off", "OFF\n4 0 0\n1 2 3\n4 nan 6\n7 8 nan\n.5 .25 .125\n", "line 4"},
      {"a.pcd",
       "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 4\nHEIGHT 1\nPOINTS 4\nDATA ascii\n1 2 3\n"
       "nan nan nan\nnan nan nan\n.5 .25 .125\n",
       "line 9"}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const std::string message = message_of([&] { read(c.name, c.bytes); });
    expect_clear(message, (folder_ / c.name).string(),
                 c.place + ": a coordinate is NaN or infinite", "--skip-invalid");
    const PointCloud cloud = read(c.name, c.bytes, true);
    EXPECT_EQ(cloud.points, (std::vector<Point>{{1, 2, 3}, {0.5, 0.25, 0.125}}));
    EXPECT_EQ(cloud.file_index, (std::vector<std::uint32_t>{0, 3}));
    EXPECT_EQ(cloud.index_in_file(1), 3u);
  }
  expect_clear(message_of([&] { read("n.xyz", "nan 1 1\n1 nan 1\n", true); }),
               (folder_ / "n.xyz").string(), "every point", "export");
}

TEST_F(CloudFile, NormalsStayWithTheirPointsWhenSomeAreSkippedAndGoWhenUnusable) {
  const PointCloud cloud = read("a.xyz", "1 2 3 0 0 1\nnan 5 6 nan nan nan\n7 8 9 0 1 0\n", true);
  EXPECT_EQ(cloud.normals, (std::vector<Point>{{0, 0, 1}, {0, 1, 0}}));
  EXPECT_EQ(cloud.file_index, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_TRUE(read("a.off", "NOFF\n2 0 0\n1 2 3 0 0 1\n4 5 6 nan 0 0\n").normals.empty());
  EXPECT_TRUE(read("a.off", "NOFF\n2 0 0\n1 2 3 0 0 1\n4 5 6 0 0 0\n").normals.empty());
}

TEST(CheckCloud, RefusesWhatHasNoSurface) {
  const auto message = [](std::vector<Point> points) {
    return message_of([&] { check_cloud({std::move(points), {}, {}}, "scan.ply"); });
  };
  expect_clear(message({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), "scan.ply", "3 points", "at least 4");
  expect_clear(message(std::vector<Point>(9, Point(1, 2, 3))), "scan.ply", "equal", "export");
  expect_clear(message({{1e7, 2, 3}, {1e7 + 1, 3, 4}, {1e7 + 2, 4, 5}, {1e7 + 7, 9, 10}}),
               "scan.ply", "one line", "export");
  // A tilted line far away: rounding lifts its points out of it by up to 1e-9.
  std::vector<Point> tilted;
  for (int i = 0; i < 100; ++i) {
    tilted.emplace_back(1e7 + 0.1 * i, 2e7 + 0.1 * i, 3e7 + 0.03 * i);
  }
  expect_clear(message(tilted), "scan.ply", "one line", "export");
}

TEST(CheckCloud, AcceptsPlanes) {
  EXPECT_NO_THROW(check_cloud({{{0, 0, 5}, {1, 0, 5}, {0, 1, 5}, {7, 8, 5}}, {}, {}}, "a"));
  std::vector<Point> tilted;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      tilted.emplace_back(1e7 + 0.1 * i, 2e7 + 0.1 * j, 3e7 + 0.03 * i + 0.07 * j);
    }
  }
  EXPECT_NO_THROW(check_cloud({tilted, {}, {}}, "a"));
}

TEST(CheckCloud, AcceptsDuplicatesAndThinClouds) {
  const std::vector<Point> tetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<Point> doubled = tetrahedron;
  doubled.insert(doubled.end(), tetrahedron.begin(), tetrahedron.end());
  EXPECT_NO_THROW(check_cloud({doubled, {}, {}}, "a"));
  // 1e-6 of its extent thick, and a millimetre of relief at 1e7.
  EXPECT_NO_THROW(check_cloud({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-6}}, {}, {}}, "a"));
  EXPECT_NO_THROW(
      check_cloud({{{1e7, 0, 0}, {1e7 + 1, 0, 0}, {1e7, 1, 0}, {1e7, 0, 0.001}}, {}, {}}, "a"));
}

}  // namespace
}  // namespace emax::test
