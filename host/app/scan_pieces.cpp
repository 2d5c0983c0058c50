#include "host/app/scan_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <condition_variable>
#include <deque>
#include <exception>
#include <fstream>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "host/files/las_stream.h"
#include "host/files/scan_folder.h"
#include "host/optimize/evaluation_limits.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

// Points of a piece. Greater pieces would not stay in the processor's caches, smaller ones of
// scattered points take longer for each point.
constexpr std::size_t kMostPoints = std::size_t{1} << 20;
constexpr std::size_t kLeastPoints = std::size_t{1} << 14;

// What a point of a piece takes while it is measured.
constexpr std::uint64_t kBytesPerPointOfPiece = 128;
// What a point takes while the cloud is read and put together, and what is known of it later.
constexpr std::uint64_t kBytesPerPoint = 64;

// The number of kilobytes in the line of /proc/meminfo that begins with `name`, in bytes.
std::optional<std::uint64_t> free_bytes_of_machine() {
  std::ifstream lines("/proc/meminfo");
  std::string name, unit;
  std::uint64_t kilobytes = 0;
  while (lines >> name >> kilobytes) {
    std::getline(lines, unit);
    if (name == "MemAvailable:") return kilobytes * 1024;
  }
  return std::nullopt;
}

// So many pieces for each thread of several processes, so that all end at about the same time. How
// many points a file has is not known before it is read: it has about one in so many bytes.
constexpr std::uint64_t kPiecesOfThread = 8, kBytesInFile = 16;

// Pieces on their way from the thread that reads to those that work.
class PieceQueue {
 public:
  struct Stopped {};  // thrown where a worker failed
  struct Entry {
    PointCloud piece;
    std::uint64_t first;  // the index of its first point
    std::size_t number;
  };

  explicit PieceQueue(std::size_t room) : room_(room) {}

  void push(Entry entry) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return failure_ || pieces_.size() < room_; });
    if (failure_) throw Stopped{};
    pieces_.push_back(std::move(entry));
    changed_.notify_all();
  }
  // Nothing at the end, and where a worker failed.
  std::optional<Entry> pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return failure_ || at_end_ || !pieces_.empty(); });
    if (failure_ || pieces_.empty()) return std::nullopt;
    Entry entry = std::move(pieces_.front());
    pieces_.pop_front();
    changed_.notify_all();
    return entry;
  }
  void end() {
    const std::lock_guard lock(mutex_);
    at_end_ = true;
    changed_.notify_all();
  }
  void fail(std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
    changed_.notify_all();
  }
  void rethrow() {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  const std::size_t room_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Entry> pieces_;
  bool at_end_ = false;
  std::exception_ptr failure_;
};

// The points of the pieces, one after the other.
PointCloud joined_pieces(std::vector<PointCloud> pieces, PointCloud rest, std::uint64_t points) {
  rest.points.reserve(static_cast<std::size_t>(points));
  for (PointCloud& piece : pieces) {
    if (!rest.left_out.empty()) {
      for (std::size_t i = 0; i < piece.points.size(); ++i) {
        rest.file_index.push_back(piece.index_in_file(i));
      }
    }
    rest.points.insert(rest.points.end(), piece.points.begin(), piece.points.end());
    piece = {};
  }
  return rest;
}

// Each thread works on a piece while another one waits for it.
std::size_t points_of_piece(std::uint64_t memory, std::size_t threads) {
  const std::uint64_t room = memory / (kBytesPerPointOfPiece * 2 * threads);
  return std::clamp<std::uint64_t>(room, kLeastPoints, kMostPoints);
}

// Of a cloud whose pieces several processes share, perhaps on one machine.
std::size_t points_of_shared_piece(std::uint64_t memory, std::size_t threads,
                                   std::uint64_t file_bytes) {
  const std::uint64_t wanted = file_bytes / (kBytesInFile * kPiecesOfThread * threads);
  return std::clamp<std::uint64_t>(wanted, kLeastPoints, points_of_piece(memory, threads));
}

