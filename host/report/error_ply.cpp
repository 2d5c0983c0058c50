#include "host/report/error_ply.h"

#include <fmt/format.h>

#include <string>

#include "host/files/append_value.h"
#include "host/files/atomic_file.h"
#include "host/picture/colour.h"

namespace emax {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 20;  // bytes written at once

}  // namespace

void write_error_ply(const std::filesystem::path& path, std::span<const Point> points,
                     std::span<const double> distances, double greatest,
                     std::span<const Triangle> triangles) {
  write_atomically(path, [&](AtomicFile& file) {
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n"
        "property double y\nproperty double z\nproperty double distance\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n",
        points.size());
    if (!triangles.empty()) {
      bytes += fmt::format("element face {}\nproperty list uchar int vertex_indices\n",
                           triangles.size());
    }
    bytes += "end_header\n";
    const auto flush = [&](std::size_t above) {
      if (bytes.size() <= above) return;
      file.write(bytes);
      bytes.clear();
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (int k = 0; k < 3; ++k) append_value(bytes, points[i][k]);
      append_value(bytes, distances[i]);
      for (const std::uint8_t channel : viridis(greatest > 0 ? distances[i] / greatest : 0)) {
        append_value(bytes, channel);
      }
      flush(kBuffer);
    }
    for (const Triangle& triangle : triangles) {
      append_value(bytes, std::uint8_t{3});
      for (const std::uint32_t corner : triangle) append_value(bytes, corner);
      flush(kBuffer);
    }
    flush(0);
  });
}

}  // namespace emax
