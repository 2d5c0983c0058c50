#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host/app/scan.h"
#include "host/geometry/bounds.h"
#include "sw_model/base/point_numbers.h"
#include "sw_model/model/normalization.h"

namespace emax {

class LasStream;

// Half of the bytes that are free now: of the machine, or of its control group where that has less.
std::uint64_t standard_memory();

// What tells a piece of a cloud from that of another file: its number of points, and sums of the
// bits of their coordinates in which their order counts.
struct PieceMark {
  std::uint64_t points = 0, sum = 0, sum_of_sums = 0;
  bool operator==(const PieceMark&) const = default;
};

// A cloud in a file as one process read it, for others that measure some of its pieces.
struct CloudCut {
  std::filesystem::path path;
  CloudReadOptions reading;
  std::uint64_t bytes = 0;  // of the file
  std::size_t piece_points = 0;
  bool is_complete = false;  // see PieceChoice
  Bounds bounds = {};
  std::vector<PieceMark> marks;  // of all pieces
};

// Which pieces are those of one of several processes: all that are numbered first to last - 1 when
// `of` are counted at a time.
struct PieceShare {
  std::size_t first = 0, last = 1, of = 1;
  bool has(std::size_t piece) const { return piece % of >= first && piece % of < last; }
};

// A cloud that is measured piece by piece. It is in memory where there is room for it; else only
// some pieces are, and its file is read anew whenever the points are asked for.
class ScanPieces {
 public:
  // Of a scan in memory, which must outlive this.
  explicit ScanPieces(const Scan& scan);
  // Reads the cloud once and keeps it if `memory` bytes hold it. Throws as read_scan(), and
  // Interrupted when `interrupted` returns true. `threads`: those of several processes that share
  // the pieces; 0: only this one has them.
  ScanPieces(const std::filesystem::path& path, const CloudReadOptions& reading,
             std::string_view unit, std::uint64_t memory, std::function<bool()> interrupted,
             std::size_t threads = 0);
  // Of a stream, if there is one, in place of the file: it is read at once if `memory` bytes hold
  // its points, else by for_each(). A stream is not shared, whatever `threads` are.
  ScanPieces(const std::filesystem::path& path, const CloudReadOptions& reading,
             std::string_view unit, std::uint64_t memory, std::function<bool()> interrupted,
             std::unique_ptr<LasStream> stream, std::size_t threads = 0);
  // Of a cloud that another process has cut: nothing is read yet, and no unit is known. Throws
  // Error if the file has another size.
  ScanPieces(CloudCut cut, std::function<bool()> interrupted);
  ~ScanPieces();

  ScanPieces(const ScanPieces&) = delete;  // scan_ may be own_
  ScanPieces& operator=(const ScanPieces&) = delete;

  const Scan& scan() const { return *scan_; }  // without points unless they are in memory
  bool is_in_memory() const { return scan_->cloud.points.size() == points_; }
  std::uint64_t points() const { return points_; }
  Normalization normalization() const { return normalization_of_box(bounds_.lower, bounds_.upper); }
  // Throws Error if the points are not in memory, where `what` needs all of them at a time.
  void require_in_memory(std::string_view what) const;
  void require_in_memory(const ReportOptions& wanted) const;  // what --report and --picture need
  // Throws Error if the points are a stream that is read once, where `what` needs more than that.
  void require_more_than_once(std::string_view what) const;

  struct Piece {
    std::span<const Point> points;
    std::uint64_t first;   // the index of the first in the cloud
    PointNumbers numbers;  // in the file

    // Those of `ascending`, numbers in the file, that are points of this piece, by their indices in
    // the piece.
    std::vector<std::uint32_t> indices_of(std::span<const std::uint32_t> ascending) const;
  };
  // Calls work(piece) for all points, in pieces of neighbours in the file, on so many threads; in
  // any order. Rethrows the first exception. Throws Error if the file was changed meanwhile, and if
  // the points of a stream are not those that its header promised. Once for a stream.
  void for_each(std::size_t threads, const std::function<void(const Piece&)>& work) const;

  // The same for a share of the pieces of a cloud that is cut for several processes.
  void for_each(std::size_t threads, const PieceShare& share,
                const std::function<void(const Piece&)>& work) const;
  // Nothing where this process alone has the pieces.
  const std::optional<CloudCut>& cut() const { return cut_; }

 private:
  using Take = std::function<void(std::size_t, PointCloud)>;  // a piece with its number
  PointCloud read(const PieceShare& share, const Take& take) const;
  void begin_cut(std::size_t threads);
  void read_first();
  void count(std::size_t number, const PointCloud& piece);
  void take_promise();
  // Throw Error if a piece is not the one that was read first, or not in the box that was found or
  // promised before, and if the points are not all of these.
  void require_known(std::size_t number, const PointCloud& piece, const Bounds& box) const;
  void require_all(const Bounds& found, std::uint64_t points, const PointCloud& rest) const;
  [[noreturn]] void fail_as_other() const;
  void for_each_read(std::size_t threads, const PieceShare& share,
                     const std::function<void(const Piece&)>& work) const;
  Piece held(std::size_t first, std::size_t last) const;

  Scan own_ = {};
  const Scan* scan_;
  CloudReadOptions reading_;
  std::uint64_t memory_ = 0;
  std::function<bool()> interrupted_;
  std::uint64_t points_ = 0;
  Bounds bounds_;
  std::unique_ptr<LasStream> stream_;  // until it is read
  std::size_t piece_points_ = 0;
  std::optional<CloudCut> cut_;
  bool is_cut_elsewhere_ = false;
};

}  // namespace emax
