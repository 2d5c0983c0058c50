#include "host/features/sample_consensus.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "host/features/connected_points.h"
#include "host/features/curved_fit.h"
#include "host/genocop/random_stream.h"

namespace emax {
namespace {

constexpr double kSmooth = 0.8;  // cosine of the normals of neighbours in a smooth part
constexpr int kSamples = 200, kAttempts = 2;
constexpr std::size_t kVoters = 256;        // of a part, for each sample
constexpr std::uint64_t kLongestWalk = 64;  // steps over neighbours between the points of a sample
constexpr std::size_t kFitted = 20'000;     // points that a fit uses at most
constexpr int kFits = 3;
constexpr double kLeastCurve = 0.5;  // radians by which the normals of a region differ at least
constexpr double kLeastRadius = 2;   // bands: within less, every point fits

class CurvedSearch {
 public:
  CurvedSearch(std::span<const Point> points, const Neighbourhoods& near,
               const FeatureOptions& options, std::span<const Region> planes)
      : points_(points), near_(near), options_(options), taken_(points.size()), connected_(near) {
    for (const Region& plane : planes) {
      if (plane.may_be_curved) continue;
      for (const std::uint32_t i : plane.points) taken_[i] = true;
    }
  }

  std::vector<Region> run() {
    std::vector<bool> in_part(points_.size());
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      if (in_part[i] || taken_[i]) continue;
      part_ = part_around(i, in_part);
      if (part_.size() < options_.least_support) continue;
      RandomStream random(options_.seed, i, RandomStream::Purpose::kConsensus);
      for (int attempt = 0; attempt < kAttempts && part_.size() >= options_.least_support;) {
        attempt = find_one(random) ? 0 : attempt + 1;
      }
    }
    return std::move(regions_);
  }

 private:
  std::vector<std::uint32_t> part_around(std::uint32_t first, std::vector<bool>& in_part) const {
    std::vector<std::uint32_t> part = {first};
    in_part[first] = true;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const Eigen::Vector3f& normal = near_.points[part[next]].normal;
      for (const std::uint32_t i : near_.of(part[next])) {
        if (in_part[i] || taken_[i]) continue;
        if (std::abs(near_.points[i].normal.dot(normal)) < kSmooth) continue;
        in_part[i] = true;
        part.push_back(i);
      }
    }
    return part;
  }

  template <class S>
  bool fits(const S& shape, std::uint32_t i) const {
    return std::abs(shape.signed_distance(points_[i])) <= options_.band &&
           near_.points[i].fits(shape.normal_at(points_[i]).template cast<float>());
  }

  std::uint32_t walk_from(std::uint32_t at, RandomStream& random) const {
    for (std::uint64_t steps = 1 + random.below(kLongestWalk); steps > 0; --steps) {
      const std::uint32_t next = near_.of(at)[random.below(near_.k)];
      if (!taken_[next]) at = next;
    }
    return at;
  }

  template <class S>
  struct Best {
    std::optional<S> shape;
    std::size_t votes = 0;
  };

  // True: a region was added, and part_ has lost its points.
  bool find_one(RandomStream& random) {
    options_.check();
    std::vector<std::uint32_t> voters;
    for (std::size_t v = 0; v < kVoters; ++v) voters.push_back(part_[random.below(part_.size())]);
    Best<Cylinder> cylinder;
    Best<Sphere> sphere;
    const auto try_shape = [&](const auto& shape, auto& best) {
      if (!shape || !(shape->radius > kLeastRadius * options_.band)) return;
      const auto votes = static_cast<std::size_t>(
          std::ranges::count_if(voters, [&](std::uint32_t i) { return fits(*shape, i); }));
      if (votes > best.votes) best = {shape, votes};
    };
    for (int sample = 0; sample < kSamples; ++sample) {
      const std::uint32_t a = part_[random.below(part_.size())], b = walk_from(a, random);
      const Point normal_a = near_.points[a].normal.cast<double>();
      const Point normal_b = near_.points[b].normal.cast<double>();
      try_shape(cylinder_through(points_[a], normal_a, points_[b], normal_b, options_.band),
                cylinder);
      try_shape(sphere_through(points_[a], normal_a, points_[b], normal_b, options_.band), sphere);
    }
    std::optional<Region> found = improved(cylinder.shape, fit_cylinder);
    std::optional<Region> other = improved(sphere.shape, fit_sphere);
    if (other && (!found || other->points.size() > found->points.size())) found = std::move(other);
    if (!found) return false;
    for (const std::uint32_t i : found->points) taken_[i] = true;
    std::erase_if(part_, [&](std::uint32_t i) { return taken_[i]; });
    regions_.push_back(std::move(*found));
    return true;
  }

