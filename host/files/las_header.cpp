#include "host/files/las_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace emax {
namespace {

// Bytes of a point of each format.
constexpr std::array<std::uint16_t, 11> kLeastPointBytes{20, 28, 26, 34, 57, 63,
                                                         30, 36, 38, 59, 67};
constexpr std::array<std::uint16_t, 5> kLasHeaderBytes{227, 227, 227, 235, 375};  // of 1.0 to 1.4

}  // namespace

LasHeader read_las_header(const LasBytes& file) {
  const NamedInput& input = file.input;
  std::array<std::uint8_t, 375> bytes{};
  if (file.size < kLasHeaderBytes[0]) {
    input.fail(fmt::format("{} bytes are fewer than a LAS header has", file.size), kExportAgain);
  }
  file.read(0, std::span(bytes).first(std::min<std::size_t>(file.size, bytes.size())));
  if (std::memcmp(bytes.data(), "LASF", 4) != 0) {
    input.fail("does not begin with LASF", "it is no LAS or LAZ file, check its ending");
  }
  if (bytes[24] != 1 || bytes[25] >= kLasHeaderBytes.size()) {
    input.fail(fmt::format("version {}.{} is not known", bytes[24], bytes[25]),
               "export it as LAS 1.0 to 1.4");
  }
  LasHeader h;
  h.minor = bytes[25];
  h.header_bytes = load_little_endian<std::uint16_t>(&bytes[94]);
  h.offset = load_little_endian<std::uint32_t>(&bytes[96]);
  h.records = load_little_endian<std::uint32_t>(&bytes[100]);
  h.format = bytes[104] & 0x3f;
  h.compressed = (bytes[104] & 0x80) != 0;
  h.point_bytes = load_little_endian<std::uint16_t>(&bytes[105]);
  h.points = load_little_endian<std::uint32_t>(&bytes[107]);
  if (h.header_bytes < kLasHeaderBytes[bytes[25]] || h.offset < h.header_bytes ||
      h.offset > file.size) {
    input.fail(fmt::format("the header of {} bytes puts the points at byte {} of {}",
                           h.header_bytes, h.offset, file.size),
               kExportAgain);
  }
  if (h.minor == 4) {
    const auto points = load_little_endian<std::uint64_t>(&bytes[247]);
    if (h.points != 0 && h.points != points) {
      input.fail(fmt::format("the header promises {} points and {} points", h.points, points),
                 kExportAgain);
    }
    h.points = points;
  }
  h.may_follow = (h.minor >= 3 && load_little_endian<std::uint64_t>(&bytes[227]) != 0) ||
                 (h.minor == 4 && load_little_endian<std::uint32_t>(&bytes[243]) != 0);
  if (h.format >= static_cast<int>(kLeastPointBytes.size())) {
    input.fail(fmt::format("point format {} is not known", h.format),
               "export it with a point format from 0 to 10");
  }
  if (h.point_bytes < kLeastPointBytes[static_cast<std::size_t>(h.format)]) {
    input.fail(
        fmt::format("{} bytes are too few for a point of format {}", h.point_bytes, h.format),
        kExportAgain);
  }
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    h.scale[k] = load_little_endian<double>(&bytes[131 + 8 * axis]);
    h.shift[k] = load_little_endian<double>(&bytes[155 + 8 * axis]);
    h.greatest[k] = load_little_endian<double>(&bytes[179 + 16 * axis]);
    h.least[k] = load_little_endian<double>(&bytes[187 + 16 * axis]);
  }
  if (!h.scale.allFinite() || (h.scale.array() == 0).any() || !h.shift.allFinite()) {
    input.fail("a scale factor is 0 or not finite, or an offset is not finite", kExportAgain);
  }
  return h;
}

LasRecords read_las_records(const LasBytes& file, const LasHeader& header) {
  const NamedInput& input = file.input;
  constexpr std::uint64_t kRecordHeader = 54;
  constexpr std::uint16_t kKeys = 34735, kText = 2112;
  if (header.records > (header.offset - header.header_bytes) / kRecordHeader) {
    input.fail(fmt::format("the header promises {} records, but there is room for {}",
                           header.records, (header.offset - header.header_bytes) / kRecordHeader),
               kExportAgain);
  }
  LasRecords records;
  std::uint64_t at = header.header_bytes;
  for (std::uint32_t i = 0; i < header.records; ++i) {
    std::array<std::uint8_t, kRecordHeader> bytes{};
    const auto room = [&](std::uint64_t wanted) {
      if (wanted > header.offset - at) {
        input.fail(fmt::format("record {} ends behind the begin of the points", i), kExportAgain);
      }
    };
    room(kRecordHeader);
    file.read(at, bytes);
    at += kRecordHeader;
    const auto length = load_little_endian<std::uint16_t>(&bytes[20]);
    room(length);
    const auto kind = load_little_endian<std::uint16_t>(&bytes[18]);
    const std::string_view user(reinterpret_cast<const char*>(&bytes[2]), 16);
    const bool is_laz = kind == 22204 && user.starts_with("laszip encoded");
    const bool is_projection = user.starts_with("LASF_Projection");
    if (is_laz || (is_projection && (kind == kKeys || kind == kText))) {
      std::vector<std::uint8_t> content(length);
      file.read(at, content);
      if (is_laz) {
        records.laz = std::move(content);
      } else if (kind == kKeys) {
        records.keys = lengths_of_keys(content);
      } else {
        records.text =
            lengths_of_text({reinterpret_cast<const char*>(content.data()), content.size()});
      }
    }
    at += length;
  }
  return records;
}

// Text counts before keys, as from LAS 1.4 on.
std::optional<Unit> unit_of_las(const NamedInput& input, const LasRecords& records) {
  const LasLengths lengths = records.text ? *records.text : records.keys.value_or(LasLengths{});
  if (lengths.angles) {
    input.fail("its coordinates are longitudes and latitudes", "project them, as to UTM");
  }
  if (lengths.unit && lengths.heights && lengths.unit != lengths.heights) {
    input.fail(fmt::format("its heights are in {}, but the rest is in {}", lengths.heights->name,
                           lengths.unit->name),
               "convert it to one unit");
  }
  return lengths.unit;
}

}  // namespace emax
