#include "host/decimate/edge_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace emax {
namespace {

constexpr std::size_t kMostPlaces = 8;
constexpr double kCounts = 0.25;      // of the greatest squared distance
constexpr double kDeviation = 0.1;    // of the limit: a parabola is as good
constexpr double kFlat = 1e-3;        // a bend of the parabola that has no extremum to find
constexpr double kAtEnd = 0.15;       // places nearer to an end add nothing to the end itself
constexpr double kFarther = 1.02;     // times the ends' distances, where a stretch is looked into
constexpr double kLeastShare = 0.02;  // of a stretch, of its parts
constexpr int kMostHalvings = 5;
constexpr double kMostStretches = 16;  // at first, about one for each edge of the reference

class EdgeScan {
 public:
  EdgeScan(const BackBound& reference, const EdgeEnd& from, const EdgeEnd& to)
      : reference_(reference), from_(from), to_(to) {}

  std::vector<EdgePlace> run() {
    const EdgePlace extremum = parabola();
    if (is_parabola()) return {extremum};
    const double length = (to_.at - from_.at).norm();
    const auto stretches = static_cast<int>(
        std::clamp(std::round(length / reference_.mean_edge()), 2.0, kMostStretches));
    places_.push_back({0, from_.sight});
    for (int i = 1; i < stretches; ++i) {
      reach(look(static_cast<double>(i) / stretches, places_.back()), kMostHalvings);
    }
    reach({1, to_.sight}, kMostHalvings);
    std::vector<EdgePlace> farthest = local_maxima();
    if (farthest.empty()) farthest.push_back(extremum);
    return farthest;
  }

 private:
  Point at(double along) const { return (1 - along) * from_.at + along * to_.at; }

  EdgePlace look(double along, const EdgePlace& near) const {
    return {along, reference_.sight(at(along), near.sight.triangle)};
  }

  // The extremum of the parabola through the ends and the middle, or the middle.
  EdgePlace parabola() {
    const Point middle = at(0.5);
    EdgePlace place = look(0.5, {0, from_.sight});
    const bool seen = place.sight.triangle != kNoIndex && from_.sight.triangle != kNoIndex &&
                      to_.sight.triangle != kNoIndex;
    if (!seen) return place;
    const Point up = reference_.toward(middle, place.sight.triangle);
    middle_ = up.norm();
    if (!(middle_ > 0)) return place;
    first_ = reference_.toward(from_.at, from_.sight.triangle).dot(up) / middle_;
    second_ = reference_.toward(to_.at, to_.sight.triangle).dot(up) / middle_;
    near_ = place.sight.triangle;
    const double bend = first_ - 2 * middle_ + second_;
    if (!(std::abs(bend) > kFlat * middle_)) return place;
    const double along = 0.5 + 0.25 * (first_ - second_) / bend;
    return along > kAtEnd && along < 1 - kAtEnd ? look(along, place) : place;
  }

  // Whether the distances at the quarters are those of the parabola.
  bool is_parabola() const {
    if (near_ == kNoIndex) return false;
    return std::ranges::all_of(std::array{0.25, 0.75}, [&](double t) {
      const double expected =
          first_ * (1 - t) * (1 - 2 * t) + 4 * middle_ * t * (1 - t) + second_ * t * (2 * t - 1);
      const double found = std::sqrt(reference_.sight_from(at(t), near_).share);
      return std::abs(std::abs(expected) / reference_.limit() - found) <= kDeviation;
    });
  }

  // Adds the place, and before it those of the stretch from the last one that may be farther.
  void reach(const EdgePlace& next, int halvings) {
    const EdgePlace last = places_.back();
    const double along = halvings > 0 ? farthest_between(last, next) : 0;
    if (along > 0) {
      reach(look(along, last), halvings - 1);
      reach(next, halvings - 1);
    } else {
      places_.push_back(next);
    }
  }

  // Where the chords cross, if that is farther than both ends of the stretch; else 0.
  double farthest_between(const EdgePlace& a, const EdgePlace& b) const {
    const std::uint32_t of_a = a.sight.triangle, of_b = b.sight.triangle;
    if (of_a == of_b || of_a == kNoIndex || of_b == kNoIndex) return 0;
    const double at_a = std::sqrt(a.sight.share), at_b = std::sqrt(b.sight.share);
    const double rise = std::sqrt(reference_.share_of(at(b.along), of_a)) - at_a;
    const double fall = std::sqrt(reference_.share_of(at(a.along), of_b)) - at_b;
    const double part = (at_b + fall - at_a) / (rise + fall);
    const bool inside = part > kLeastShare && part < 1 - kLeastShare;
    if (!inside || !(at_a + part * rise > kFarther * std::max(at_a, at_b))) return 0;
    return a.along + part * (b.along - a.along);
  }

  std::vector<EdgePlace> local_maxima() const {
    double greatest = 0;
    for (const EdgePlace& p : places_) greatest = std::max(greatest, p.sight.share);
    std::vector<EdgePlace> maxima;
    for (std::size_t i = 1; i + 1 < places_.size(); ++i) {
      const double share = places_[i].sight.share;
      const bool least_before = places_[i - 1].sight.share <= share;
      if (share < kCounts * greatest || !least_before || places_[i + 1].sight.share >= share) {
        continue;
      }
      maxima.push_back(places_[i]);
    }
    if (maxima.size() > kMostPlaces) {
      std::ranges::stable_sort(maxima, std::greater<>{},
                               [](const EdgePlace& p) { return p.sight.share; });
      maxima.resize(kMostPlaces);
      std::ranges::sort(maxima, {}, &EdgePlace::along);
    }
    return maxima;
  }

  const BackBound& reference_;
  const EdgeEnd &from_, &to_;
  double first_ = 0, middle_ = 0, second_ = 0;  // signed distances at the ends and the middle
  std::uint32_t near_ = kNoIndex;               // the triangle nearest to the middle
  std::vector<EdgePlace> places_;
};

}  // namespace

std::vector<EdgePlace> farthest_places(const BackBound& reference, const EdgeEnd& from,
                                       const EdgeEnd& to) {
  return EdgeScan(reference, from, to).run();
}

}  // namespace emax
