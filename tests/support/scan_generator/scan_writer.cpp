#include "tests/support/scan_generator/scan_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/scan_bytes.h"
#include "tests/support/scan_generator/steps.h"

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

// What the header of LAS tells of the points.
struct LasSummary {
  std::uint32_t count = 0;
  Steps least = {}, greatest = {};

  void add(const Steps& point) {
    if (count++ == 0) least = greatest = point;
    for (std::size_t k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], point[k]);
      greatest[k] = std::max(greatest[k], point[k]);
    }
  }
};

std::string las_header(const LasSummary& summary) {
  std::string header = las_bytes({});
  put(header, 107, summary.count);
  for (std::size_t k = 0; k < 3; ++k) {
    put(header, 131 + 8 * k, kStep);
    put(header, 155 + 8 * k, 0.0);
    put(header, 179 + 16 * k, summary.greatest[k] * kStep);
    put(header, 187 + 16 * k, summary.least[k] * kStep);
  }
  return header;
}

LasSummary write_las_points(std::ostream& to, const PointSource& points) {
  constexpr std::size_t kPoint = 20;
  LasSummary summary;
  std::string bytes;
  points([&](std::span<const Point> some) {
    bytes.assign(kPoint * some.size(), '\0');
    for (std::size_t i = 0; i < some.size(); ++i) {
      const Steps steps = in_steps(some[i]);
      summary.add(steps);
      put(bytes, kPoint * i, steps);
    }
    to << bytes;
  });
  return summary;
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

void write_las_scan(std::ostream& to, const PointSource& points) {
  LasSummary summary;
  points([&](std::span<const Point> some) {
    for (const Point& p : some) summary.add(in_steps(p));
  });
  to << las_header(summary);
  write_las_points(to, points);
  check(to.flush(), "the stream");
}

void write_las_scan(const std::filesystem::path& file, const PointSource& points) {
  std::ofstream to(file, std::ios::binary);
  to << las_header({});
  const LasSummary summary = write_las_points(to, points);
  to.seekp(0);
  to << las_header(summary);
  check(to.flush(), file.string());
}

}  // namespace emax::test
