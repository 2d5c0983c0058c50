#include "host/decimate/edge_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace emax {
namespace {

constexpr std::size_t kMostPlaces = 8;
constexpr double kCounts = 0.25;      // of the greatest squared distance, or of the limit squared
constexpr double kDeviation = 0.1;    // of the limit: a parabola is as good
constexpr double kSameSheet = 0.5;    // of the squared distance to the sheet that is followed
constexpr double kFlat = 1e-3;        // a bend of the parabola that has no extremum to find
constexpr double kAtEnd = 0.15;       // places nearer to an end add nothing to the end itself
constexpr double kFarther = 1.02;     // times the ends' distances, where a stretch is looked into
constexpr double kLeastShare = 0.02;  // of a stretch, of its parts
constexpr int kHalvings = 4, kMostHalvings = 5;  // of stretches: between crossings, and even ones
constexpr double kMostStretches = 16;  // at first, about one for each edge of the reference

class EdgeScan {
 public:
  EdgeScan(const BackBound& reference, const EdgeEnd& from, const EdgeEnd& to)
      : reference_(reference), from_(from), to_(to) {}

  std::vector<EdgePlace> run() {
    const EdgePlace extremum = parabola();
    if (is_parabola()) return {extremum};
    if (!scan_crossings()) scan_evenly();
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
    up_ = reference_.toward(middle, place.sight.triangle);
    middle_ = up_.norm();
    if (!(middle_ > 0)) return place;
    first_ = reference_.toward(from_.at, from_.sight.triangle).dot(up_) / middle_;
    second_ = reference_.toward(to_.at, to_.sight.triangle).dot(up_) / middle_;
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

  // The distance to the reference has its maxima about over the edges of the reference and between
  // its walls. Takes such places where it is a maximum, with their neighbours and what lies
  // between. Returns false where the reference under the edge is no single sheet or another one is
  // nearer.
  bool scan_crossings() {
    std::vector<BackBound::Crossing> crossings;
    if (near_ == kNoIndex || !reference_.follow(from_.at, to_.at, up_, near_, crossings)) {
      return false;
    }
    std::vector<EdgePlace> rough = {{0, from_.sight}};
    for (const BackBound::Crossing& c : crossings) {
      add_with_between(rough, nearer(c.along, c.before, c.behind));
    }
    add_with_between(rough, {1, to_.sight});
    std::vector<std::size_t> tops;
    for (std::size_t i = 1; i + 1 < rough.size(); ++i) {
      if (is_maximum(rough, i)) tops.push_back(i);
    }
    double greatest = 0;
    for (const std::size_t i : tops) {
      const double followed = rough[i].sight.share;
      rough[i] = look(rough[i].along, rough[i]);
      if (followed > kCounts && rough[i].sight.share < kSameSheet * followed) return false;
      greatest = std::max(greatest, rough[i].sight.share);
    }
    std::erase_if(tops, [&](std::size_t i) { return rough[i].sight.share < kCounts * greatest; });
    places_ = {rough.front()};
    std::size_t last = 0;  // of `rough`, in places_
    for (const std::size_t top : tops) {
      for (std::size_t i = std::max(last + 1, top - 1); i <= top + 1; ++i) {
        const bool known = i == top || i + 1 == rough.size();
        reach(known ? rough[i] : look(rough[i].along, rough[i]), i == last + 1 ? kHalvings : 0);
        last = i;
      }
    }
    if (last + 1 < rough.size()) places_.push_back(rough.back());
    return true;
  }

  // Of two triangles of the reference.
  EdgePlace nearer(double along, std::uint32_t a, std::uint32_t b) const {
    const double to_a = reference_.share_of(at(along), a), to_b = reference_.share_of(at(along), b);
    return {along, to_a <= to_b ? BackBound::Sight{a, to_a} : BackBound::Sight{b, to_b}};
  }

  // Adds the place, and before it the one between two walls of the reference.
  void add_with_between(std::vector<EdgePlace>& places, const EdgePlace& next) const {
    const EdgePlace last = places.back();
    const double along = farthest_between(last, next);
    if (along > 0) places.push_back(nearer(along, last.sight.triangle, next.sight.triangle));
    places.push_back(next);
  }

  void scan_evenly() {
    const double length = (to_.at - from_.at).norm();
    const auto stretches = static_cast<int>(
        std::clamp(std::round(length / reference_.mean_edge()), 2.0, kMostStretches));
    places_ = {{0, from_.sight}};
    for (int i = 1; i < stretches; ++i) {
      reach(look(static_cast<double>(i) / stretches, places_.back()), kMostHalvings);
    }
    reach({1, to_.sight}, kMostHalvings);
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

  static bool is_maximum(const std::vector<EdgePlace>& places, std::size_t i) {
    const double share = places[i].sight.share;
    return places[i - 1].sight.share <= share && places[i + 1].sight.share < share;
  }

  std::vector<EdgePlace> local_maxima() const {
    double greatest = 0;
    for (const EdgePlace& p : places_) greatest = std::max(greatest, p.sight.share);
    std::vector<EdgePlace> maxima;
    for (std::size_t i = 1; i + 1 < places_.size(); ++i) {
      if (places_[i].sight.share < kCounts * greatest || !is_maximum(places_, i)) continue;
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
  Point up_ = Point::Zero();                    // from the middle to the reference
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