PieceMark mark_of(std::span<const Point> points) {
  PieceMark mark;
  mark.points = points.size();
  for (const Point& point : points) {
    for (int k = 0; k < 3; ++k) {
      mark.sum += std::bit_cast<std::uint64_t>(point[k]);
      mark.sum_of_sums += mark.sum;
    }
  }
  return mark;
}

bool is_in(const Bounds& inner, const Bounds& outer) {
  return (inner.lower.array() >= outer.lower.array()).all() &&
         (inner.upper.array() <= outer.upper.array()).all();
}

}  // namespace

std::uint64_t standard_memory() {
  std::uint64_t memory = free_bytes_of_machine().value_or(usable_memory());
  std::uint64_t limit = 0, used = 0;
  const std::filesystem::path group = "/sys/fs/cgroup";
  if (std::ifstream(group / "memory.max") >> limit &&
      std::ifstream(group / "memory.current") >> used) {
    memory = std::min(memory, limit - std::min(used, limit));
  }
  return memory / 2;
}

ScanPieces::ScanPieces(const Scan& scan)
    : scan_(&scan), points_(scan.cloud.points.size()), bounds_(bounds_of(scan.cloud.points)) {}

ScanPieces::ScanPieces(const std::filesystem::path& path, const CloudReadOptions& reading,
                       std::string_view unit, std::uint64_t memory,
                       std::function<bool()> interrupted, std::size_t threads)
    : ScanPieces(path, reading, unit, memory, std::move(interrupted), nullptr, threads) {}

ScanPieces::ScanPieces(const std::filesystem::path& path, const CloudReadOptions& reading,
                       std::string_view unit, std::uint64_t memory,
                       std::function<bool()> interrupted, std::unique_ptr<LasStream> stream,
                       std::size_t threads)
    : scan_(&own_),
      reading_(reading),
      memory_(memory),
      interrupted_(std::move(interrupted)),
      stream_(std::move(stream)),
      piece_points_(points_of_piece(memory, processor_threads())) {
  own_.path = path;
  own_.unit = unit_named(unit);
  if (threads > 0 && !stream_) begin_cut(threads);
  if (stream_ && stream_->points() * kBytesPerPoint > memory) {
    take_promise();
  } else {
    read_first();
  }
  own_.width = bounds_.width();
  if (unit.empty()) own_.unit = own_.cloud.unit;
}

ScanPieces::ScanPieces(CloudCut cut, std::function<bool()> interrupted)
    : scan_(&own_),
      reading_(cut.reading),
      interrupted_(std::move(interrupted)),
      bounds_(cut.bounds),
      piece_points_(cut.piece_points),
      cut_(std::move(cut)),
      is_cut_elsewhere_(true) {
  own_.path = cut_->path;
  for (const PieceMark& mark : cut_->marks) points_ += mark.points;
  if (!exists(cut_->path)) throw Error(own_.path.string() + ": no such file");
  const std::uint64_t bytes = bytes_of_input(cut_->path);
  if (bytes == cut_->bytes) return;
  throw Error(fmt::format("{}: has {} bytes, not {}", own_.path.string(), grouped(bytes),
                          grouped(cut_->bytes)));
}

ScanPieces::~ScanPieces() = default;

void ScanPieces::begin_cut(std::size_t threads) {
  cut_.emplace();
  cut_->path = own_.path;
  cut_->reading = reading_;
  cut_->bytes = bytes_of_input(own_.path);
  piece_points_ = points_of_shared_piece(memory_, threads, cut_->bytes);
  cut_->piece_points = piece_points_;
}

void ScanPieces::take_promise() {
  points_ = stream_->points();
  bounds_ = stream_->box();
  own_.cloud.unit = stream_->unit();
  own_.cloud.resolution = stream_->resolution();
}

