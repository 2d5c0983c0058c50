// LAS and LAZ (ASPRS): a header, records of variable length, points of whole numbers. The crate laz
// unpacks the points of LAZ.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "host/files/file_content.h"
#include "host/files/las_reference_system.h"
#include "host/scan_crates/scan_crates.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

// Bytes of a point of each format.
constexpr std::array<std::uint16_t, 11> kLeastPointBytes{20, 28, 26, 34, 57, 63,
                                                         30, 36, 38, 59, 67};
constexpr int kFirstExtendedFormat = 6;
constexpr std::array<std::uint16_t, 5> kLasHeaderBytes{227, 227, 227, 235, 375};  // of 1.0 to 1.4

template <class Number>
Number load(const std::uint8_t* bytes) {
  static_assert(std::endian::native == std::endian::little);
  Number value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

struct LasHeader {
  int minor = 0;
  std::uint16_t header_bytes = 0;
  std::uint32_t offset = 0, records = 0;  // of the points; of variable length
  int format = 0;
  bool compressed = false;
  std::uint16_t point_bytes = 0;
  std::uint64_t points = 0;
  bool may_follow = false;  // data after the points: waveforms, extended records
  Point scale, shift, greatest, least;
};

LasHeader read_las_header(const InputStream& input) {
  std::array<std::uint8_t, 375> bytes{};
  if (input.size() < kLasHeaderBytes[0]) {
    input.fail(fmt::format("{} bytes are fewer than a LAS header has", input.size()), kExportAgain);
  }
  input.read(0, std::span(bytes).first(std::min<std::size_t>(input.size(), bytes.size())));
  if (std::memcmp(bytes.data(), "LASF", 4) != 0) {
    input.fail("does not begin with LASF", "it is no LAS or LAZ file, check its ending");
  }
  if (bytes[24] != 1 || bytes[25] >= kLasHeaderBytes.size()) {
    input.fail(fmt::format("version {}.{} is not known", bytes[24], bytes[25]),
               "export it as LAS 1.0 to 1.4");
  }
  LasHeader h;
  h.minor = bytes[25];
  h.header_bytes = load<std::uint16_t>(&bytes[94]);
  h.offset = load<std::uint32_t>(&bytes[96]);
  h.records = load<std::uint32_t>(&bytes[100]);
  h.format = bytes[104] & 0x3f;
  h.compressed = (bytes[104] & 0x80) != 0;
  h.point_bytes = load<std::uint16_t>(&bytes[105]);
  h.points = load<std::uint32_t>(&bytes[107]);
  if (h.header_bytes < kLasHeaderBytes[bytes[25]] || h.offset < h.header_bytes ||
      h.offset > input.size()) {
    input.fail(fmt::format("the header of {} bytes puts the points at byte {} of {}",
                           h.header_bytes, h.offset, input.size()),
               kExportAgain);
  }
  if (h.minor == 4) {
    const auto points = load<std::uint64_t>(&bytes[247]);
    if (h.points != 0 && h.points != points) {
      input.fail(fmt::format("the header promises {} points and {} points", h.points, points),
                 kExportAgain);
    }
    h.points = points;
  }
  h.may_follow = (h.minor >= 3 && load<std::uint64_t>(&bytes[227]) != 0) ||
                 (h.minor == 4 && load<std::uint32_t>(&bytes[243]) != 0);
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
    h.scale[k] = load<double>(&bytes[131 + 8 * axis]);
    h.shift[k] = load<double>(&bytes[155 + 8 * axis]);
    h.greatest[k] = load<double>(&bytes[179 + 16 * axis]);
    h.least[k] = load<double>(&bytes[187 + 16 * axis]);
  }
  if (!h.scale.allFinite() || (h.scale.array() == 0).any() || !h.shift.allFinite()) {
    input.fail("a scale factor is 0 or not finite, or an offset is not finite", kExportAgain);
  }
  return h;
}

struct Records {
  std::optional<LasLengths> keys, text;
  std::optional<std::vector<std::uint8_t>> laz;
};

