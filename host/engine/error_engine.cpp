#include "host/engine/error_engine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "host/engine/nearest_rank.h"
#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr std::size_t kSeedStride = 256;     // packets
constexpr std::size_t kMostRemembered = 16;  // packets
constexpr std::size_t kSupergroups = 32;     // supergroups
constexpr std::size_t kSeedPiece = 16;       // packets
constexpr std::uint32_t kNeverEnough = std::numeric_limits<std::uint32_t>::max();

}  // namespace

ErrorEngine::ErrorEngine(const PreparedCloud& cloud, EngineOptions options)
    : cloud_(cloud),
      options_(std::move(options)),
      target_(options_.target != nullptr ? *options_.target : engine_targets().front()) {
  if (options_.threads == 0) throw std::invalid_argument("an engine has at least one thread");
  forget();
}

void ErrorEngine::forget() {
  remembered_.clear();
  settled_.assign(cloud_.packets().packets.size(), {});
  mesh_ = nullptr;
  mesh_number_ = 1;  // no packet's record of settled points has this number
  carried_.clear();
}

void ErrorEngine::begin(const PreparedMesh& mesh) {
  if (mesh_ == mesh.leaves()) return;
  if (mesh_ != nullptr) carried_ = mesh_->carried_to(*mesh.leaves());
  mesh_ = mesh.leaves();
  ++mesh_number_;
}

SearchJob ErrorEngine::job(const PreparedMesh& mesh, RunningMaximum& worst, std::uint32_t enough,
                           std::vector<std::uint32_t>& raised) {
  return {cloud_.packets(),
          mesh.tree(),
          options_.strategy,
          worst,
          enough,
          raised,
          {settled_, mesh_number_, mesh_number_ - 1, carried_}};
}

void ErrorEngine::in_supergroups(
    const std::function<void(std::size_t, std::size_t, std::size_t)>& work) const {
  in_pieces(options_.threads, cloud_.packets().supergroups.size(), kSupergroups,
            [&](std::size_t thread, std::size_t first, std::size_t last) {
              if (thread == 0 && options_.interrupted && options_.interrupted())
                throw Interrupted{};
              const ScopedFlushMode flush;
              work(thread, first, last);
            });
}

// Remembers only the packet that holds the answer's point: it does not depend on the order of
// threads.
void ErrorEngine::remember(std::uint32_t point,
                           std::span<const std::vector<std::uint32_t>> raised) {
  for (const auto& packets : raised) {
    for (const std::uint32_t p : packets) {
      const auto& index = cloud_.packets().packets[p].index;
      if (std::find(index.begin(), index.end(), point) == index.end()) continue;
      std::erase(remembered_, p);
      remembered_.push_back(p);
      if (remembered_.size() > kMostRemembered) remembered_.erase(remembered_.begin());
      return;
    }
  }
}

EmaxResult ErrorEngine::e_max(const PreparedMesh& mesh) {
  begin(mesh);
  RunningMaximum worst;
  std::vector<std::vector<std::uint32_t>> raised(options_.threads);
  std::vector<std::uint32_t> seeds = remembered_;
  if (seeds.empty()) {
    for (std::size_t i = 0; i < cloud_.packets().packets.size(); i += kSeedStride) {
      seeds.push_back(static_cast<std::uint32_t>(i));
    }
  }
  in_pieces(options_.threads, seeds.size(), kSeedPiece,
            [&](std::size_t thread, std::size_t first, std::size_t last) {
              const ScopedFlushMode flush;
              target_.search_packets(job(mesh, worst, kNeverEnough, raised[thread]),
                                     std::span(seeds).subspan(first, last - first));
            });
  in_supergroups([&](std::size_t thread, std::size_t first, std::size_t last) {
    target_.search_supergroups(job(mesh, worst, kNeverEnough, raised[thread]), first, last);
  });
  raised.push_back(std::move(seeds));
  remember(worst.get().worst_point, raised);
  return worst.get();
}

// Each piece has its own maximum, and the first piece with a violation gives the answer, so the
// answer does not depend on the number of threads.
std::optional<EmaxResult> ErrorEngine::violation(const PreparedMesh& mesh,
                                                 std::uint32_t limit_bits) {
  begin(mesh);
  std::vector<std::uint32_t> raised;
  const auto violation_of = [&](const RunningMaximum& worst) {
    const EmaxResult r = worst.get();
    return r.squared_bits > limit_bits ? std::optional(r) : std::nullopt;
  };
  {
    RunningMaximum worst;
    worst.raise({limit_bits, 0});
    const ScopedFlushMode flush;
    target_.search_packets(job(mesh, worst, limit_bits, raised), remembered_);
    if (const auto found = violation_of(worst)) return found;
  }
  const std::size_t pieces =
      (cloud_.packets().supergroups.size() + kSupergroups - 1) / kSupergroups;
  std::vector<RunningMaximum> worst(pieces);
  std::atomic<std::size_t> first_found = pieces;
  std::vector<std::vector<std::uint32_t>> raised_by(options_.threads);
  in_supergroups([&](std::size_t thread, std::size_t first, std::size_t last) {
    const std::size_t piece = first / kSupergroups;
    if (piece > first_found) return;
    worst[piece].raise({limit_bits, 0});
    target_.search_supergroups(job(mesh, worst[piece], limit_bits, raised_by[thread]), first, last);
    if (!violation_of(worst[piece])) return;
    std::size_t now = first_found;
    while (piece < now && !first_found.compare_exchange_weak(now, piece)) {
    }
  });
  if (first_found == pieces) return std::nullopt;
  const EmaxResult found = worst[first_found].get();
  remember(found.worst_point, raised_by);
  return found;
}

std::vector<std::uint32_t> ErrorEngine::squared_distances(const PreparedMesh& mesh) {
  std::vector<std::uint32_t> squared_bits(cloud_.points().size(), kNothingMet);
  lower(mesh, squared_bits);
  return squared_bits;
}

void ErrorEngine::lower(const PreparedMesh& mesh, std::span<std::uint32_t> squared_bits) {
  RunningMaximum unused;
  std::vector<std::uint32_t> raised;
  in_supergroups([&](std::size_t, std::size_t first, std::size_t last) {
    target_.nearest(job(mesh, unused, kNeverEnough, raised), first, last, squared_bits);
  });
}

Quantile ErrorEngine::quantile(const PreparedMesh& mesh, double share) {
  if (!(share > 0 && share <= 1)) {
    throw std::invalid_argument("a share of points is above 0 and at most 1");
  }
  const std::vector<std::uint32_t> all = squared_distances(mesh);
  std::vector<std::uint32_t> ranked = all;
  const auto at =
      ranked.begin() + (static_cast<std::ptrdiff_t>(nearest_rank(share, all.size())) - 1);
  std::nth_element(ranked.begin(), at, ranked.end());
  Quantile quantile = {*at, {}};
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (all[i] > quantile.squared_bits) quantile.beyond.push_back(i);
  }
  return quantile;
}

}  // namespace emax
