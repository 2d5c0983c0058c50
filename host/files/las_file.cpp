// LAS and LAZ (ASPRS): a header, records of variable length, points of whole numbers. The crate laz
// unpacks the points of LAZ.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "host/files/file_content.h"
#include "host/files/las_header.h"
#include "host/files/las_stream.h"
#include "host/scan_crates/scan_crates.h"
#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

class PointReader {
 public:
  PointReader(const NamedInput& input, const LasHeader& header, const CloudReadOptions& options,
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
      point[k] =
          load_little_endian<std::int32_t>(record + 4 * k) * header_.scale[k] + header_.shift[k];
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

  const NamedInput& input_;
  const LasHeader& header_;
  FileContent& content_;
  std::array<bool, 256> left_out_{};
  bool bounded_ = false;
  Point margin_;
};

void note_header(const NamedInput& input, const LasHeader& header, const LasRecords& records,
                 FileContent& content) {
  content.has_classes = true;
  content.unit = unit_of_las(input, records);
  content.resolution = resolution_of_las(header);
}

// Points that are not compressed.
void read_plain_points(const LasBytes& bytes, const LasHeader& header, FileContent& content,
                       PointReader& reader) {
  constexpr std::uint64_t kPiece = 1 << 16;
  std::vector<std::uint8_t> piece;
  for (std::uint64_t i = 0; i < header.points;) {
    const std::uint64_t left = header.points - i;
    if (const std::uint64_t passed = content.pass_unwanted(left)) {
      i += passed;
      continue;
    }
    const std::uint64_t count = std::min({kPiece, left, std::uint64_t{content.room()}});
    piece.resize(count * header.point_bytes);
    bytes.read(header.offset + i * header.point_bytes, piece);
    reader.read(piece);
    i += count;
  }
}

}  // namespace

void read_las(const InputStream& input, const CloudReadOptions& options, FileContent& content) {
  const LasBytes bytes{input, input.size(), [&](std::uint64_t offset, std::span<std::uint8_t> to) {
                         input.read(offset, to);
                       }};
  const LasHeader header = read_las_header(bytes);
  const LasRecords records = read_las_records(bytes, header);
  note_header(input, header, records, content);
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
  read_plain_points(bytes, header, content, reader);
}

LasStream::LasStream(const std::filesystem::path& path) : pipe_(path) {
  constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();
  if (pipe_.head().empty()) pipe_.fail("the stream is empty", kStoreFirst);
  if (format_of_content(pipe_.head()) != ".las") {
    pipe_.fail("is a pipe, and only LAS without compression is read from one",
               "store the scan in a file first, or give it to standard input as -");
  }
  size_ = pipe_.head_is_all() ? pipe_.head().size() : kUnknown;
  header_ = read_las_header(bytes());
  records_ = read_las_records(bytes(), header_);
  check_count(pipe_, header_.points, "points", header_.point_bytes, size_ - header_.offset);
}

LasBytes LasStream::bytes() {
  return {pipe_, size_,
          [this](std::uint64_t offset, std::span<std::uint8_t> to) { pipe_.read(offset, to); }};
}

Bounds LasStream::box() const {
  const Bounds box{header_.least, header_.greatest};
  if (!box.lower.allFinite() || !box.upper.allFinite() ||
      (box.lower.array() > box.upper.array()).any() || !(box.width() > 0)) {
    pipe_.fail("the header promises no box of its points", kStoreFirst);
  }
  return box;
}

void LasStream::read(const CloudReadOptions& options, FileContent& content) {
  note_header(pipe_, header_, records_, content);
  PointReader reader(pipe_, header_, options, content);
  content.expect_points(header_.points);
  read_plain_points(bytes(), header_, content, reader);
  if (EMAX_FAULT(kTrustsPromises)) return;
  if (header_.may_follow) {
    pipe_.skip(std::numeric_limits<std::uint64_t>::max());
  } else if (pipe_.skip(header_.point_bytes) == header_.point_bytes) {
    pipe_.fail(fmt::format("the header promises {} points, but more follow", header_.points),
               kExportAgain);
  }
}

}  // namespace emax
