#include "host/mpi/rank_tiles.h"

#include <fmt/format.h>

#include <atomic>
#include <exception>
#include <map>
#include <optional>
#include <thread>
#include <utility>

#include "host/mpi/tile_message.h"
#include "sw_model/base/error.h"

namespace emax {

class RankTiles::Batch {
 public:
  Batch(RankTiles& ranks, std::size_t count, const MakeTile& make,
        const DecimationSettings& settings, const Advanced& advanced)
      : link_(ranks.link_),
        hosts_(ranks.hosts_),
        make_(make),
        settings_(settings),
        advanced_(advanced),
        results_(count) {}
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;
  ~Batch() { stopped_ = true; }  // where a rank failed, rank 0's own tile ends soon

  // MPI is spoken to by this thread alone; rank 0's own tile has another.
  std::vector<DecimatedTile> run() {
    while (done_ < results_.size()) {
      stop_if_asked();
      hand_out();
      take_own();
      while (std::optional<RankLink::Received> received = link_.receive()) take(*received);
      std::this_thread::sleep_for(kBetweenLooks);
    }
    return std::move(results_);
  }

 private:
  void stop_if_asked() {
    if (stopped_ || !settings_.interrupted || !settings_.interrupted()) return;
    stopped_ = true;
    for (const auto& [rank, tile] : away_) link_.send(rank, {RankMessageKind::kStop});
  }

  // Others first: their tiles are on the way while rank 0 begins.
  void hand_out() {
    for (int rank = 1; rank < link_.size() && next_ < results_.size(); ++rank) {
      if (away_.contains(rank)) continue;
      const std::size_t tile = next_++;
      auto content = std::make_shared<Bytes>(encode(TileTask{make_(tile), settings_}));
      link_.send(rank, {RankMessageKind::kTile, 0, tile, std::move(content)});
      if (stopped_) link_.send(rank, {RankMessageKind::kStop});
      away_[rank] = tile;
    }
    if (!own_ && next_ < results_.size()) begin_own(next_++);
  }

  void begin_own(std::size_t tile) {
    own_ = tile;
    ready_ = false;
    thread_ = std::jthread([this, tile] {
      try {
        DecimationSettings settings = settings_;
        settings.interrupted = [this] { return stopped_.load(); };
        results_[tile] = decimate_tile(make_(tile), settings);
      } catch (...) {
        failure_ = std::current_exception();
      }
      ready_ = true;
    });
  }

  void take_own() {
    if (!own_ || !ready_) return;
    thread_.join();
    if (failure_) std::rethrow_exception(failure_);
    complete(*std::exchange(own_, std::nullopt));
  }

  void take(const RankLink::Received& received) {
    const auto& [from, message] = received;
    if (message.kind == RankMessageKind::kUnusable) {
      throw Error(fmt::format("rank {} on {}: {}", from, hosts_.at(static_cast<std::size_t>(from)),
                              std::string(message.content->begin(), message.content->end())));
    }
    if (message.kind != RankMessageKind::kDecimatedTile) return;  // of an earlier pool
    const auto away = away_.find(from);
    if (away == away_.end() || away->second != message.ticket) return;
    results_[message.ticket] = decode_decimated_tile(*message.content);
    away_.erase(away);
    complete(message.ticket);
  }

  void complete(std::size_t tile) {
    ++done_;
    advanced_(tile, 1);
  }

  RankLink& link_;
  const std::vector<std::string>& hosts_;
  const MakeTile& make_;
  const DecimationSettings& settings_;
  const Advanced& advanced_;
  std::vector<DecimatedTile> results_;
  std::size_t next_ = 0, done_ = 0;
  std::map<int, std::size_t> away_;  // the tile of each rank that has one
  std::optional<std::size_t> own_;
  std::exception_ptr failure_;
  std::atomic<bool> ready_ = false, stopped_ = false;
  std::jthread thread_;  // the last member: it ends before what it works on
};

std::vector<DecimatedTile> RankTiles::run(std::size_t count, const MakeTile& make,
                                          const DecimationSettings& settings,
                                          const Advanced& advanced) {
  return Batch(*this, count, make, settings, advanced).run();
}

}  // namespace emax
