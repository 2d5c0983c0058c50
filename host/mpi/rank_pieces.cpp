#include "host/mpi/rank_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "host/files/spooled_input.h"
#include "host/mpi/piece_message.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

// What other ranks can read, too: not standard input, nor a pipe.
bool is_shared(const std::filesystem::path& path) {
  if (path == kStandardInput) return false;
  return std::filesystem::is_regular_file(path) || std::filesystem::is_directory(path);
}

// Other ranks may stand in another folder.
std::filesystem::path named_for_all(const std::filesystem::path& path) {
  return path.empty() ? path : std::filesystem::absolute(path);
}

PiecesTask task_for_all(const ScanPieces& scan, const PieceMeter& meter, const MeterFiles& files,
                        const PieceQuestion& question) {
  PiecesTask task{.cloud = *scan.cut(),
                  .files = {named_for_all(files.mesh), named_for_all(files.reference),
                            files.used_vertices_alone}};
  task.cloud.path = named_for_all(task.cloud.path);
  task.mesh_checksum = checksum(meter.mesh());
  if (meter.reference()) task.reference_checksum = checksum(*meter.reference());
  task.brute_force = meter.brute_force();
  task.question = question;
  return task;
}

}  // namespace

// One run.
class RankPieces::Round {
 public:
  Round(RankPieces& ranks, const ScanPieces& scan, PieceMeter& meter, const PieceQuestion& question,
        const std::function<bool()>& interrupted, const Take& take)
      : link_(ranks.link_),
        processors_(ranks.processors_),
        hosts_(ranks.hosts_),
        number_(++ranks.rounds_),
        scan_(scan),
        meter_(meter),
        question_(question),
        interrupted_(interrupted),
        take_(take) {}
  Round(const Round&) = delete;
  Round& operator=(const Round&) = delete;

  // MPI is spoken to by this thread alone; rank 0's own pieces have others.
  void run(PiecesTask task) {
    send(std::move(task));
    begin_own();
    try {
      while (!away_.empty() || !own_has_ended_) {
        if (own_has_ended_ && failure_) std::rethrow_exception(failure_);
        take_arrived();
        std::this_thread::sleep_for(kBetweenLooks);
      }
      thread_.join();
      if (failure_) std::rethrow_exception(failure_);
    } catch (...) {
      end();
      throw;
    }
  }

 private:
  // The pieces are dealt out to the processors of all ranks in turn.
  void send(PiecesTask task) {
    task.share = {0, 0, std::accumulate(processors_.begin(), processors_.end(), std::size_t{0})};
    for (std::size_t rank = 0; rank < processors_.size(); ++rank) {
      task.share.first = std::exchange(task.share.last, task.share.last + processors_[rank]);
      if (rank == 0) {
        own_ = task.share;
        continue;
      }
      auto content = std::make_shared<Bytes>(encode(task));
      link_.send(static_cast<int>(rank),
                 {RankMessageKind::kPieces, number_, 0, std::move(content)});
      away_.insert(static_cast<int>(rank));
    }
  }

  void begin_own() {
    thread_ = std::jthread([this] {
      const auto stopped = [this] { return stopped_ || (interrupted_ && interrupted_()); };
      try {
        scan_.for_each(processors_.front(), own_, [&](const ScanPieces::Piece& piece) {
          if (stopped()) throw Interrupted{};
          take_(meter_.measure(piece, question_, stopped));
        });
      } catch (...) {
        failure_ = std::current_exception();
      }
      own_has_ended_ = true;
    });
  }

  void take_arrived() {
    while (const std::optional<RankLink::Received> received = link_.receive()) {
      if (received->message.pool == number_) take(*received);
    }
  }

  void take(const RankLink::Received& received) {
    const auto& [from, message] = received;
    switch (message.kind) {
      case RankMessageKind::kPieceFound:
        take_(decode_piece_findings(*message.content, scan_.normalization()));
        break;
      case RankMessageKind::kPiecesDone: {
        away_.erase(from);
        const MeterParts parts = decode_meter_parts(*message.content);
        meter_.certificate().add(parts.mesh);
        if (auto* of_reference = meter_.certificate_of_reference()) {
          of_reference->add(parts.reference);
        }
        break;
      }
      case RankMessageKind::kUnusable:
        away_.erase(from);
        throw Error(
            fmt::format("rank {} on {}: {}; every rank needs the same files under the same names",
                        from, hosts_.at(static_cast<std::size_t>(from)),
                        std::string(message.content->begin(), message.content->end())));
      default:
        break;  // of what was done before
    }
  }

  // Waits until no rank works on it, so that none is left with what nobody takes.
  void end() {
    stopped_ = true;
    for (const int rank : away_) link_.send(rank, {RankMessageKind::kEndPieces, number_});
    while (!away_.empty()) {
      while (const std::optional<RankLink::Received> received = link_.receive()) {
        const RankMessageKind kind = received->message.kind;
        if (kind == RankMessageKind::kPiecesDone || kind == RankMessageKind::kUnusable) {
          away_.erase(received->from);
        }
      }
      std::this_thread::sleep_for(kBetweenLooks);
    }
  }

  RankLink& link_;
  const std::vector<unsigned>& processors_;
  const std::vector<std::string>& hosts_;
  const std::uint64_t number_;
  const ScanPieces& scan_;
  PieceMeter& meter_;
  const PieceQuestion& question_;
  const std::function<bool()>& interrupted_;
  const Take& take_;
  PieceShare own_;
  std::set<int> away_;  // the ranks that have not ended
  std::exception_ptr failure_;
  std::atomic<bool> own_has_ended_ = false, stopped_ = false;
  std::jthread thread_;  // the last member: it ends before what it works on
};

std::size_t RankPieces::threads(const std::filesystem::path& cloud, const MeterFiles& files) const {
  const bool has_reference = !files.reference.empty();
  if (link_.size() == 1 || !is_shared(cloud) || !is_shared(files.mesh) ||
      (has_reference && !is_shared(files.reference))) {
    return 0;
  }
  return std::accumulate(processors_.begin(), processors_.end(), std::size_t{0});
}

void RankPieces::run(const ScanPieces& scan, PieceMeter& meter, const MeterFiles& files,
                     const PieceQuestion& question, const std::function<bool()>& interrupted,
                     const Take& take) {
  if (!scan.cut()) {
    LocalPieces().run(scan, meter, files, question, interrupted, take);
    return;
  }
  Round(*this, scan, meter, question, interrupted, take)
      .run(task_for_all(scan, meter, files, question));
}

}  // namespace emax