Records read_records(const InputStream& input, const LasHeader& header) {
  constexpr std::uint64_t kRecordHeader = 54;
  constexpr std::uint16_t kKeys = 34735, kText = 2112;
  if (header.records > (header.offset - header.header_bytes) / kRecordHeader) {
    input.fail(fmt::format("the header promises {} records, but there is room for {}",
                           header.records, (header.offset - header.header_bytes) / kRecordHeader),
               kExportAgain);
  }
  Records records;
  std::uint64_t at = header.header_bytes;
  for (std::uint32_t i = 0; i < header.records; ++i) {
    std::array<std::uint8_t, kRecordHeader> bytes{};
    const auto room = [&](std::uint64_t wanted) {
      if (wanted > header.offset - at) {
        input.fail(fmt::format("record {} ends behind the begin of the points", i), kExportAgain);
      }
    };
    room(kRecordHeader);
    input.read(at, bytes);
    at += kRecordHeader;
    const auto length = load<std::uint16_t>(&bytes[20]);
    room(length);
    const auto kind = load<std::uint16_t>(&bytes[18]);
    const std::string_view user(reinterpret_cast<const char*>(&bytes[2]), 16);
    const bool is_laz = kind == 22204 && user.starts_with("laszip encoded");
    const bool is_projection = user.starts_with("LASF_Projection");
    if (is_laz || (is_projection && (kind == kKeys || kind == kText))) {
      std::vector<std::uint8_t> content(length);
      input.read(at, content);
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
std::optional<Unit> unit_of(const InputStream& input, const Records& records) {
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

class PointReader {
 public:
  PointReader(const InputStream& input, const LasHeader& header, const CloudReadOptions& options,
              FileContent& content)
      : input_(input), header_(header), content_(content) {
    for (const std::uint8_t c : options.left_out_classes) left_out_[c] = true;
    // A writer that knew no bounds left them at 0. Those of others may be rounded.
    bounded_ = header.compressed && header.least.allFinite() && header.greatest.allFinite() &&
               (header.least.array() < header.greatest.array()).all();
    margin_ = header.scale.cwiseAbs() +
              1e-9 * header.least.cwiseAbs().cwiseMax(header.greatest.cwiseAbs());
  }

  void read(std::span<const std::uint8_t> records) {
    for (std::size_t at = 0; at < records.size(); at += header_.point_bytes) add(&records[at]);
  }

 private:
  void add(const std::uint8_t* record) {
    const bool extended = header_.format >= kFirstExtendedFormat;
    const unsigned type = extended ? record[16] : record[15] & 0x1fu;
    const bool withheld = (record[15] & (extended ? 0x04u : 0x80u)) != 0 && header_.minor > 0;
    Point point;
    for (int k = 0; k < 3; ++k) {
      point[k] = load<std::int32_t>(record + 4 * k) * header_.scale[k] + header_.shift[k];
    }
    // The compression has no checksums.
    if (bounded_ && ((point - header_.greatest - margin_).maxCoeff() > 0 ||
                     (header_.least - point - margin_).maxCoeff() > 0)) {
      input_.fail(fmt::format("point {} lies outside of the bounds of the header",
                              content_.index_of_next()),
                  kExportAgain);
    }
    if (withheld) {
      content_.leave_out("withheld");
    } else if (left_out_[type]) {
      content_.leave_out(fmt::format("of class {}", type));
    } else {
      content_.add_vertex(point, "point", content_.index_of_next());
    }
  }

  const InputStream& input_;
  const LasHeader& header_;
  FileContent& content_;
  std::array<bool, 256> left_out_{};
  bool bounded_ = false;
  Point margin_;
};

}  // namespace

void read_las(const InputStream& input, const CloudReadOptions& options, FileContent& content) {
  const LasHeader header = read_las_header(input);
  const Records records = read_records(input, header);
  content.has_classes = true;
  content.unit = unit_of(input, records);
  content.resolution = header.scale.norm() / 2;
  PointReader reader(input, header, options, content);

  const std::uint64_t room = input.size() - header.offset;
  if (header.compressed) {
    if (!records.laz) {
      input.fail("the record that describes its compression is missing", kExportAgain);
    }
    check_count(input, header.points, "points", 1, std::uint64_t{1} << 32);
    if (header.points == 0) return;
    try {
      read_laz(input.descriptor(), {*records.laz, header.offset, header.point_bytes, header.points},
               [&](std::span<const std::uint8_t> points) { reader.read(points); });
    } catch (const CrateRefusal& refusal) {
      input.fail(refusal.what(), kExportAgain);
    }
    return;
  }
  if (!EMAX_FAULT(kTrustsCounts)) {
    check_count(input, header.points, "points", header.point_bytes, room);
  }
  if (!header.may_follow && room / header.point_bytes > header.points) {
    input.fail(fmt::format("the header promises {} points, but the file has {}", header.points,
                           room / header.point_bytes),
               kExportAgain);
  }
  content.expect_points(header.points);
  constexpr std::uint64_t kPiece = 1 << 16;
  std::vector<std::uint8_t> piece;
  for (std::uint64_t i = 0; i < header.points; i += kPiece) {
    piece.resize(std::min(kPiece, header.points - i) * header.point_bytes);
    input.read(header.offset + i * header.point_bytes, piece);
    reader.read(piece);
  }
}

}  // namespace emax
