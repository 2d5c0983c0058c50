#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace emax {

// What one evaluation may take in its worker before it is given up.
struct EvaluationLimits {
  std::chrono::milliseconds time;
  std::uint64_t memory;  // bytes of address space; 0 for none
};

// Time: ten minutes, and 2 ms a point where that is longer. Memory: 2 GiB and 8 KiB a point, but at
// most 7/8 of what there is. Both are several times what the slowest methods take, and neither
// depends on the number of workers, as results do not.
EvaluationLimits standard_limits(std::size_t points);

enum class SearchEffort { kQuick, kNormal, kDeep };

// What the candidates of a search differ in: in the surface, under a decimator that keeps the
// bound; in little but chance, where all are decimated from one reference; or also in whether they
// keep the bound at all, as with Schroeder's parameters, so that one evaluation is not enough.
enum class SearchSpace { kSurfaces, kOneReference, kDecimations };

// The reference surface of kFitMethod is first made of this many points where a cloud has more than
// half as many again.
inline constexpr std::size_t kReferencePoints = 160'000;
bool is_thinned(std::size_t points, std::size_t reference_points = kReferencePoints);
std::size_t points_of_reference(std::size_t points);

// How many of the best candidates are decimated deep in the end: 4, of large clouds 2, of more than
// six million points none, as they alone would take ten minutes. What that gains differs from one
// to the next.
std::size_t polished_candidates(std::size_t points);

// A deep decimation may take so many times as long as an evaluation.
inline constexpr int kDeepTimeLimit = 10;

// Whether a search from one reference spends its time on one deep decimation by all threads,
// instead of several normal ones before it: where the reference is made of thinned points, and so
// that more would take the better part of an hour.
bool decimates_deep_at_once(std::size_t points);

// How many evaluations a search makes unless it is told. `configured`: what a configuration says is
// normal. Without one, a search from one reference makes from 16 down to 2, so that with the deep
// decimations it takes about ten minutes on two cores, and one where decimates_deep_at_once(); the
// others make fewer for more than 100,000 points, down to a fifth.
std::uint64_t search_budget(SearchEffort effort, std::size_t points, SearchSpace space,
                            std::optional<std::uint64_t> configured);

// About how many seconds the evaluations and the deep decimations of so many meshes take on so many
// processors. It is only shown: meshes differ by a factor of two and more, and so do processors.
double expected_seconds(SearchSpace space, std::size_t points, std::uint64_t evaluations,
                        std::size_t polished, unsigned jobs);

// How many workers the memory holds, each with a quarter of its limit.
unsigned jobs_in_memory(const EvaluationLimits& limits);

// Bytes of memory that this process and its workers may use: the machine's, or a control group's
// limit where that is lower (`group_limit` is the file that holds it).
std::uint64_t usable_memory(const std::filesystem::path& group_limit = "/sys/fs/cgroup/memory.max");

}  // namespace emax
