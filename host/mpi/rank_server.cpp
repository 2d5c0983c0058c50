#include "host/mpi/rank_server.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "host/mpi/piece_message.h"
#include "host/mpi/rank_measurement.h"
#include "host/mpi/rank_pool.h"
#include "host/mpi/tile_message.h"
#include "host/worker_pool/worker_parts.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

class Server {
 public:
  Server(RankLink& link, std::size_t threads) : link_(link), threads_(threads) {}

  void run() {
    while (!quit_) {
      while (std::optional<RankLink::Received> received = link_.receive()) {
        guarded([&] { take(received->message); });
      }
      if (parts_.running() > 0) {
        guarded([&] {
          for (const std::size_t part : parts_.wait_for(kBetweenLooks)) {
            send(RankMessageKind::kPartDone, part, {});
          }
        });
      } else if (pool_ && pool_->outstanding() > 0) {
        guarded([&] {
          if (std::optional<Completed> completed = pool_->wait_for(kBetweenLooks))
            answer(*completed);
        });
      } else if (measurement_) {
        guarded([&] { send_found(); });
      } else if (!quit_) {
        std::this_thread::sleep_for(kBetweenLooks);
      }
    }
  }

 private:
  // Rank 0 hears why no evaluation can be made here.
  template <typename F>
  void guarded(F f) {
    try {
      f();
    } catch (const std::exception& error) {
      pool_.reset();
      measurement_.reset();
      const std::string text = error.what();
      send(RankMessageKind::kUnusable, 0, {text.begin(), text.end()});
    }
  }

  void take(const RankMessage& message) {
    const auto body = [&] { return std::span(*message.content).subspan(kLengthBytes); };
    switch (message.kind) {
      case RankMessageKind::kPoints:
        points_ = std::get<PointsMessage>(decode(body()));
        break;
      case RankMessageKind::kStart:
        number_ = message.pool;
        start(decode_rank_pool_options(*message.content));
        break;
      case RankMessageKind::kRun:
        // Where it could not be started, rank 0 will hear of it.
        if (pool_) pool_->submit(std::get<RunMessage>(decode(body())));
        break;
      case RankMessageKind::kStop:
        if (pool_) pool_->stop();
        break;
      case RankMessageKind::kTile:
        decimate(message);
        break;
      case RankMessageKind::kPart: {
        const auto part = std::get<PartMessage>(decode(body()));
        parts_.start(part.folder, part_step_named(part.step), part.part);
        break;
      }
      case RankMessageKind::kPieces:
        number_ = message.pool;
        measurement_.emplace(decode_pieces_task(*message.content), threads_);
        break;
      case RankMessageKind::kEndPieces:
        if (!measurement_) break;  // it has ended by itself
        measurement_.reset();
        send(RankMessageKind::kPiecesDone, 0, {});
        break;
      case RankMessageKind::kEnd:
        pool_.reset();
        break;
      case RankMessageKind::kQuit:
        pool_.reset();
        measurement_.reset();
        quit_ = true;
        break;
      default:
        throw Error("rank 0 asked for what no rank does");
    }
  }

  void start(const RankPoolOptions& given) {
    WorkerPoolOptions options;
    options.jobs = static_cast<unsigned>(given.jobs);
    options.time_limit = std::chrono::milliseconds(given.milliseconds);
    options.memory_limit = given.memory;
    pool_.reset();  // first, so that never more than `jobs` run
    pool_ = std::make_unique<WorkerPool>(points_.points, points_.bound, options);
  }

  // Rank 0 sends nothing but kStop meanwhile.
  void decimate(const RankMessage& message) {
    TileTask task = decode_tile_task(*message.content);
    task.settings.threads = threads_;
    bool stopped = false;
    auto next = std::chrono::steady_clock::now();
    task.settings.interrupted = [&] {
      const auto now = std::chrono::steady_clock::now();
      if (stopped || now < next) return stopped;
      next = now + kBetweenLooks;
      const std::optional<RankLink::Received> received = link_.receive();
      stopped = received && received->message.kind == RankMessageKind::kStop;
      return stopped;
    };
    send(RankMessageKind::kDecimatedTile, message.ticket,
         encode(decimate_tile(task.tile, task.settings)));
  }

  // What waits to be sent is no more than a few pieces.
  void send_found() {
    constexpr std::size_t kMostUnsent = 4;
    if (link_.unsent() >= kMostUnsent) {
      std::this_thread::sleep_for(kBetweenLooks);
      return;
    }
    if (std::optional<Bytes> found = measurement_->wait_for(kBetweenLooks)) {
      send(RankMessageKind::kPieceFound, 0, std::move(*found));
    } else if (measurement_->is_done()) {
      send(RankMessageKind::kPiecesDone, 0, measurement_->parts());
      measurement_.reset();
    }
  }

  void answer(const Completed& completed) {
    if (const auto* made = std::get_if<ChainResult>(&completed.outcome)) {
      send(RankMessageKind::kMesh, completed.ticket, encode(MeshMessage{completed.ticket, *made}));
      return;
    }
    const auto& failure = std::get<Failure>(completed.outcome);
    Bytes content = {static_cast<std::uint8_t>(failure.reason)};
    content.insert(content.end(), failure.message.begin(), failure.message.end());
    send(RankMessageKind::kFailure, completed.ticket, std::move(content));
  }

  void send(RankMessageKind kind, std::uint64_t ticket, Bytes content) {
    link_.send(0, {kind, number_, ticket, std::make_shared<Bytes>(std::move(content))});
  }

  RankLink& link_;
  std::size_t threads_;
  PointsMessage points_;
  std::unique_ptr<WorkerPool> pool_;
  PartProcesses parts_{{}, 0};
  std::optional<RankMeasurement> measurement_;
  std::uint64_t number_ = 0;  // of the pool, or the measurement
  bool quit_ = false;
};

}  // namespace

void serve_rank(RankLink& link, std::size_t threads) { Server(link, threads).run(); }

}  // namespace emax
