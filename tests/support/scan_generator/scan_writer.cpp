#include "tests/support/scan_generator/scan_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/scan_bytes.h"

namespace emax::test {
namespace {

// Of the same length for every count.
std::string ply_header(std::uint64_t count) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {:020}\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n",
      count);
}

void write_ply_points(std::ostream& to, const PointSource& points) {
  std::vector<float> values;
  points([&](std::span<const Point> some) {
    values.clear();
    for (const Point& p : some) {
      for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(p[k]));
    }
    to.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(float)));
  });
}

void check(const std::ostream& to, const std::string& name) {
  if (!to) throw std::runtime_error(name + " cannot be written");
}

}  // namespace

void write_ply_scan(std::ostream& to, std::uint64_t count, const PointSource& points) {
  to << ply_header(count);
  write_ply_points(to, points);
  check(to.flush(), "the stream");
}

void write_ply_scan(const std::filesystem::path& file, const PointSource& points) {
  std::ofstream to(file, std::ios::binary);
  std::uint64_t count = 0;
  to << ply_header(count);
  write_ply_points(to, [&](const auto& take) {
    points([&](std::span<const Point> some) {
      count += some.size();
      take(some);
    });
  });
  to.seekp(0);
  to << ply_header(count);
  check(to.flush(), file.string());
}

void write_las_scan(const std::filesystem::path& file, const PointSource& points) {
  constexpr double kScale = 1e-4;
  constexpr std::size_t kPoint = 20;
  std::string header = las_bytes({});
  for (std::size_t k = 0; k < 3; ++k) {
    put(header, 131 + 8 * k, kScale);
    put(header, 155 + 8 * k, 0.0);
  }
  std::ofstream to(file, std::ios::binary);
  to << header;
  std::uint64_t count = 0;
  Point least = Point::Constant(std::numeric_limits<double>::infinity()), greatest = -least;
  std::string bytes;
  points([&](std::span<const Point> some) {
    bytes.assign(kPoint * some.size(), '\0');
    for (std::size_t i = 0; i < some.size(); ++i) {
      Point stored;
      for (int k = 0; k < 3; ++k) {
        const auto whole = static_cast<std::int32_t>(std::lround(some[i][k] / kScale));
        put(bytes, kPoint * i + 4 * static_cast<std::size_t>(k), whole);
        stored[k] = whole * kScale;
      }
      least = least.cwiseMin(stored);
      greatest = greatest.cwiseMax(stored);
    }
    to << bytes;
    count += some.size();
  });
  put(header, 107, static_cast<std::uint32_t>(count));
  for (std::size_t k = 0; k < 3; ++k) {
    put(header, 179 + 16 * k, greatest[static_cast<Eigen::Index>(k)]);
    put(header, 187 + 16 * k, least[static_cast<Eigen::Index>(k)]);
  }
  to.seekp(0);
  to << header;
  check(to.flush(), file.string());
}

}  // namespace emax::test
