// The reader of PCD beside the Point Cloud Library's own, on files of every writer of that library.

#include <fmt/format.h>
#include <gtest/gtest.h>

#ifdef __clang__
// Newer versions of clang, which clang-tidy is, refuse the enumerations of Boost 1.74 that its
// numeric_cast is made of. PCL's headers need it for whole numbers that always fit.
#define BOOST_NUMERIC_CONVERSION_CAST_25OCT2001_HPP
namespace boost {
template <class To, class From>
To numeric_cast(From value) {
  return static_cast<To>(value);
}
}  // namespace boost
#endif

#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <cmath>
#include <fstream>
#include <type_traits>

#include "host/files/cloud_file.h"
#include "tests/support/messages.h"
#include "tests/support/stimuli.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

constexpr std::uint64_t kSeed = 11;

struct Written {
  std::string name;
  std::filesystem::path path;
};

// `width` x `height` points. NaN marks the pixels of a depth camera that saw nothing.
template <class PointType>
pcl::PointCloud<PointType> some_cloud(std::uint32_t width, std::uint32_t height, bool with_holes) {
  Random random(kSeed);
  pcl::PointCloud<PointType> cloud(width, height);
  for (PointType& p : cloud) {
    const Point at = random.point(-100, 100);
    p.x = static_cast<float>(at.x());
    p.y = static_cast<float>(at.y());
    p.z = static_cast<float>(at.z());
    if constexpr (requires { p.normal_x; }) {
      const Point normal = random.point(-1, 1);
      p.normal_x = static_cast<float>(normal.x());
      p.normal_y = static_cast<float>(normal.y());
      p.normal_z = static_cast<float>(normal.z());
    }
    if constexpr (requires { p.intensity; }) p.intensity = p.x * 3;
    if constexpr (requires { p.label; }) p.label = random.below(1u << 30);
    if constexpr (requires { p.rgba; }) p.rgba = random.below(1u << 30);
  }
  if (with_holes) {
    cloud.is_dense = false;
    for (std::size_t i = 0; i < cloud.size(); i += 5) {
      cloud[i].x = cloud[i].y = cloud[i].z = std::nanf("");
    }
  }
  return cloud;
}

template <class PointType>
std::vector<Written> write_all(const pcl::PointCloud<PointType>& cloud,
                               const TemporaryFolder& folder) {
  pcl::PCDWriter writer;
  pcl::PCLPointCloud2 blob;  // with the padding of the type in memory as fields of its own
  pcl::toPCLPointCloud2(cloud, blob);
  const auto origin = Eigen::Vector4f::Zero();
  const auto turn = Eigen::Quaternionf::Identity();
  std::vector<Written> files;
  const auto add = [&](const std::string& name, auto&& write) {
    files.push_back({name, folder / (name + ".pcd")});
    EXPECT_EQ(write(files.back().path.string()), 0) << name;
  };
  using Path = const std::string&;
  add("ascii", [&](Path path) { return writer.writeASCII(path, cloud, 9); });
  add("binary", [&](Path path) { return writer.writeBinary(path, cloud); });
  add("compressed", [&](Path path) { return writer.writeBinaryCompressed(path, cloud); });
  add("blob_ascii", [&](Path path) { return writer.writeASCII(path, blob, origin, turn, 9); });
  add("blob_binary", [&](Path path) { return writer.writeBinary(path, blob, origin, turn); });
  add("blob_compressed",
      [&](Path path) { return writer.writeBinaryCompressed(path, blob, origin, turn); });
  add("stream_compressed", [&](Path path) {
    std::ofstream stream(path, std::ios::binary);
    return writer.writeBinaryCompressed(stream, blob, origin, turn);
  });
  return files;
}

// What `read_cloud` must make of a file of this cloud: its finite points.
template <class PointType>
PointCloud finite_part(const pcl::PointCloud<PointType>& cloud) {
  PointCloud expected;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const PointType& p = cloud[i];
    const Point at(p.x, p.y, p.z);
    if (!at.allFinite()) continue;
    expected.points.push_back(at);
    expected.file_index.push_back(static_cast<std::uint32_t>(i));
    if constexpr (requires { p.normal_x; }) {
      expected.normals.emplace_back(p.normal_x, p.normal_y, p.normal_z);
    }
  }
  return expected;
}

