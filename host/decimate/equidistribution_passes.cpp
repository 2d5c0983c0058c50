// The passes of DecimationPasses that spread the error evenly.
#include <Eigen/Geometry>
#include <algorithm>

#include "host/decimate/decimation_passes.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

// Collapses for each one wanted that are fitted: a rough estimate is enough to leave out the rest.
constexpr std::size_t kJudged = 8;

// The triangles, with the greatest value first; of equal ones the lower slot.
std::vector<std::uint32_t> worst_first(std::vector<std::pair<double, std::uint32_t>> found) {
  std::ranges::sort(found, [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  std::vector<std::uint32_t> slots;
  for (const auto& [value, slot] : found) slots.push_back(slot);
  return slots;
}

}  // namespace

std::vector<double> DecimationPasses::worst_of(const std::vector<std::uint32_t>& slots) {
  std::vector<double> worst(slots.size(), 0);
  propose_each(slots.size(), {}, [&](EditProposer& proposer, std::size_t i) {
    worst[i] = proposer.search().worst_of(slots[i]);
    return false;
  });
  return worst;
}

double DecimationPasses::energy_of(std::uint32_t slot, double worst, int power) const {
  double energy = power_of(worst, power);
  state_.assigned().for_each(slot, [&](std::uint32_t p) {
    energy += power_of(state_.assigned().squared_distance(p) / state_.squared_limit(), power);
  });
  return energy;
}

std::vector<std::uint32_t> DecimationPasses::beyond_limit() {
  std::vector<std::uint32_t> slots = state_.mesh().alive_slots();
  std::erase_if(slots, [&](std::uint32_t slot) {
    bool beyond = state_.breaks_back_bound(slot);
    state_.assigned().for_each(slot, [&](std::uint32_t p) {
      beyond = beyond || state_.assigned().squared_distance(p) > state_.squared_limit();
    });
    return !beyond;
  });
  const std::vector<double> worst = worst_of(slots);
  std::vector<std::pair<double, std::uint32_t>> found;
  for (std::size_t i = 0; i < slots.size(); ++i) found.emplace_back(worst[i], slots[i]);
  return worst_first(std::move(found));
}

bool DecimationPasses::untouched(std::uint32_t slot) const {
  return state_.mesh().alive(slot) &&
         std::ranges::all_of(state_.mesh().triangle(slot), [&](std::uint32_t v) {
           return v >= touched_.size() || touched_[v] == 0;
         });
}

void DecimationPasses::touch_around(std::uint32_t vertex) {
  touched_.resize(std::max(touched_.size(), state_.mesh().vertex_slots()), 0);
  state_.mesh().neighbours(vertex, around_);
  for (const std::uint32_t v : around_) touched_[v] = 1;
  touched_[vertex] = 1;
}

// At most so many edges, whose collapses into the optimum of the planes' quadrics add least energy.
std::vector<DecimationPasses::Edge> DecimationPasses::cheapest_collapses(std::size_t most,
                                                                         int power) {
  std::vector<Collapse> rated = judge_each(
      edges(), {{0, 0.5}}, [power](EditProposer& proposer, const Edge& e, Collapse& collapse) {
        return proposer.rate(e[0], e[1], power, collapse);
      });
  std::ranges::sort(rated, Collapse::costs_less);
  if (rated.size() > most) rated.resize(most);
  std::vector<Edge> cheapest;
  for (const Collapse& c : rated) cheapest.push_back({c.a, c.b});
  return cheapest;
}

std::size_t DecimationPasses::collapse_to(std::size_t target, int power) {
  const EditableMesh& mesh = state_.mesh();
  std::size_t collapses = 0;
  for (bool any = true; any && mesh.triangles() > target && !stopped_;) {
    const std::size_t wanted = (mesh.triangles() - target + 1) / 2;
    const std::vector<Edge> cheapest = cheapest_collapses(kJudged * (wanted + 1), power);
    std::vector<Collapse> candidates = judge_each(cheapest, {{0.5, 1}}, power);
    std::ranges::sort(candidates, Collapse::costs_less);
    touched_.assign(mesh.vertex_slots(), 0);
    any = false;
    for (const Collapse& candidate : candidates) {
      if (mesh.triangles() <= target || stopped_) break;
      if (touched_[candidate.a] != 0 || touched_[candidate.b] != 0) continue;
      if (!apply_collapse(candidate)) continue;
      touch_around(candidate.a);
      ++collapses;
      any = true;
    }
  }
  return collapses;
}

// A vertex that no triangle has yet.
std::uint32_t DecimationPasses::spare_vertex(const Point& at, std::uint32_t near) {
  if (spare_ == kNoIndex) spare_ = state_.add_vertex(at);
  state_.place_vertex(spare_, at, near);
  return spare_;
}

bool DecimationPasses::try_split(std::uint32_t a, std::uint32_t b, int power) {
  if (!proposers_.front().may_split(a, b)) return false;
  const Point middle = 0.5 * (state_.mesh().position(a) + state_.mesh().position(b));
  if (!search_.prepare_split(a, b, spare_vertex(middle, a))) return false;
  LocalSearch::Options options;
  options.power = power;
  Fit fit;
  return search_.fit(middle, options, fit) && search_.finish(fit, false, edit_) &&
         state_.permits(edit_);
}

// Leaves the split of the side at which it lowers the energy most as the prepared edit.
bool DecimationPasses::try_best_split(std::uint32_t slot, int power) {
  const Triangle t = state_.mesh().triangle(slot);
  double most = 0;
  std::size_t side = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    Fit fit;
    if (!try_split(t[i], t[(i + 1) % 3], power)) continue;
    if (!search_.evaluate(edit_.position, power, fit)) continue;
    const double gained = search_.energy_before(power) - fit.energy;
    if (side < 3 && gained <= most) continue;
    most = gained;
    side = i;
  }
  return side < 3 && try_split(t[side], t[(side + 1) % 3], power);
}

