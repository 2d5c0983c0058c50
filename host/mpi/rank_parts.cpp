#include "host/mpi/rank_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "sw_model/base/error.h"

namespace emax {
namespace {

class RankParts {
 public:
  RankParts(RankLink& link, std::span<const unsigned> room, std::span<const std::string> hosts,
            const std::filesystem::path& folder, const WorkerPartsOptions& options, PartStep step)
      : link_(link),
        room_(room),
        hosts_(hosts),
        folder_(folder),
        interrupted_(options.interrupted),
        step_(step),
        away_(room.size()),
        own_(options.program, options.memory_limit) {}

  // MPI is spoken to by this thread alone.
  void run(std::span<const std::size_t> parts, const std::function<void()>& done) {
    std::size_t left = parts.size();
    while (left > 0) {
      if (interrupted_ && interrupted_()) throw Interrupted{};
      while (!parts.empty() && hand_out(parts.front())) parts = parts.subspan(1);
      std::size_t ended = own_.wait_for(kBetweenLooks).size();
      while (std::optional<RankLink::Received> received = link_.receive()) ended += take(*received);
      for (left -= ended; ended > 0; --ended) done();
    }
  }

 private:
  std::size_t under_way(std::size_t rank) const { return rank == 0 ? own_.running() : away_[rank]; }

  // To the rank with the most processors that are free; false where none is.
  bool hand_out(std::size_t part) {
    std::size_t best = 0;
    const auto free = [&](std::size_t rank) {
      return static_cast<std::ptrdiff_t>(room_[rank]) -
             static_cast<std::ptrdiff_t>(under_way(rank));
    };
    for (std::size_t rank = 1; rank < room_.size(); ++rank) {
      if (free(rank) > free(best)) best = rank;
    }
    if (free(best) <= 0) return false;
    if (best == 0) {
      own_.start(folder_, step_, part);
      return true;
    }
    const PartMessage message{folder_.string(), std::string(to_string(step_)), part};
    link_.send(static_cast<int>(best),
               {RankMessageKind::kPart, 0, part, std::make_shared<Bytes>(encode(message))});
    ++away_[best];
    return true;
  }

  // How many parts the message says are done.
  std::size_t take(const RankLink::Received& received) {
    const auto& [from, message] = received;
    const auto rank = static_cast<std::size_t>(from);
    if (message.kind == RankMessageKind::kUnusable) {
      throw Error(fmt::format(
          "rank {} on {}: {}; every rank needs the folder of the tiles under "
          "the same name",
          from, hosts_[rank], std::string(message.content->begin(), message.content->end())));
    }
    if (message.kind != RankMessageKind::kPartDone) return 0;
    --away_[rank];
    return 1;
  }

  RankLink& link_;
  const std::span<const unsigned> room_;
  const std::span<const std::string> hosts_;
  const std::filesystem::path& folder_;
  const std::function<bool()>& interrupted_;
  const PartStep step_;
  std::vector<std::size_t> away_;  // parts at each rank
  PartProcesses own_;
};

}  // namespace

RunParts rank_parts(RankLink& link, std::vector<unsigned> processors,
                    std::vector<std::string> hosts, const std::filesystem::path& folder,
                    const WorkerPartsOptions& options) {
  std::vector<unsigned> room = std::move(processors);
  if (options.jobs > 0) {
    for (unsigned& r : room) r = std::min(r, options.jobs);
  }
  // Other ranks may stand in another folder.
  return [&link, room = std::move(room), hosts = std::move(hosts),
          folder = std::filesystem::absolute(folder), options](
             PartStep step, std::span<const std::size_t> parts, const std::function<void()>& done) {
    RankParts(link, room, hosts, folder, options, step).run(parts, done);
  };
}

}  // namespace emax
