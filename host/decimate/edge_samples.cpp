#include "host/decimate/edge_samples.h"

#include <algorithm>
#include <cmath>

#include "host/decimate/local_distance.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

constexpr double kNegligible = 1e-9;    // a weight relative to the greatest
constexpr double kDeviation = 0.1;      // of the limit: a parabola is as good
constexpr std::size_t kMostKnown = 16;  // edges for each triangle, before all are forgotten

// The edges of triangles, each once and sorted, the lower vertex first.
void collect(const Triangle& t, std::vector<std::array<std::uint32_t, 2>>& edges) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
    edges.push_back({low, high});
  }
}

}  // namespace

void EdgeSamples::take(std::span<const std::uint32_t> removed, std::span<const Triangle> added,
                       std::uint32_t vertex, std::uint32_t other) {
  before_.clear();
  after_.clear();
  if (none()) return;
  if (known_.size() > kMostKnown * state_.mesh().triangles()) known_.clear();
  edges_before_.clear();
  edges_after_.clear();
  for (const std::uint32_t slot : removed) collect(state_.mesh().triangle(slot), edges_before_);
  for (const Triangle& t : added) collect(t, edges_after_);
  sort_once(edges_before_);
  sort_once(edges_after_);
  const auto moves = [&](const Edge& e) { return e[0] == vertex || e[1] == vertex; };
  const auto was_there = [&](const Edge& e) {
    return std::ranges::binary_search(edges_before_, e);
  };
  for (const Edge& e : edges_before_) {
    if (!moves(e) && std::ranges::binary_search(edges_after_, e)) continue;
    for (const Place& at : places(e)) before_.push_back({e[0], e[1], at});
  }
  for (const Edge& e : edges_after_) {
    if (moves(e)) {
      const std::uint32_t to = e[0] == vertex ? e[1] : e[0];
      const Edge others = {std::min(other, to), std::max(other, to)};
      add_moving(!was_there(e) && was_there(others) ? others : e, to);
    } else if (!was_there(e)) {
      for (const Place& at : places(e)) after_.push_back({e[0], e[1], at});
    }
  }
}

// The places of an edge that ends at `to` as places between the moving vertex and `to`.
void EdgeSamples::add_moving(const Edge& edge, std::uint32_t to) {
  for (Place at : places(edge)) {
    if (edge[0] == to) at.along = 1 - at.along;
    after_.push_back({kNoIndex, to, at});
  }
}

const std::vector<EdgeSamples::Place>& EdgeSamples::places(const Edge& edge) {
  const Point& low = state_.mesh().position(edge[0]);
  const Point& high = state_.mesh().position(edge[1]);
  Known& known = known_[std::uint64_t{edge[0]} << 32 | edge[1]];
  if (known.places.empty() || known.low != low || known.high != high) {
    known.low = low;
    known.high = high;
    known.places.clear();
    find_places(edge[0], edge[1], known.places);
  }
  return known.places;
}

void EdgeSamples::find_places(std::uint32_t from, std::uint32_t to,
                              std::vector<Place>& places) const {
  const EditableMesh& mesh = state_.mesh();
  const Point &a = mesh.position(from), &b = mesh.position(to);
  const double fitting = std::round(0.5 * (b - a).norm() / state_.back()->mean_edge());
  const int count = static_cast<int>(std::clamp(fitting, 1.0, static_cast<double>(most_)));
  const DecimationState::EdgeProfile profile = state_.profile_of(from, to);
  const auto add = [&](double along, std::uint32_t near) {
    places.push_back({along, state_.back()->sight((1 - along) * a + along * b, near)});
  };
  if (count == 1 || is_parabola(from, to, profile)) {
    add(profile.farthest, profile.sight.triangle);
    return;
  }
  add(0.5 / count, state_.sight(from).triangle);
  for (int i = 1; i < count; ++i) add((i + 0.5) / count, places.back().sight.triangle);
}

// Whether the distances at the quarters are those of the parabola through ends and middle.
bool EdgeSamples::is_parabola(std::uint32_t from, std::uint32_t to,
                              const DecimationState::EdgeProfile& profile) const {
  const EditableMesh& mesh = state_.mesh();
  for (const double t : {0.25, 0.75}) {
    const Point at = (1 - t) * mesh.position(from) + t * mesh.position(to);
    const double expected = profile.first * (1 - t) * (1 - 2 * t) +
                            4 * profile.middle * t * (1 - t) + profile.second * t * (2 * t - 1);
    const double found = std::sqrt(state_.back()->sight_from(at, profile.sight.triangle).share);
    if (!(std::abs(std::abs(expected) / state_.back()->limit() - found) <= kDeviation))
      return false;
  }
  return true;
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
  for (Sample& s : after_) {
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
    if (importance < kNegligible) continue;
    const Point residual = state_.back()->toward(place(s, position), s.at.sight.triangle);
    const Point direction = residual.normalized();
    const double weight = 1 - s.at.along;  // of the moving vertex in the place
    matrix += importance * weight * weight * direction * direction.transpose();
    right += importance * weight * residual;
  }
}

}  // namespace emax