  template <class S, class Fit>
  std::optional<Region> improved(std::optional<S> shape, const Fit& fit) {
    std::vector<std::uint32_t> members = part_;
    for (int i = 0; i < kFits && shape; ++i) {
      std::erase_if(members, [&](std::uint32_t m) { return !fits(*shape, m); });
      if (members.size() < options_.least_support / 2 || members.size() < 8) return std::nullopt;
      shape = fit(points_, some_of(members), *shape);
      if (i + 1 < kFits && shape) members = gathered(*shape, members);
    }
    if (!shape || shape->radius < kLeastRadius * options_.band) return std::nullopt;
    Region region{.shape = *shape, .points = gathered(*shape, members)};
    if (region.points.size() < options_.least_support) return std::nullopt;
    std::ranges::sort(region.points);
    measure(region, points_);
    if (region.rms > kGreatestRms * options_.band) return std::nullopt;
    if (curve(*shape, region.points) < kLeastCurve) return std::nullopt;
    return region;
  }

  // The greatest connected set of free points on the shape that has one of `seeds`.
  template <class S>
  std::vector<std::uint32_t> gathered(const S& shape, std::span<const std::uint32_t> seeds) {
    std::vector<std::uint32_t> set, most;
    std::vector<bool> in_set(points_.size());
    for (const std::uint32_t seed : seeds) {
      if (in_set[seed] || taken_[seed] || !fits(shape, seed)) continue;
      connected_.gather(
          seed, [&](std::uint32_t i) { return !taken_[i] && fits(shape, i); }, set);
      for (const std::uint32_t i : set) in_set[i] = true;
      if (set.size() > most.size()) most = set;
    }
    return most;
  }

  static std::vector<std::uint32_t> some_of(const std::vector<std::uint32_t>& members) {
    const std::size_t step = (members.size() + kFitted - 1) / kFitted;
    std::vector<std::uint32_t> some;
    for (std::size_t i = 0; i < members.size(); i += step) some.push_back(members[i]);
    return some;
  }

  // The angle that the region spans around the axis or the centre, seen from the axis in which the
  // points spread least: the whole turn without the widest gap.
  template <class S>
  double curve(const S& shape, std::span<const std::uint32_t> members) const {
    Point u, v;
    if constexpr (std::is_same_v<S, Cylinder>) {
      u = shape.axis.unitOrthogonal(), v = shape.axis.cross(u);
    } else {
      Point mean = Point::Zero();
      for (const std::uint32_t i : members) mean += shape.normal_at(points_[i]);
      double least = 1;
      for (const std::uint32_t i : members) {
        least = std::min(least, mean.normalized().dot(shape.normal_at(points_[i])));
      }
      return 2 * std::acos(std::clamp(least, -1.0, 1.0));
    }
    std::vector<double> angles;
    for (const std::uint32_t i : members) {
      const Point n = shape.normal_at(points_[i]);
      angles.push_back(std::atan2(v.dot(n), u.dot(n)));
    }
    std::ranges::sort(angles);
    double gap = angles.front() + 2 * std::numbers::pi - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) {
      gap = std::max(gap, angles[i] - angles[i - 1]);
    }
    return 2 * std::numbers::pi - gap;
  }

  std::span<const Point> points_;
  const Neighbourhoods& near_;
  FeatureOptions options_;
  std::vector<bool> taken_;  // by a plane for certain, or by a region
  ConnectedPoints connected_;
  std::vector<std::uint32_t> part_;
  std::vector<Region> regions_;
};

}  // namespace

std::vector<Region> find_curved(std::span<const Point> points, const Neighbourhoods& near,
                                const FeatureOptions& options, std::vector<Region>& planes) {
  std::vector<Region> curved = CurvedSearch(points, near, options, planes).run();
  std::vector<std::uint32_t> owner(points.size(), kNoRegion);
  for (std::uint32_t r = 0; r < curved.size(); ++r) {
    for (const std::uint32_t i : curved[r].points) owner[i] = r;
  }
  const auto gives_way = [&](const Region& plane) {
    if (!plane.may_be_curved) return false;
    std::vector<std::size_t> of(curved.size());
    for (const std::uint32_t i : plane.points) {
      if (owner[i] != kNoRegion) ++of[owner[i]];
    }
    const auto most = std::ranges::max_element(of);
    return most != of.end() && 2 * *most > plane.points.size() &&
           curved[static_cast<std::size_t>(most - of.begin())].points.size() > plane.points.size();
  };
  std::erase_if(planes, gives_way);
  std::vector<bool> of_plane(points.size());
  for (const Region& plane : planes) {
    for (const std::uint32_t i : plane.points) of_plane[i] = true;
  }
  for (Region& region : curved) {
    if (std::erase_if(region.points, [&](std::uint32_t i) { return of_plane[i]; }) > 0 &&
        !region.points.empty()) {
      measure(region, points);
    }
  }
  std::erase_if(curved, [&](const Region& r) { return r.points.size() < options.least_support; });
  return curved;
}

}  // namespace emax
