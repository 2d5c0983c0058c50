#include "host/decimate/edge_samples.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/decimate/local_distance.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

constexpr double kNegligibleWeight = 1e-9;  // a weight relative to the greatest
constexpr std::size_t kMostKnown = 16;      // edges for each triangle, before all are forgotten

// The edges of triangles, each once and sorted, the lower vertex first.
void collect(const Triangle& t, std::vector<std::array<std::uint32_t, 2>>& edges) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
    edges.push_back({low, high});
  }
}

}  // namespace

const KnownEdges::Known* KnownEdges::find(const Map& map, std::uint64_t key, const Point& low,
                                          const Point& high) {
  const auto found = map.find(key);
  const bool there = found != map.end() && found->second.low == low && found->second.high == high;
  return there ? &found->second : nullptr;
}

void KnownEdges::keep(Map& fresh, const EditableMesh& mesh) {
  if (known_.size() > kMostKnown * mesh.triangles()) known_.clear();
  for (auto& [key, known] : fresh) {
    const auto low = static_cast<std::uint32_t>(key >> 32), high = static_cast<std::uint32_t>(key);
    const bool there = mesh.position(low) == known.low && mesh.position(high) == known.high;
    if (there) known_[key] = std::move(known);
  }
  fresh.clear();
}

void EdgeSamples::take(std::span<const std::uint32_t> removed, std::span<const Triangle> added,
                       std::uint32_t vertex, std::uint32_t other) {
  before_.clear();
  after_.clear();
  edges_before_.clear();
  edges_after_.clear();
  vertex_ = vertex;
  other_ = other;
  if (none()) return;
  for (const std::uint32_t slot : removed) collect(state_.mesh().triangle(slot), edges_before_);
  for (const Triangle& t : added) collect(t, edges_after_);
  sort_once(edges_before_);
  sort_once(edges_after_);
  for (const Edge& e : edges_before_) {
    if (!moves(e) && std::ranges::binary_search(edges_after_, e)) continue;
    for (const EdgePlace& at : places(e)) before_.push_back({e[0], e[1], at});
  }
}

// The places after the edit, which edits that are refused for their points never need.
std::vector<EdgeSamples::Sample>& EdgeSamples::after() {
  if (!after_.empty()) return after_;
  const auto was_there = [&](const Edge& e) {
    return std::ranges::binary_search(edges_before_, e);
  };
  for (const Edge& e : edges_after_) {
    if (moves(e)) {
      const std::uint32_t to = e[0] == vertex_ ? e[1] : e[0];
      const Edge others = {std::min(other_, to), std::max(other_, to)};
      add_moving(!was_there(e) && was_there(others) ? others : e, to);
    } else if (!was_there(e)) {
      for (const EdgePlace& at : places(e)) after_.push_back({e[0], e[1], at});
    }
  }
  return after_;
}

// The places of an edge that ends at `to` as places between the moving vertex and `to`.
void EdgeSamples::add_moving(const Edge& edge, std::uint32_t to) {
  for (EdgePlace at : places(edge)) {
    if (edge[0] == to) at.along = 1 - at.along;
    after_.push_back({kNoIndex, to, at});
  }
}

const std::vector<EdgePlace>& EdgeSamples::places(const Edge& edge) {
  return places_between(edge[0], {state_.mesh().position(edge[0]), state_.sight(edge[0])}, edge[1]);
}

// Of the edge that the first vertex has where it is, or is about to be.
const std::vector<EdgePlace>& EdgeSamples::places_between(std::uint32_t from, const EdgeEnd& at,
                                                          std::uint32_t to) {
  EdgeEnd low = at, high = {state_.mesh().position(to), state_.sight(to)};
  if (from > to) {
    std::swap(from, to);
    std::swap(low, high);
  }
  const std::uint64_t key = KnownEdges::key(from, to);
  const KnownEdges::Known* known = KnownEdges::find(fresh_, key, low.at, high.at);
  if (known == nullptr && known_ != nullptr) {
    known = KnownEdges::find(known_->all(), key, low.at, high.at);
  }
  if (known != nullptr) return known->places;
  if (fresh_.size() > kMostKnown * state_.mesh().triangles()) fresh_.clear();
  return (fresh_[key] = {low.at, high.at, farthest_places(*state_.back(), low, high)}).places;
}

bool EdgeSamples::permits(const Point& position, std::uint32_t vertex, double permitted) {
  for (const Sample& s : before_) permitted = std::max(permitted, s.at.sight.share);
  EdgeEnd at = {position, {}};
  if (vertex != kNoIndex) {
    at.sight = state_.back()->sight(position, state_.sight(vertex).triangle);
  }
  std::uint32_t last = kNoIndex;
  for (const Sample& s : after()) {
    if (s.from != kNoIndex) {
      if (s.at.sight.share > permitted) return false;
    } else if (std::exchange(last, s.to) != s.to) {
      for (const EdgePlace& p : places_between(vertex, at, s.to)) {
        if (p.sight.share > permitted) return false;
      }
    }
  }
  return true;
}

double EdgeSamples::worst_on(std::uint32_t a, std::uint32_t b) {
  const auto [low, high] = std::minmax(a, b);
  double worst = 0;
  for (const EdgePlace& at : places({low, high})) worst = std::max(worst, at.sight.share);
  return worst;
}

Point EdgeSamples::place(const Sample& s, const Point& moving) const {
  const Point& from = s.from == kNoIndex ? moving : state_.mesh().position(s.from);
  return (1 - s.at.along) * from + s.at.along * state_.mesh().position(s.to);
}

double EdgeSamples::energy_before(int power) const {
  double energy = 0;
  for (const Sample& s : before_) energy += power_of(s.at.sight.share, power);
  return energy;
}

EdgeSamples::Energy EdgeSamples::measure(const Point& position, int power) {
  Energy energy;
  for (Sample& s : after()) {
    s.at.sight = state_.back()->sight_from(place(s, position), s.at.sight.triangle);
    energy.sum += power_of(s.at.sight.share, power);
    energy.worst = std::max(energy.worst, s.at.sight.share);
  }
  return energy;
}

void EdgeSamples::add_to(Eigen::Matrix3d& matrix, Point& right, const Point& position, double worst,
                         int power) const {
  for (const Sample& s : after_) {
    if (s.from != kNoIndex || s.at.sight.triangle == kNoIndex || !(s.at.sight.share > 0)) continue;
    const double importance = power > 2 ? power_of(s.at.sight.share / worst, power - 2) : 1;
    if (importance < kNegligibleWeight) continue;
    const Point residual = state_.back()->toward(place(s, position), s.at.sight.triangle);
    const Point direction = residual.normalized();
    const double weight = 1 - s.at.along;  // of the moving vertex in the place
    matrix += importance * weight * weight * direction * direction.transpose();
    right += importance * weight * residual;
  }
}

}  // namespace emax
