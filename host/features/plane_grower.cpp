#include "host/features/plane_grower.h"

#include <algorithm>
#include <cmath>

#include "sw_model/base/deliberate_fault.h"

namespace emax {
namespace {

constexpr std::size_t kFirstRefit = 32;
constexpr double kRefitGrowth = 1.3;  // of the points between refits
constexpr int kRegrowths = 2;
// Growth ends where most of the points failed before: the same region would fail again.
constexpr std::size_t kEnoughToJudge = 64;
constexpr double kFailedShare = 0.9;
// A region must be wider than this many of the deviations across it, or it is a line.
constexpr double kLeastWidth = 2, kLeastDeviation = 1e-9;
constexpr double kGreatestTilt = 0.02;  // standard error of the normal, radians
constexpr double kErrors = 3;           // standard errors that a turning must exceed to be one
constexpr int kEdgeRounds = 2;

}  // namespace

PlaneGrower::PlaneGrower(std::span<const Point> points, const Neighbourhoods& near,
                         const FeatureOptions& options)
    : points_(points),
      near_(near),
      options_(options),
      owner_(points.size(), kNoRegion),
      failed_(points.size(), false),
      connected_(near) {}

bool PlaneGrower::fits(std::uint32_t point, const Plane& plane,
                       const Eigen::Vector3f& normal) const {
  return std::abs(plane.signed_distance(points_[point])) <= options_.band &&
         (near_.points[point].fits(normal) || EMAX_FAULT(kFitsEveryNormal));
}

// Members that fit and are connected to `first` by others that do.
void PlaneGrower::gather(const Plane& plane, std::uint32_t first) {
  const Eigen::Vector3f normal = plane.normal.cast<float>();
  connected_.gather(
      first, [&](std::uint32_t i) { return is_free(i) && fits(i, plane, normal); }, members_);
}

// A point that does not fit the plane of the moment may fit a later one, from another neighbour.
void PlaneGrower::gather_with_refits(std::uint32_t seed) {
  Plane plane = {near_.points[seed].normal.cast<double>(), 0};
  Point mean = points_[seed];
  for (const std::uint32_t i : near_.of(seed)) mean += points_[i];
  plane.offset = plane.normal.dot(mean) / static_cast<double>(near_.k + 1);
  Eigen::Vector3f normal = plane.normal.cast<float>();
  PlaneSums sums;
  sums.add(points_[seed]);
  std::size_t refit_at = kFirstRefit, failed = 0;
  const auto fails_again = [&] {
    return sums.count() >= kEnoughToJudge &&
           static_cast<double>(failed) > kFailedShare * static_cast<double>(sums.count());
  };
  connected_.gather(
      seed,
      [&](std::uint32_t i) {
        if (!is_free(i) || !fits(i, plane, normal) || fails_again()) return false;
        sums.add(points_[i]);
        failed += failed_[i];
        if (sums.count() >= refit_at) {
          plane = sums.plane();
          normal = plane.normal.cast<float>();
          refit_at = static_cast<std::size_t>(kRefitGrowth * static_cast<double>(sums.count()));
        }
        return true;
      },
      members_, true);
}

double PlaneGrower::rms_from(const Plane& plane) const {
  double squares = 0;
  for (const std::uint32_t i : members_) squares += std::pow(plane.signed_distance(points_[i]), 2);
  return std::sqrt(squares / static_cast<double>(members_.size()));
}

std::optional<Region> PlaneGrower::judged(const Plane& plane) const {
  if (members_.size() < options_.least_support) return std::nullopt;
  const FittedPlane fitted = fit_plane_robustly(points_, members_, plane);
  if (rms_from(fitted.plane) > kGreatestRms * options_.band) return std::nullopt;
  const double deviation = std::max(fitted.rms, kLeastDeviation * fitted.length);
  if (!(fitted.width > kLeastWidth * deviation)) return std::nullopt;
  const double tilt = deviation / (fitted.width * std::sqrt(static_cast<double>(members_.size())));
  if (tilt > kGreatestTilt) return std::nullopt;
  const Turning turns = turning(points_, members_, fitted);
  if (!EMAX_FAULT(kCurvedIsPlane) &&
      turns.angle - kErrors * turns.error > options_.greatest_turning)
    return std::nullopt;
  return Region{.shape = fitted.plane,
                .may_be_curved = turns.angle + kErrors * turns.error > options_.greatest_turning};
}

void PlaneGrower::fail(std::span<const std::uint32_t> members) {
  for (const std::uint32_t i : members) failed_[i] = true;
}

// Grows members_ anew on their plane. True: they are a region, which owns them.
bool PlaneGrower::settle(Plane plane) {
  const std::vector<std::uint32_t> grown = members_;
  for (int i = 0; i < kRegrowths && members_.size() >= options_.least_support; ++i) {
    plane = fit_plane_robustly(points_, members_, plane).plane;
    gather(plane, nearest_of_first(plane));
  }
  const std::optional<Region> region = judged(plane);
  if (!region) {
    fail(grown);
    fail(members_);
    return false;
  }
  for (const std::uint32_t i : members_) owner_[i] = static_cast<std::uint32_t>(regions_.size());
  regions_.push_back(*region);
  failed_[grown.front()] = true;  // it may not have grown again
  return true;
}

std::uint32_t PlaneGrower::nearest_of_first(const Plane& plane) const {
  const std::size_t first = std::min(members_.size(), kFirstRefit);
  return *std::min_element(members_.begin(), members_.begin() + static_cast<std::ptrdiff_t>(first),
                           [&](std::uint32_t a, std::uint32_t b) {
                             return std::abs(plane.signed_distance(points_[a])) <
                                    std::abs(plane.signed_distance(points_[b]));
                           });
}

bool PlaneGrower::grow_from(std::uint32_t seed) {
  gather_with_refits(seed);
  return settle(fit_plane(points_, members_).plane);
}

bool PlaneGrower::grow_on(const Plane& plane, std::uint32_t first) {
  gather(plane, first);
  return settle(plane);
}

void PlaneGrower::join_edges() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joining;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (!is_free(i)) continue;
    // Boyer and Moore's majority vote finds the only region that can have half of the neighbours.
    std::uint32_t most = kNoRegion;
    std::size_t votes = 0, count = 0;
    for (const std::uint32_t j : near_.of(i)) {
      if (votes == 0) most = owner_[j];
      votes = owner_[j] == most ? votes + 1 : votes - 1;
    }
    if (most == kNoRegion) continue;
    for (const std::uint32_t j : near_.of(i)) count += owner_[j] == most;
    if (2 * count >= near_.k && distance(regions_[most].shape, points_[i]) <= options_.band) {
      joining.emplace_back(i, most);
    }
  }
  for (const auto& [i, region] : joining) owner_[i] = region;
}

std::vector<Region> PlaneGrower::finished() && {
  for (int i = 0; i < kEdgeRounds; ++i) join_edges();
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (!is_free(i)) regions_[owner_[i]].points.push_back(i);
  }
  for (Region& region : regions_) measure(region, points_);
  return std::move(regions_);
}

}  // namespace emax