template <class PointType>
PointCloud read_by_pcl(const Written& file) {
  pcl::PointCloud<PointType> cloud;
  EXPECT_EQ(pcl::PCDReader().read(file.path.string(), cloud), 0);
  return finite_part(cloud);
}

// Where the fields of a type do not stand in the order of its memory, the library's writer steps
// back by padding of a negative size, at which its reader goes astray.
bool library_can_read(const std::string& bytes) {
  const std::size_t count = bytes.find("\nCOUNT ");
  return bytes.substr(count, bytes.find('\n', count + 1) - count).find('-') == std::string::npos;
}

// Text holds decimals of 32-bit values, which we keep in 64 bit.
std::vector<Point> in_32_bit(std::vector<Point> points) {
  for (Point& p : points) p = p.cast<float>().cast<double>();
  return points;
}

template <class PointType>
void expect_the_same_of_all_writers(const std::string& type) {
  for (const auto& [width, height, with_holes] :
       {std::tuple{1u, 1u, false}, {1000u, 1u, false}, {40u, 30u, false}, {40u, 30u, true}}) {
    const TemporaryFolder folder;
    const auto cloud = some_cloud<PointType>(width, height, with_holes);
    for (const Written& file : write_all(cloud, folder)) {
      SCOPED_TRACE(fmt::format("{}, {} x {}, {}, seed {}", type, width, height, file.name, kSeed));
      const std::string written = bytes_of(file.path);
      const PointCloud expected = finite_part(cloud);
      ASSERT_EQ(expected.points.size(), with_holes ? cloud.size() * 4 / 5 : cloud.size());
      if (library_can_read(written)) {
        const PointCloud by_pcl = read_by_pcl<PointType>(file);
        EXPECT_EQ(by_pcl.points, expected.points);
        EXPECT_EQ(by_pcl.normals, expected.normals);
      }
      for (const std::string& padding :
           {std::string(), std::string("\n\n"), std::string(4096, '\0'), std::string("\xff\n")}) {
        std::ofstream(file.path, std::ios::binary) << written << padding;
        const PointCloud read = read_cloud(file.path, {.skip_invalid = true});
        EXPECT_EQ(in_32_bit(read.points), expected.points);
        EXPECT_EQ(in_32_bit(read.normals), expected.normals);
        if (with_holes) {
          EXPECT_EQ(read.file_index, expected.file_index);
        }
      }
    }
  }
}

TEST(PcdBesidePcl, EveryWriterAndTypeWithPaddingBehindTheData) {
  expect_the_same_of_all_writers<pcl::PointXYZ>("PointXYZ");
  expect_the_same_of_all_writers<pcl::PointXYZI>("PointXYZI");
  expect_the_same_of_all_writers<pcl::PointXYZL>("PointXYZL");
  expect_the_same_of_all_writers<pcl::PointXYZRGB>("PointXYZRGB");
  expect_the_same_of_all_writers<pcl::PointXYZRGBA>("PointXYZRGBA");
  expect_the_same_of_all_writers<pcl::InterestPoint>("InterestPoint");
  expect_the_same_of_all_writers<pcl::PointNormal>("PointNormal");
  expect_the_same_of_all_writers<pcl::PointXYZRGBNormal>("PointXYZRGBNormal");
  expect_the_same_of_all_writers<pcl::PointXYZINormal>("PointXYZINormal");
  expect_the_same_of_all_writers<pcl::PointWithRange>("PointWithRange");
  expect_the_same_of_all_writers<pcl::PointWithScale>("PointWithScale");
}

// The padding must not hide damage.
TEST(PcdBesidePcl, ShortenedDataAreRefusedWhateverTheWriter) {
  const TemporaryFolder folder;
  for (const Written& file : write_all(some_cloud<pcl::PointXYZ>(100, 1, false), folder)) {
    SCOPED_TRACE(file.name);
    const std::string written = bytes_of(file.path);
    const std::size_t data = written.find('\n', written.find("DATA")) + 1;
    std::ofstream(file.path, std::ios::binary) << written.substr(0, data + 1000);
    expect_clear(message_of([&] { read_cloud(file.path); }), file.path.string(), "", "");
  }
}

}  // namespace
}  // namespace emax::test
