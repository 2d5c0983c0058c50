#include "host/optimize/evaluation_limits.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>

namespace emax {
namespace {

constexpr std::chrono::milliseconds kLeastTime = std::chrono::minutes(10);
constexpr std::chrono::milliseconds kTimePerPoint{2};
constexpr std::uint64_t kLeastMemory = std::uint64_t{2} << 30;
constexpr std::uint64_t kMemoryPerPoint = 8192;

// Of each SearchSpace. From one reference, deep decimations gain more than evaluations do.
constexpr std::array<std::uint64_t, 3> kNormalBudget = {40, 16, 60}, kQuickBudget = {1, 1, 12};
constexpr std::uint64_t kDeepTimes = 4;
constexpr std::size_t kManyPoints = 100'000, kVeryManyPoints = 6'000'000;
constexpr std::uint64_t kLeastShare = 5;  // of the budget remains, one in so many
// With one reference: about the processor's seconds of a decimation for each point that the
// reference is made of and for each that is measured, of all decimations of a run, and how many of
// the normal ones a deep one takes.
constexpr double kSecondsPerPoint = 0.8e-3, kSecondsPerMeasured = 2e-5;
constexpr double kSeconds = 1200, kDeepDecimations = 1.6;
// Of the other spaces, for a point: of a reconstruction, and of an evaluation without bounds.
constexpr double kSurfaceSeconds = 1.5e-4, kChainSeconds = 1.5e-4;
constexpr std::size_t kManyPolished = 4, kFewPolished = 2;

double decimation_seconds(std::size_t points) {
  const std::size_t made_of = points_of_reference(points);
  return kSecondsPerPoint * static_cast<double>(made_of) +
         kSecondsPerMeasured * static_cast<double>(points - made_of);
}

std::uint64_t budget_from_one_reference(std::size_t points) {
  const auto most = static_cast<double>(kNormalBudget[1]);
  // Where nothing is decimated deep that time is saved.
  const double polishing =
      kDeepDecimations * static_cast<double>(std::max(polished_candidates(points), kFewPolished));
  const double decimations = kSeconds / decimation_seconds(std::max<std::size_t>(points, 1));
  return static_cast<std::uint64_t>(std::clamp(decimations - polishing, 2.0, most));
}

std::uint64_t memory_for_workers() {
  const std::uint64_t memory = usable_memory();
  return memory - memory / 8;
}

}  // namespace

bool is_thinned(std::size_t points, std::size_t reference_points) {
  return 2 * points > 3 * reference_points;
}

std::size_t points_of_reference(std::size_t points) {
  return is_thinned(points) ? kReferencePoints : points;
}

std::size_t polished_candidates(std::size_t points) {
  if (points > kVeryManyPoints) return 0;
  return points > kManyPoints ? kFewPolished : kManyPolished;
}

bool decimates_deep_at_once(std::size_t points) {
  return is_thinned(points) && points <= kVeryManyPoints;
}

std::uint64_t usable_memory(const std::filesystem::path& group_limit) {
  const auto machine = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                       static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  std::uint64_t group = 0;
  // The file says "max" where there is no limit.
  return std::ifstream(group_limit) >> group ? std::min(machine, group) : machine;
}

EvaluationLimits standard_limits(std::size_t points) {
  const auto time = std::max(kLeastTime, static_cast<std::int64_t>(points) * kTimePerPoint);
#ifdef EMAX_UNLIMITED_ADDRESS_SPACE
  return {time, 0};  // the sanitizer reserves terabytes that it never touches
#else
  return {time, std::min(kLeastMemory + points * kMemoryPerPoint, memory_for_workers())};
#endif
}

std::uint64_t search_budget(SearchEffort effort, std::size_t points, SearchSpace space,
                            std::optional<std::uint64_t> configured) {
  const auto which = static_cast<std::size_t>(space);
  if (effort == SearchEffort::kQuick) return kQuickBudget[which];
  std::uint64_t normal = kNormalBudget[which];
  if (space == SearchSpace::kOneReference) {
    const bool once = effort == SearchEffort::kNormal && decimates_deep_at_once(points);
    normal = once ? 1 : budget_from_one_reference(points);
  } else if (points > kManyPoints) {
    normal = std::max(normal / kLeastShare, normal * kManyPoints / points);
  }
  normal = configured.value_or(normal);
  return effort == SearchEffort::kDeep ? kDeepTimes * normal : normal;
}

double expected_seconds(SearchSpace space, std::size_t points, std::uint64_t evaluations,
                        std::size_t polished, unsigned jobs) {
  const auto rounds = [&](std::uint64_t runs) {
    const std::uint64_t filled = (runs + jobs - 1) / jobs;
    return static_cast<double>(filled);
  };
  const auto all = static_cast<double>(points);
  const double decimation = decimation_seconds(points);
  const double evaluation = space == SearchSpace::kOneReference ? decimation
                            : space == SearchSpace::kSurfaces   ? kSurfaceSeconds * all + decimation
                                                                : kChainSeconds * all;
  return rounds(evaluations) * evaluation + rounds(polished) * kDeepDecimations * decimation;
}

unsigned jobs_in_memory(const EvaluationLimits& limits) {
  if (limits.memory == 0) return std::numeric_limits<unsigned>::max();
  const std::uint64_t jobs = 4 * memory_for_workers() / limits.memory;
  return static_cast<unsigned>(std::clamp<std::uint64_t>(jobs, 1, 1u << 16));
}

}  // namespace emax