void DecimationPasses::make_split() {
  state_.apply(edit_);
  touch_around(spare_);
  spare_ = kNoIndex;
}

std::size_t DecimationPasses::split(const std::vector<std::uint32_t>& slots, int power,
                                    std::size_t most) {
  touched_.assign(state_.mesh().vertex_slots(), 0);
  std::size_t splits = 0;
  for (const std::uint32_t slot : slots) {
    if (splits == most || poll(splits, slots.size())) break;
    if (!untouched(slot) || !try_best_split(slot, power)) continue;
    make_split();
    ++splits;
  }
  return splits;
}

std::size_t DecimationPasses::split_to(std::size_t target, int power) {
  const EditableMesh& mesh = state_.mesh();
  std::size_t splits = 0;
  while (mesh.triangles() < target && !stopped_) {
    const std::vector<std::uint32_t> slots = mesh.alive_slots();
    const std::vector<double> worst = worst_of(slots);
    std::vector<std::pair<double, std::uint32_t>> energies;
    for (std::size_t i = 0; i < slots.size(); ++i) {
      energies.emplace_back(energy_of(slots[i], worst[i], power), slots[i]);
    }
    const std::size_t made =
        split(worst_first(std::move(energies)), power, (target - mesh.triangles() + 1) / 2);
    if (made == 0) break;
    splits += made;
  }
  return splits;
}

// Of the triangle's points, and of places on a grid in it.
DecimationPasses::Witness DecimationPasses::worst_place(std::uint32_t slot) const {
  constexpr int kSteps = 16;
  const std::array<Point, 3> c = state_.mesh().corners(slot);
  Witness worst;
  if (state_.back() != nullptr) {
    std::uint32_t near = state_.sight(state_.mesh().triangle(slot)[0]).triangle;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
        const Point p = c[0] + v * (c[1] - c[0]) + u * (c[2] - c[0]);
        const BackBound::Sight sight = state_.back()->sight(p, near);
        near = sight.triangle;
        if (near == kNoIndex || sight.share <= worst.share) continue;
        worst = {{1 - u - v, v, u}, p + state_.back()->toward(p, near), sight.share};
      }
    }
  }
  const Point normal = (c[1] - c[0]).cross(c[2] - c[0]);
  state_.assigned().for_each(slot, [&](std::uint32_t id) {
    const double share = state_.assigned().squared_distance(id) / state_.squared_limit();
    if (share <= worst.share) return;
    const Point& p = state_.point(id);
    const double v = (p - c[0]).cross(c[2] - c[0]).dot(normal) / normal.squaredNorm();
    const double u = (c[1] - c[0]).cross(p - c[0]).dot(normal) / normal.squaredNorm();
    worst = {{1 - u - v, v, u}, p, share};
  });
  return worst;
}

