// E57 (ASTM E2807): one scan, whose points are packets of three streams of 32-bit numbers.

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/scan_bytes.h"
#include "tests/support/scan_generator/scan_writer.h"
#include "tests/support/scan_generator/steps.h"

namespace emax::test {
namespace {

constexpr std::size_t kFileHeader = 48, kSectionHeader = 32, kPacketHeader = 12;
// A packet has at most 64 KiB.
constexpr std::size_t kPacketPoints = ((std::size_t{1} << 16) - kPacketHeader) / 12;

std::uint64_t with_checksums(std::uint64_t offset) {
  return offset / kE57Page * 1024 + offset % kE57Page;
}

// Writes content page by page. The first page is written last, because it holds the headers.
class Pages {
 public:
  explicit Pages(const std::filesystem::path& file) : to_(file, std::ios::binary) {}

  std::uint64_t size() const { return size_; }  // of the content

  void append(std::string_view bytes) {
    waiting_ += bytes;
    size_ += bytes.size();
    std::size_t at = 0;
    for (; waiting_.size() - at >= kE57Page; at += kE57Page) {
      const std::string content = waiting_.substr(at, kE57Page);
      if (first_.empty()) first_ = content;
      to_ << e57_page(content);
    }
    waiting_.erase(0, at);
  }

  // `fill` completes the content of the first page.
  template <class Fill>
  bool finish(const Fill& fill) {
    append(std::string((kE57Page - size_ % kE57Page) % kE57Page, '\0'));
    fill(first_);
    put(first_, 16, with_checksums(size_));
    to_.seekp(0);
    to_ << e57_page(first_);
    return !!to_.flush();
  }

 private:
  std::ofstream to_;
  std::string first_, waiting_;
  std::uint64_t size_ = 0;
};

std::string packet(std::span<const Steps> points) {
  std::string bytes(kPacketHeader + sizeof(Steps) * points.size(), '\0');
  bytes[0] = 1;  // data
  put(bytes, 2, static_cast<std::uint16_t>(bytes.size() - 1));
  put(bytes, 4, std::uint16_t{3});
  for (std::size_t k = 0; k < 3; ++k) {
    put(bytes, 6 + 2 * k, static_cast<std::uint16_t>(4 * points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      constexpr std::uint32_t kLeast = 0x80000000;  // numbers are stored from the least on
      const auto number = static_cast<std::uint32_t>(points[i][k]) + kLeast;
      put(bytes, kPacketHeader + 4 * (k * points.size() + i), number);
    }
  }
  return bytes;
}

std::string xml(std::uint64_t points) {
  std::string prototype;
  for (const char axis : {'X', 'Y', 'Z'}) {
    using Limits = std::numeric_limits<std::int32_t>;
    prototype += fmt::format(
        "<cartesian{} type=\"ScaledInteger\" minimum=\"{}\" maximum=\"{}\" scale=\"{}\"/>", axis,
        Limits::min(), Limits::max(), kStep);
  }
  return fmt::format(
      R"(<?xml version="1.0" encoding="UTF-8"?>
<e57Root type="Structure" xmlns="http://www.astm.org/COMMIT/E57/2010-e57-v1.0">
<formatName type="String">ASTM E57 3D Imaging Data File</formatName>
<guid type="String">{{emax_scan}}</guid>
<versionMajor type="Integer">1</versionMajor><versionMinor type="Integer">0</versionMinor>
<data3D type="Vector" allowHeterogeneousChildren="1"><vectorChild type="Structure">
<guid type="String">{{emax_scan 1}}</guid><name type="String">scan</name>
<points type="CompressedVector" fileOffset="{}" recordCount="{}">
<prototype type="Structure">{}</prototype><codecs type="Vector" allowHeterogeneousChildren="1"/>
</points></vectorChild></data3D><images2D type="Vector" allowHeterogeneousChildren="1"/></e57Root>
)",
      kFileHeader, points, prototype);
}

}  // namespace

void write_e57_scan(const std::filesystem::path& file, const PointSource& points) {
  Pages pages(file);
  pages.append(std::string(kFileHeader + kSectionHeader, '\0'));
  std::uint64_t count = 0;
  std::vector<Steps> waiting;
  const auto write_packet = [&] {
    if (!waiting.empty()) pages.append(packet(waiting));
    count += waiting.size();
    waiting.clear();
  };
  points([&](std::span<const Point> some) {
    for (const Point& p : some) {
      waiting.push_back(in_steps(p));
      if (waiting.size() == kPacketPoints) write_packet();
    }
  });
  write_packet();
  const std::uint64_t end = pages.size();
  const std::string text = xml(count);
  pages.append(text);
  const bool is_written = pages.finish([&](std::string& first) {
    first.replace(0, 8, "ASTM-E57");
    put(first, 8, std::uint32_t{1});  // version 1.0
    put(first, 24, with_checksums(end));
    put(first, 32, std::uint64_t{text.size()});
    put(first, 40, std::uint64_t{1024});
    first[kFileHeader] = 1;
    put(first, kFileHeader + 8, end - kFileHeader);
    put(first, kFileHeader + 16, std::uint64_t{kFileHeader + kSectionHeader});
  });
  if (!is_written) throw std::runtime_error(file.string() + " cannot be written");
}

}  // namespace emax::test
