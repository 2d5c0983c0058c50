#include "host/decimate/edge_samples.h"

#include <algorithm>
#include <cmath>

#include "host/decimate/local_distance.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

constexpr double kNegligible = 1e-9;  // a weight relative to the greatest
constexpr double kDeviation = 0.1;    // of the limit: a parabola is as good

// The edges of triangles, each once and sorted, the lower vertex first.
void collect(const Triangle& t, std::vector<std::array<std::uint32_t, 2>>& edges) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
    edges.push_back({low, high});
  }
}

}  // namespace

void EdgeSamples::take(std::span<const std::uint32_t> removed, std::span<const Triangle> added,
                       std::uint32_t vertex) {
  before_.clear();
  after_.clear();
  if (none()) return;
  edges_before_.clear();
  edges_after_.clear();
  for (const std::uint32_t slot : removed) collect(state_.mesh().triangle(slot), edges_before_);
  for (const Triangle& t : added) collect(t, edges_after_);
  sort_once(edges_before_);
  sort_once(edges_after_);
  const auto moves = [&](const Edge& e) { return e[0] == vertex || e[1] == vertex; };
  for (const Edge& e : edges_before_) {
    if (moves(e) || !std::ranges::binary_search(edges_after_, e)) sample(e[0], e[1], before_);
  }
  for (const Edge& e : edges_after_) {
    if (moves(e)) {
      const std::size_t first = after_.size();
      sample(vertex, e[0] == vertex ? e[1] : e[0], after_);
      for (std::size_t i = first; i < after_.size(); ++i) after_[i].from = kNoIndex;
    } else if (!std::ranges::binary_search(edges_before_, e)) {
      sample(e[0], e[1], after_);
    }
  }
}

void EdgeSamples::sample(std::uint32_t from, std::uint32_t to, std::vector<Sample>& samples) const {
  const EditableMesh& mesh = state_.mesh();
  const double length = (mesh.position(to) - mesh.position(from)).norm();
  const double fitting = std::round(0.5 * length / state_.back()->mean_edge());
  const int count = static_cast<int>(std::clamp(fitting, 1.0, static_cast<double>(most_)));
  const DecimationState::EdgeProfile profile = state_.profile_of(from, to);
  if (count == 1 || is_parabola(from, to, profile)) {
    samples.push_back({from, to, profile.farthest, {}});
    Sample& s = samples.back();
    s.sight = state_.back()->sight(place(s, mesh.position(from)), profile.sight.triangle);
    return;
  }
  std::uint32_t near = state_.sight(from).triangle;
  for (int i = 0; i < count; ++i) {
    samples.push_back({from, to, (i + 0.5) / count, {}});
    Sample& s = samples.back();
    s.sight = state_.back()->sight(place(s, mesh.position(from)), near);
    near = s.sight.triangle;
  }
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
  return (1 - s.along) * from + s.along * state_.mesh().position(s.to);
}

double EdgeSamples::energy_before(int power) const {
  double energy = 0;
  for (const Sample& s : before_) energy += power_of(s.sight.share, power);
  return energy;
}

EdgeSamples::Energy EdgeSamples::measure(const Point& position, int power) {
  Energy energy;
  for (Sample& s : after_) {
    s.sight = state_.back()->sight_from(place(s, position), s.sight.triangle);
    energy.sum += power_of(s.sight.share, power);
    energy.worst = std::max(energy.worst, s.sight.share);
  }
  return energy;
}

void EdgeSamples::add_to(Eigen::Matrix3d& matrix, Point& right, const Point& position, double worst,
                         int power) const {
  for (const Sample& s : after_) {
    if (s.from != kNoIndex || s.sight.triangle == kNoIndex || !(s.sight.share > 0)) continue;
    const double importance = power > 2 ? power_of(s.sight.share / worst, power - 2) : 1;
    if (importance < kNegligible) continue;
    const Point residual = state_.back()->toward(place(s, position), s.sight.triangle);
    const Point direction = residual.normalized();
    const double weight = 1 - s.along;  // of the moving vertex in the place
    matrix += importance * weight * weight * direction * direction.transpose();
    right += importance * weight * residual;
  }
}

}  // namespace emax