// At an edge where the place is close to it, else inside; where that cannot be, the other way.
bool DecimationPasses::try_split_at(std::uint32_t slot, const Witness& witness, int power) {
  constexpr double kInside = 0.15, kLeastInside = 0.02;
  const std::array<Point, 3> c = state_.mesh().corners(slot);
  const Triangle t = state_.mesh().triangle(slot);
  const auto least =
      static_cast<std::size_t>(std::ranges::min_element(witness.at) - witness.at.begin());
  const std::uint32_t a = t[(least + 1) % 3], b = t[(least + 2) % 3];
  const auto at = [&](const std::array<double, 3>& weights) {
    return Point((weights[0] * c[0] + weights[1] * c[1] + weights[2] * c[2]) /
                 (weights[0] + weights[1] + weights[2]));
  };
  std::array<double, 3> on_edge = witness.at;
  on_edge[least] = 0;
  const EditProposer& proposer = proposers_.front();
  LocalSearch::Options options;
  options.power = power;
  const bool far_inside = witness.at[least] >= kInside;
  for (const bool inside : {far_inside, !far_inside}) {
    if (inside && witness.at[least] < kLeastInside) continue;
    if (inside ? !proposer.may_split(t) : !proposer.may_split(a, b)) continue;
    const Point place = at(inside ? witness.at : on_edge);
    const std::uint32_t vertex = spare_vertex(place, a);
    if (!(inside ? search_.prepare_split(slot, vertex) : search_.prepare_split(a, b, vertex))) {
      continue;
    }
    std::vector<Fit> fits;
    for (const Point& start : {place, witness.wanted, Point(0.5 * (place + witness.wanted))}) {
      Fit fit;
      if (search_.fit(start, options, fit)) fits.push_back(fit);
    }
    std::ranges::stable_sort(fits, {}, &Fit::energy);
    for (const Fit& fit : fits) {
      if (search_.finish(fit, true, edit_) && state_.permits(edit_)) return true;
    }
  }
  return false;
}

std::size_t DecimationPasses::split_at_worst(const std::vector<std::uint32_t>& slots, int power) {
  touched_.assign(state_.mesh().vertex_slots(), 0);
  std::size_t splits = 0;
  for (std::size_t i = 0; i < slots.size() && !poll(i, slots.size()); ++i) {
    if (!untouched(slots[i]) || !try_split_at(slots[i], worst_place(slots[i]), power)) continue;
    make_split();
    ++splits;
  }
  return splits;
}

std::vector<std::uint32_t> DecimationPasses::vertices_around(
    const std::vector<std::uint32_t>& slots, int rings) const {
  std::vector<std::uint32_t> vertices, ring;
  for (const std::uint32_t slot : slots) {
    if (!state_.mesh().alive(slot)) continue;
    for (const std::uint32_t v : state_.mesh().triangle(slot)) vertices.push_back(v);
  }
  sort_once(vertices);
  for (int i = 0; i < rings; ++i) {
    const std::vector<std::uint32_t> inner = vertices;
    for (const std::uint32_t v : inner) {
      state_.mesh().neighbours(v, ring);
      vertices.insert(vertices.end(), ring.begin(), ring.end());
    }
    sort_once(vertices);
  }
  return vertices;
}

std::size_t DecimationPasses::relax_around(const std::vector<std::uint32_t>& slots, int rings,
                                           int power) {
  std::vector<std::uint32_t> vertices = vertices_around(slots, rings);
  std::vector<Edge> edges;
  for (const std::uint32_t v : vertices) {
    state_.mesh().neighbours(v, around_);
    for (const std::uint32_t w : around_) edges.push_back({std::min(v, w), std::max(v, w)});
  }
  sort_once(edges);
  const std::size_t flips = flip_each(std::move(edges), power, {{0, 0.5}});
  return flips + relocate_each(std::move(vertices), power, {{0.5, 1}});
}

}  // namespace emax
