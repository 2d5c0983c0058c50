#include "host/mpi/rank_pool.h"

#include <fmt/format.h>

#include <cstring>
#include <string_view>
#include <thread>
#include <utility>

#include "host/mpi/rank_dispatch.h"
#include "sw_model/base/error.h"

namespace emax {
namespace {

using Clock = std::chrono::steady_clock;

std::span<const std::uint8_t> body(const Bytes& message) {
  if (message.size() < kLengthBytes) throw Error("a rank sent a message that is cut short");
  return std::span(message).subspan(kLengthBytes);
}

std::string_view text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Bytes encode(const RankPoolOptions& options) {
  Bytes bytes(sizeof options);
  std::memcpy(bytes.data(), &options, sizeof options);
  return bytes;
}

RankPoolOptions decode_rank_pool_options(std::span<const std::uint8_t> bytes) {
  RankPoolOptions options{};
  if (bytes.size() != sizeof options) throw Error("options of a pool are cut short");
  std::memcpy(&options, bytes.data(), sizeof options);
  return options;
}

class RankJob::Pool final : public EvaluationPool {
 public:
  Pool(RankJob& job, std::uint64_t number, std::vector<unsigned> workers,
       std::span<const Point> points, const DecimationBound& bound,
       const WorkerPoolOptions& options)
      : job_(job), number_(number), workers_(std::move(workers)), dispatch_(workers_) {
    const RankPoolOptions sent{0, static_cast<std::uint64_t>(options.time_limit.count()),
                               options.memory_limit};
    for (std::size_t rank = 1; rank < workers_.size(); ++rank) {
      RankPoolOptions its_own = sent;
      its_own.jobs = workers_[rank];
      if (workers_[rank] > 0) send(rank, RankMessageKind::kStart, 0, encode(its_own));
    }
    WorkerPoolOptions here = options;
    here.jobs = workers_.front();
    if (here.jobs > 0) here_ = std::make_unique<WorkerPool>(points, bound, here);
  }

  ~Pool() override {
    for (std::size_t rank = 1; rank < workers_.size(); ++rank) {
      if (workers_[rank] > 0) send(rank, RankMessageKind::kEnd, 0, {});
    }
  }

  void submit(RunMessage run) override {
    dispatch_.submit(std::move(run));
    go_on();
  }

  std::optional<Completed> wait_for(std::chrono::milliseconds duration) override {
    if (outstanding() == 0) throw Error("no evaluation is outstanding");
    const Clock::time_point end = Clock::now() + duration;
    do {
      go_on();
      if (std::optional<Completed> completed = completed_elsewhere()) return completed;
      if (std::optional<Completed> completed = completed_here()) return completed;
    } while (Clock::now() < end);
    return std::nullopt;
  }

  void go_on() override {
    while (std::optional<RankDispatch::Assignment> assignment = dispatch_.next()) {
      const auto& [rank, run] = *assignment;
      if (rank == 0) {
        here_->submit(run);
      } else {
        send(rank, RankMessageKind::kRun, run.ticket, encode(run));
      }
    }
  }

  void stop() override {
    dispatch_.drop_queued();
    if (here_) here_->stop();
    for (std::size_t rank = 1; rank < workers_.size(); ++rank) {
      if (dispatch_.is_busy(rank)) send(rank, RankMessageKind::kStop, 0, {});
    }
  }

  std::size_t outstanding() const override { return dispatch_.outstanding(); }

 private:
  void send(std::size_t rank, RankMessageKind kind, std::uint64_t ticket, Bytes content) {
    job_.link_.send(static_cast<int>(rank),
                    {kind, number_, ticket, std::make_shared<Bytes>(std::move(content))});
  }

  // Waits for one look.
  std::optional<Completed> completed_here() {
    if (!here_ || here_->outstanding() == 0) {
      std::this_thread::sleep_for(kBetweenLooks);
      return std::nullopt;
    }
    std::optional<Completed> completed = here_->wait_for(kBetweenLooks);
    if (completed) dispatch_.complete(0, completed->ticket);
    return completed;
  }

  std::optional<Completed> completed_elsewhere() {
    while (std::optional<RankLink::Received> received = job_.link_.receive()) {
      const auto& [from, message] = *received;
      if (message.pool != number_) continue;  // of an earlier pool, whose user did not wait
      const auto rank = static_cast<std::size_t>(from);
      const std::string name = fmt::format("rank {} on {}", from, job_.hosts_.at(rank));
      if (message.kind == RankMessageKind::kUnusable) {
        throw Error(fmt::format("{}: {}", name, text(*message.content)));
      }
      if (!dispatch_.complete(rank, message.ticket)) continue;
      return Completed{message.ticket, outcome(message, name)};
    }
    return std::nullopt;
  }

  static std::variant<ChainResult, Failure> outcome(const RankMessage& message,
                                                    const std::string& name) {
    const Bytes& content = *message.content;
    if (message.kind == RankMessageKind::kMesh) {
      return std::get<MeshMessage>(decode(body(content))).result;
    }
    if (message.kind != RankMessageKind::kFailure || content.empty()) {
      throw Error(name + " answered what no rank answers");
    }
    return Failure{static_cast<FailureReason>(content.front()),
                   std::string(text(std::span(content).subspan(1)))};
  }

  RankJob& job_;
  std::uint64_t number_;
  std::vector<unsigned> workers_;
  RankDispatch dispatch_;
  std::unique_ptr<WorkerPool> here_;
};

RankJob::~RankJob() {
  for (int rank = 1; rank < link_.size(); ++rank) link_.send(rank, {RankMessageKind::kQuit});
}

std::unique_ptr<EvaluationPool> RankJob::make_pool(std::span<const Point> points,
                                                   const DecimationBound& bound,
                                                   const WorkerPoolOptions& options) {
  std::vector<unsigned> workers = spread_workers(std::max(1u, options.jobs), processors_);
  send_points(encode(PointsMessage{{points.begin(), points.end()}, bound}), workers);
  return std::make_unique<Pool>(*this, ++pools_, std::move(workers), points, bound, options);
}

// A rank that has them already keeps them.
void RankJob::send_points(Bytes points, std::span<const unsigned> workers) {
  if (!points_ || *points_ != points) {
    points_ = std::make_shared<Bytes>(std::move(points));
    has_points_.assign(workers.size(), false);
  }
  for (std::size_t rank = 1; rank < workers.size(); ++rank) {
    if (workers[rank] == 0 || has_points_[rank]) continue;
    link_.send(static_cast<int>(rank), {RankMessageKind::kPoints, 0, 0, points_});
    has_points_[rank] = true;
  }
}

}  // namespace emax