void ScanPieces::read_first() {
  std::vector<PointCloud> kept;
  bool are_kept = true;
  own_.cloud = read({}, [&](std::size_t number, PointCloud piece) {
    count(number, piece);
    are_kept = are_kept && points_ * kBytesPerPoint <= memory_;
    if (are_kept) {
      kept.push_back(std::move(piece));
    } else {
      kept.clear();
    }
  });
  stream_.reset();
  if (cut_) {
    cut_->bounds = bounds_;
    cut_->is_complete = own_.cloud.left_out.empty();
  }
  if (are_kept) {
    own_.cloud = joined_pieces(std::move(kept), std::move(own_.cloud), points_);
    check_cloud(own_.cloud, own_.path.string());
  }
}

// A piece of the first reading.
void ScanPieces::count(std::size_t number, const PointCloud& piece) {
  const Bounds box = bounds_of(piece.points);
  bounds_ = points_ == 0 ? box : joined(bounds_, box);
  points_ += piece.points.size();
  if (!cut_) return;
  cut_->marks.resize(number + 1);
  cut_->marks[number] = mark_of(piece.points);
}

PointCloud ScanPieces::read(const PieceShare& share, const Take& take) const {
  std::size_t next = 0;
  const auto wants = [&] { return share.has(next++); };
  const auto give = [&](PointCloud piece) {
    if (interrupted_ && interrupted_()) throw Interrupted{};
    take(next - 1, std::move(piece));
  };
  const PieceChoice choice = {wants, cut_ && cut_->is_complete};
  return stream_ ? read_cloud_in_pieces(*stream_, reading_, piece_points_, give, choice)
                 : read_cloud_in_pieces(scan_->path, reading_, piece_points_, give, choice);
}

void ScanPieces::require_in_memory(std::string_view what) const {
  if (is_in_memory()) return;
  throw Error(fmt::format(
      "{}: {} points need {:.3g} GB, more than the {:.3g} GB that --memory leaves, and {} needs "
      "all of them at once; give more memory, or leave it out",
      scan_->path.string(), grouped(points_), static_cast<double>(points_ * kBytesPerPoint) / 1e9,
      static_cast<double>(memory_) / 1e9, what));
}

void ScanPieces::require_in_memory(const ReportOptions& wanted) const {
  if (!wanted.report.empty()) require_in_memory("--report");
  if (!wanted.picture.empty()) require_in_memory("--picture");
}

void ScanPieces::require_more_than_once(std::string_view what) const {
  if (!stream_) return;
  stream_->input().fail(
      fmt::format("{} points need {:.3g} GB, more than the {:.3g} GB that --memory leaves, so the "
                  "stream is measured as it comes, and {} needs to see it twice",
                  grouped(points_), static_cast<double>(points_ * kBytesPerPoint) / 1e9,
                  static_cast<double>(memory_) / 1e9, what),
      kStoreFirst);
}

void ScanPieces::fail_as_other() const {
  if (stream_) {
    stream_->input().fail("the box of its points is not the one that its header promises",
                          kStoreFirst);
  }
  throw Error(fmt::format("{}: {}", scan_->path.string(),
                          is_cut_elsewhere_
                              ? "has other points"
                              : "was changed while it was read; leave it as it is meanwhile"));
}

void ScanPieces::require_known(std::size_t number, const PointCloud& piece,
                               const Bounds& box) const {
  const bool is_known =
      cut_ ? number < cut_->marks.size() && mark_of(piece.points) == cut_->marks[number]
           : is_in(box, bounds_);
  if (!is_known) fail_as_other();
}

void ScanPieces::require_all(const Bounds& found, std::uint64_t points,
                             const PointCloud& rest) const {
  if (stream_ && points != points_) {
    stream_->input().fail(
        fmt::format("its header promises the box of {} points, but some are left out ({})",
                    grouped(points_), describe(rest.left_out)),
        kStoreFirst);
  }
  if (points != points_) fail_as_other();
  if (cut_) return;  // its marks tell more, and a share of its pieces has a smaller box
  if (!is_in(bounds_, found) && !EMAX_FAULT(kTrustsPromises)) fail_as_other();
}

