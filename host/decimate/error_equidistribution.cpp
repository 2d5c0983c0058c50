#include "host/decimate/error_equidistribution.h"

#include <algorithm>
#include <cmath>

namespace emax {
namespace {

constexpr double kLoosened = 2, kLessLoosened = 1.25;  // the limits, times
constexpr int kSureLastExchanges = 2;
// The number of triangles to aim at is the one with which this share of the triangles would be
// within the limit, if the error falls with the area. High powers that come later allow fewer.
constexpr double kQuantile = 0.9, kFewerLater = 0.93, kLastQuantile = 0.95;
constexpr double kCollapsed = 0.93, kLastCollapsed = 0.97;  // of these, before splits fill up
// The quantile may be that of triangles over gaps and folds, which no number brings within the
// limit. So it counts as at most so many times the median, and an exchange leaves at most so many
// times the triangles before.
constexpr double kMostOfMedian = 1.17, kMostAdded = 1.1;
constexpr double kEnough = 0.99;  // an exchange that would leave more than this share gains little
constexpr int kRings = 3;
constexpr double kManyBeyond = 0.05;  // share of the triangles: no fewer can be restored
constexpr double kFewBeyond = 0.02;   // share of the triangles that is left to exact restoration
constexpr int kRestorations = 15, kRepairs = 40;  // rounds at most
constexpr int kGuidedRepairs = 3;                 // with the guides alone
constexpr int kVainRepairs = 6;                   // in a row
// Repairs are given up too where so many rounds leave more than a share of what was beyond before
// them, and this is more than a share of the triangles: each of these rounds takes long, and in the
// end too many triangles would be left.
constexpr std::size_t kSlowRepairs = 8;
constexpr double kSlow = 0.8, kManyInRepair = 0.03;
constexpr double kFew = 100;           // triangles, which are never many
constexpr int kExactTries = 2;         // of the exact limits
constexpr int kFirstRestorations = 2;  // rounds without splits
constexpr double kStuckRadius = 1.5;   // times the longest edge of what is stuck
// What restoration leaves even has room for fewer: of a mesh within its limits, and at most so many
// times its triangles while the limits are restored again.
constexpr double kThinningQuantile = 0.97, kThinningCollapsed = 0.985, kMostWhileThinning = 1.05;
constexpr int kThinningRounds = 2, kLastThinningRounds = 3;
// Restoration is given up where more than this share of the triangles is beyond the limit, or where
// splitting all of these would leave more than a share of the triangles that were there at first.
constexpr double kTooManyBeyond = 0.35, kTooManyLeft = 1;

}  // namespace

bool ErrorEquidistribution::run() {
  const auto first = static_cast<double>(state_.mesh().triangles());
  passes_.use(LocalSearch::Steps::kNewton);
  state_.loosen(kLoosened, kLoosened);
  for (const int power : {4, 8, 16}) relax(power, 2);
  for (int i = 0; i < extent_.exchanges && !passes_.stopped(); ++i) {
    exchange(kQuantile, kFewerLater, kCollapsed, 8);
  }
  relax(32, extent_.rounds);
  exchange_at_last();
  state_.loosen(kLessLoosened, kLoosened);
  relax(64, extent_.last_rounds);
  if (lost(Race::At::kExchanged) || !restore(kTooManyLeft * first)) return false;
  for (int i = 0; i < extent_.thinnings && !lost(Race::At::kRestored) && thin(); ++i) {
  }
  return true;
}

// Exchanges triangles of a mesh within its limits once more. Returns false, and leaves the mesh as
// it was, where that leaves no fewer.
bool ErrorEquidistribution::thin() {
  const DecimationState::Snapshot before = state_.snapshot();
  const FeatureEdges features = passes_.features();
  const std::size_t triangles = state_.mesh().triangles();
  state_.loosen(kLoosened, kLoosened);
  exchange(kThinningQuantile, 1, kThinningCollapsed, 16);
  relax(32, kThinningRounds);
  state_.loosen(kLessLoosened, kLoosened);
  relax(64, kLastThinningRounds);
  const double most = kMostWhileThinning * static_cast<double>(triangles);
  if (restore(most) && state_.mesh().triangles() < triangles) return true;
  state_.restore(before);
  passes_.restart(features);
  passes_.use(LocalSearch::Steps::kNewton);
  return false;
}

void ErrorEquidistribution::relax(int power, int rounds) {
  for (int i = 0; i < rounds && !passes_.stopped(); ++i) {
    tell_("flips", passes_.flip(power));
    tell_("relocations", passes_.relocate(power));
  }
}

void ErrorEquidistribution::relax_around(const std::vector<std::uint32_t>& slots, int power) {
  tell_("relaxations", passes_.relax_around(slots, kRings, power));
}

// Takes triangles where they cost least energy and adds some where there is most.
void ErrorEquidistribution::exchange(double quantile, double share, double collapsed, int power) {
  const auto fit = static_cast<std::size_t>(share * static_cast<double>(fitting(quantile)));
  const auto most = kMostAdded * static_cast<double>(state_.mesh().triangles());
  const std::size_t target = std::min(fit, static_cast<std::size_t>(most));
  const auto fewer = static_cast<std::size_t>(collapsed * static_cast<double>(target));
  tell_("loose collapses", passes_.collapse_to(fewer, power));
  relax(8, 2);
  tell_("splits", passes_.split_to(target, power));
  relax(16, 2);
}

// Until there are as few triangles as can be restored.
void ErrorEquidistribution::exchange_at_last() {
  for (int i = 0; i < extent_.last_exchanges && !passes_.stopped(); ++i) {
    if (i >= kSureLastExchanges) {
      const auto triangles = static_cast<double>(state_.mesh().triangles());
      const auto beyond = static_cast<double>(beyond_limit().size());
      const bool gains = static_cast<double>(fitting(kLastQuantile)) < kEnough * triangles;
      if (!gains || beyond > kManyBeyond * triangles) break;
    }
    exchange(kLastQuantile, 1, kLastCollapsed, 16);
    relax(32, extent_.rounds);
  }
}

// The number of triangles with which a share of them would be within the limit.
std::size_t ErrorEquidistribution::fitting(double quantile) {
  std::vector<double> worst = passes_.worst_of(passes_.free_slots());
  const std::size_t fixed = state_.mesh().triangles() - worst.size();
  if (worst.empty()) return fixed;
  const auto distance = [&](double share) {
    const auto last = static_cast<double>(worst.size() - 1);
    const auto at = worst.begin() + static_cast<std::ptrdiff_t>(share * last);
    std::ranges::nth_element(worst, at);
    return std::sqrt(*at);
  };
  const double aimed = std::min(distance(quantile), kMostOfMedian * distance(0.5));
  return fixed + static_cast<std::size_t>(aimed * static_cast<double>(worst.size()));
}

// Of the limits as they are in the end, worst first.
std::vector<std::uint32_t> ErrorEquidistribution::beyond_limit() {
  state_.reassign();
  state_.test_back_bound();
  return passes_.beyond_limit();
}

// Loosely, then exactly. What is then left in a shape in which no edit is permitted is given
// another one under loosened limits. Returns false where it is given up.
bool ErrorEquidistribution::restore(double most) {
  for (int i = 0; i < kExactTries && !passes_.stopped(); ++i) {
    if (i > 0) state_.loosen(kLessLoosened, kLoosened);
    if (!restore_loosely(most, i == 0 ? kFewBeyond : 0)) return false;
    if (restore_exactly()) return true;
    if (are_many(static_cast<double>(still_beyond().size()), kManyInRepair)) return false;
  }
  return false;
}

// Relaxing around what is beyond the limit restores most. Then a third of it is split at a time,
// until at most a share `few` of the triangles is beyond. Returns false where it is given up: where
// more than `most` triangles would be left, or many are beyond after all rounds.
bool ErrorEquidistribution::restore_loosely(double most, double few) {
  for (int i = 0; !passes_.stopped(); ++i) {
    std::vector<std::uint32_t> worst = beyond_limit();
    const auto triangles = static_cast<double>(state_.mesh().triangles());
    const auto beyond = static_cast<double>(worst.size());
    if (i == kRestorations) return !are_many(beyond, kManyBeyond);
    if (beyond > kTooManyBeyond * triangles) return false;
    if (triangles + beyond > most) return false;
    if (worst.empty() || beyond < few * triangles) break;
    if (i >= kFirstRestorations) {
      worst.resize((worst.size() + 2) / 3);
      tell_("splits", passes_.split_at_worst(worst, 16));
    }
    for (const int power : {16, 16, 32, 32}) relax_around(passes_.beyond_limit(), power);
  }
  return true;
}

// First with the points that guide alone: few of the others are then beyond, and they guide from
// then on. In the end with all points. Returns whether every limit holds.
bool ErrorEquidistribution::restore_exactly() {
  state_.tighten();
  for (int i = 0; i < kGuidedRepairs && !passes_.stopped(); ++i) {
    if (i > 0) state_.detach_others();
    repair();
    if (passes_.stopped() || state_.attach_others() == 0) break;
    if (i + 1 == kGuidedRepairs) repair();
  }
  if (passes_.stopped()) return false;
  if (state_.keep_limits()) return true;
  note_stuck(still_beyond());
  return false;
}

void ErrorEquidistribution::repair() {
  std::vector<std::size_t> fewest;  // beyond, after each round
  int vain = 0;
  for (int i = 0; i < kRepairs && !passes_.stopped(); ++i) {
    state_.prove_all();
    state_.add_witnesses();
    const std::vector<std::uint32_t> beyond = still_beyond();
    vain = fewest.empty() || beyond.size() < fewest.back() ? 0 : vain + 1;
    fewest.push_back(fewest.empty() ? beyond.size() : std::min(fewest.back(), beyond.size()));
    if (beyond.empty() || vain == kVainRepairs || is_slow(fewest)) break;
    // Relaxations alone every other time. What several splits did not restore has mostly a shape in
    // which nothing can move, and is taken away.
    if (i % 2 == 1) tell_("splits", passes_.split_at_worst(beyond, 16));
    if (i % 4 == 2 && i > 2) tell_("collapses", passes_.collapse_at(beyond));
    for (const int power : {32, 32, 16}) relax_around(beyond, power);
  }
}

bool ErrorEquidistribution::are_many(double beyond, double share) const {
  return beyond > std::max(kFew, share * static_cast<double>(state_.mesh().triangles()));
}

bool ErrorEquidistribution::is_slow(const std::vector<std::size_t>& fewest) const {
  if (fewest.size() <= kSlowRepairs) return false;
  const auto now = static_cast<double>(fewest.back());
  const auto before = static_cast<double>(fewest[fewest.size() - 1 - kSlowRepairs]);
  return now > kSlow * before && are_many(now, kManyInRepair);
}

// The triangles beyond the exact limits, and those around what is not proven of the reference.
std::vector<std::uint32_t> ErrorEquidistribution::still_beyond() {
  std::vector<std::uint32_t> beyond = passes_.beyond_limit();
  const std::vector<std::uint32_t> around = state_.around_unproven();
  beyond.insert(beyond.end(), around.begin(), around.end());
  return beyond;
}

void ErrorEquidistribution::note_stuck(const std::vector<std::uint32_t>& slots) {
  stuck_.clear();
  for (const std::uint32_t slot : slots) {
    const auto [a, b, c] = state_.mesh().corners(slot);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    stuck_.push_back({(a + b + c) / 3, kStuckRadius * longest});
  }
}

}  // namespace emax