std::vector<std::uint32_t> ScanPieces::Piece::indices_of(
    std::span<const std::uint32_t> ascending) const {
  std::vector<std::uint32_t> indices;
  const auto begin = std::ranges::lower_bound(ascending, numbers[0]);
  const auto end = std::ranges::upper_bound(ascending, numbers[points.size() - 1]);
  for (const std::uint32_t number : std::span(begin, end)) {
    const auto at = std::ranges::lower_bound(numbers.listed, number);
    if (numbers.listed.empty()) {
      indices.push_back(number - numbers.first);
    } else if (*at == number) {
      indices.push_back(static_cast<std::uint32_t>(at - numbers.listed.begin()));
    }
  }
  return indices;
}

ScanPieces::Piece ScanPieces::held(std::size_t first, std::size_t last) const {
  const PointCloud& cloud = scan_->cloud;
  const auto of_piece = [&](const auto& all) {
    return std::span(all).subspan(first, last - first);
  };
  PointNumbers numbers{cloud.index_in_file(first)};
  if (!cloud.file_index.empty()) numbers.listed = of_piece(cloud.file_index);
  return {of_piece(cloud.points), first, numbers};
}

void ScanPieces::for_each(std::size_t threads,
                          const std::function<void(const Piece&)>& work) const {
  if (!is_in_memory()) {
    for_each_read(threads, {}, work);
    return;
  }
  const std::size_t points = scan_->cloud.points.size();
  const std::size_t size = std::clamp(points / (4 * threads), kLeastPoints, kMostPoints);
  in_pieces(threads, points, size,
            [&](std::size_t, std::size_t first, std::size_t last) { work(held(first, last)); });
}

void ScanPieces::for_each(std::size_t threads, const PieceShare& share,
                          const std::function<void(const Piece&)>& work) const {
  if (!is_in_memory()) {
    for_each_read(threads, share, work);
    return;
  }
  std::vector<std::pair<std::size_t, std::size_t>> pieces;  // first point and end
  std::size_t first = 0;
  for (std::size_t i = 0; i < cut_->marks.size(); ++i) {
    const std::size_t end = first + static_cast<std::size_t>(cut_->marks[i].points);
    if (share.has(i) && end > first) pieces.emplace_back(first, end);
    first = end;
  }
  in_pieces(threads, pieces.size(), 1, [&](std::size_t, std::size_t i, std::size_t) {
    work(held(pieces[i].first, pieces[i].second));
  });
}

void ScanPieces::for_each_read(std::size_t threads, const PieceShare& share,
                               const std::function<void(const Piece&)>& work) const {
  PieceQueue queue(threads);
  std::uint64_t points = 0;
  PointCloud rest;
  std::mutex mutex;
  Bounds found = {Point::Constant(std::numeric_limits<double>::infinity()),
                  Point::Constant(-std::numeric_limits<double>::infinity())};
  {
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < threads; ++i) {
      workers.emplace_back([&] {
        try {
          while (const auto next = queue.pop()) {
            const PointCloud& piece = next->piece;
            const Bounds box = bounds_of(piece.points);
            require_known(next->number, piece, box);
            work({piece.points, next->first, {piece.first_index, piece.file_index}});
            const std::lock_guard lock(mutex);
            found = joined(found, box);
          }
        } catch (...) {
          queue.fail(std::current_exception());
        }
      });
    }
    try {
      rest = read(share, [&](std::size_t number, PointCloud piece) {
        const std::uint64_t first = points;
        points += piece.points.size() + piece.unwanted;
        if (!piece.points.empty()) queue.push({std::move(piece), first, number});
      });
      queue.end();
    } catch (const PieceQueue::Stopped&) {
      // The worker's failure is rethrown below.
    } catch (...) {
      queue.fail(std::current_exception());
    }
  }
  queue.rethrow();
  require_all(found, points, rest);
}

}  // namespace emax
