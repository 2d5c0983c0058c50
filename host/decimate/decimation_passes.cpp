#include "host/decimate/decimation_passes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "sw_model/base/sort_once.h"
namespace emax {
namespace {

constexpr double kHopeless = 4;    // squared distance / limit^2 from which finer steps do not help
constexpr double kMendable = 2.5;  // squared distance / limit^2 up to which mending is tried
constexpr double kSecondChoice = 0.5;  // likewise, for a collapse that keeps an end in place
constexpr double kNothing = 1e-8;      // an energy too small to be worth a move
constexpr double kNothingOfHighPowers = 1e-30;

// The least share of its energy that a move or flip gains. Where it is of a high power, the
// distances gain that share over the power.
double least_gain(int power) { return 1e-3 * (power > 4 ? power : 1); }

constexpr double kFirstSweep = 0.01, kSweepGrowth = 1.4, kLastSweep = 0.3;  // of limit^2
constexpr double kLeastSwept = 0.1;  // the least share of the triangles that a sweep must remove

double share_of(std::size_t at, std::size_t of) {
  return static_cast<double>(at) / static_cast<double>(of);
}

// A triangle's edges, the shortest first, each with its lower vertex first.
std::array<std::array<std::uint32_t, 2>, 3> shortest_first(const EditableMesh& mesh,
                                                           std::uint32_t slot) {
  const Triangle& t = mesh.triangle(slot);
  std::array<std::array<std::uint32_t, 2>, 3> edges;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
    edges[i] = {low, high};
  }
  std::sort(edges.begin(), edges.end(), [&](const auto& e, const auto& f) {
    const double of_e = (mesh.position(e[0]) - mesh.position(e[1])).squaredNorm();
    const double of_f = (mesh.position(f[0]) - mesh.position(f[1])).squaredNorm();
    return of_e != of_f ? of_e < of_f : e < f;
  });
  return edges;
}

}  // namespace

DecimationPasses::DecimationPasses(DecimationState& state, Options options, Poll poll)
    : state_(state),
      options_(std::move(options)),
      poll_(std::move(poll)),
      search_(state, options_.spring) {}

void DecimationPasses::restart(const FeatureEdges& features) {
  options_.features = features;
  search_.use(LocalSearch::Steps::kReweighted);
  spare_ = kNoIndex;
}

bool DecimationPasses::poll(double done) {
  if (!stopped_ && poll_ && ++polls_ % 64 == 0) stopped_ = poll_(done);
  return stopped_;
}

bool DecimationPasses::poll(std::size_t at, std::size_t of) { return poll(share_of(at, of)); }

std::vector<DecimationPasses::Edge> DecimationPasses::edges() const {
  const EditableMesh& mesh = state_.mesh();
  std::vector<Edge> result;
  for (std::uint32_t slot = 0; slot < mesh.slots(); ++slot) {
    if (!mesh.alive(slot)) continue;
    const Triangle& t = mesh.triangle(slot);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      const auto sides = mesh.slots_at_edge(a, b);
      // Each edge once, from the triangle of the lower slot.
      if (sides[1] != kNoIndex && std::min(sides[0], sides[1]) != slot) continue;
      result.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

bool DecimationPasses::judge(std::uint32_t a, std::uint32_t b, Candidate& candidate) {
  const FeatureEdges::Collapse feature = options_.features.permitted(a, b);
  if (feature == FeatureEdges::Collapse::kForbidden) return false;
  candidate.a = a;
  candidate.b = b;
  candidate.stamp = edits_;
  if (!search_.prepare_collapse(a, b)) return false;
  const Point pa = state_.mesh().position(a), pb = state_.mesh().position(b);
  const bool hoppe = options_.representation > 0;
  LocalSearch::Options options;
  options.power = hoppe ? 2 : power_;
  const double before = search_.energy_before(options.power) + options_.representation;
  Fit fit;
  if (feature == FeatureEdges::Collapse::kAlong) {
    // The optimum of the planes' quadrics is where the sides of the feature meet.
    bool any = false;
    for (const Point& at : {search_.quadric_optimum(), pa, pb}) {
      any = any || (keeps_features(a, b, at) && search_.evaluate(at, options.power, fit) &&
                    fit.worst <= 1);
    }
    if (!any) return false;
  } else if (feature != FeatureEdges::Collapse::kAnywhere) {
    const Point& kept = feature == FeatureEdges::Collapse::kAtFirst ? pa : pb;
    if (!search_.evaluate(kept, options.power, fit)) return false;
    if (fit.worst > 1 && !search_.finish(fit, true, edit_)) return false;
  } else if (hoppe) {
    bool any = false;
    for (const Point& start : {Point(0.5 * (pa + pb)), pa, pb}) {
      Fit other;
      if (!search_.fit(start, options, other)) continue;
      if (!any || other.energy < fit.energy) fit = other;
      any = true;
    }
    if (!any || fit.worst > 1) return false;
  } else if (!place(pa, pb, fit)) {
    return false;
  }
  if (hoppe && !(fit.energy < before)) return false;
  if (!keeps_features(a, b, fit.position)) return false;
  candidate.cost = fit.energy - before;
  candidate.fit = std::move(fit);
  return true;
}

// Finds the position where the energy of the prepared collapse is least. Returns whether it may be
// within the limit.
bool DecimationPasses::place(const Point& pa, const Point& pb, Fit& fit) {
  LocalSearch::Options options;
  options.power = power_;
  if (search_.fine()) options.steps = 0;
  bool any = search_.fit(search_.quadric_optimum(), options, fit);
  for (const Point& start : {Point(0.5 * (pa + pb)), pa, pb}) {
    if (any) break;
    any = search_.fit(start, options, fit);
  }
  if (!any || fit.worst > kHopeless) return false;
  if (fit.worst <= state_.permitted()) return true;
  if (state_.loosened()) return false;
  options.power = 8;
  options.steps = 8;
  Fit finer;
  if (search_.fit(fit.position, options, finer) && finer.worst < fit.worst) {
    search_.evaluate(finer.position, 4, fit);
  }
  return fit.worst <= 1 || search_.finish(fit, true, edit_);
}

void DecimationPasses::push(std::uint32_t a, std::uint32_t b) {
  if (a > b) std::swap(a, b);
  Candidate candidate;
  if (judge(a, b, candidate)) queue_.push(candidate);
}

bool DecimationPasses::apply_collapse(const Candidate& candidate) {
  const std::uint32_t a = candidate.a, b = candidate.b;
  if (!search_.prepare_collapse(a, b)) return false;
  const auto try_at = [&](const Fit& fit) {
    return keeps_features(a, b, fit.position) && search_.finish(fit, true, edit_) &&
           state_.permits(edit_);
  };
  bool made = try_at(candidate.fit);
  // At the position of one of the two vertices few triangles are new, so the collapse is less
  // likely to intersect anything.
  if (!made && options_.representation == 0 &&
      options_.features.permitted(a, b) == FeatureEdges::Collapse::kAnywhere) {
    for (const Point& end : {state_.mesh().position(a), state_.mesh().position(b)}) {
      Fit fit;
      made = made || (search_.evaluate(end, 4, fit) && fit.worst <= kSecondChoice && try_at(fit));
    }
  }
  if (made) make_collapse(a, b);
  return made;
}

std::size_t DecimationPasses::collapse_at(const std::vector<std::uint32_t>& slots) {
  const auto collapse_one = [&](std::uint32_t slot) {
    return std::ranges::any_of(shortest_first(state_.mesh(), slot), [&](const Edge& e) {
      Candidate candidate;
      return judge(e[0], e[1], candidate) && apply_collapse(candidate);
    });
  };
  std::size_t collapses = 0;
  for (std::size_t i = 0; i < slots.size() && !poll(i, slots.size()); ++i) {
    collapses += state_.mesh().alive(slots[i]) && collapse_one(slots[i]) ? 1 : 0;
  }
  return collapses;
}

bool DecimationPasses::keeps_features(std::uint32_t a, std::uint32_t b, const Point& at) const {
  return options_.features.stays_near(a, b, at, state_.mesh().positions(), state_.squared_limit());
}

void DecimationPasses::make_collapse(std::uint32_t a, std::uint32_t b) {
  state_.apply(edit_);
  options_.features.collapsed(a, b, state_.mesh().positions());
}

bool DecimationPasses::try_plain_collapse(std::uint32_t a, std::uint32_t b, double most) {
  if (options_.features.permitted(a, b) != FeatureEdges::Collapse::kAnywhere) return false;
  if (!search_.prepare_collapse(a, b)) return false;
  LocalSearch::Options options;
  options.steps = 0;
  Fit fit;
  if (!search_.fit(search_.quadric_optimum(), options, fit) || fit.worst > most) return false;
  if (!keeps_features(a, b, fit.position)) return false;
  return search_.finish(fit, true, edit_) && state_.permits(edit_);
}

std::size_t DecimationPasses::sweep() {
  const EditableMesh& mesh = state_.mesh();
  const std::size_t start = mesh.triangles();
  const auto slots = static_cast<std::uint32_t>(mesh.slots());
  std::size_t collapses = 0, before = start;
  for (double most = kFirstSweep;; most = std::min(kLastSweep, most * kSweepGrowth)) {
    touched_.assign(mesh.vertex_slots(), 0);
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      // The share of triangles that are left measures the progress.
      if (poll(1 - static_cast<double>(mesh.triangles()) / static_cast<double>(start))) break;
      if (!mesh.alive(slot)) continue;
      for (const auto& [a, b] : shortest_first(mesh, slot)) {
        if (touched_[a] != 0 || touched_[b] != 0 || !try_plain_collapse(a, b, most)) continue;
        make_collapse(a, b);
        ++collapses;
        touch_around(a);
        break;
      }
    }
    if (stopped_ ||
        static_cast<double>(mesh.triangles()) > (1 - kLeastSwept) * static_cast<double>(before)) {
      return collapses;
    }
    before = mesh.triangles();
  }
}

std::size_t DecimationPasses::collapse() {
  const EditableMesh& mesh = state_.mesh();
  queue_ = {};
  touched_.assign(mesh.vertex_slots(), 0);
  edits_ = 0;
  const auto all = edges();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (poll(i, 2 * all.size())) return 0;
    push(all[i][0], all[i][1]);
  }
  std::size_t collapses = 0;
  const std::size_t triangles = mesh.triangles();
  while (!queue_.empty()) {
    // The queue shrinks with the triangles. When no more of them can be removed, it empties.
    const double left = static_cast<double>(mesh.triangles()) / static_cast<double>(triangles);
    if (poll(1 - 0.5 * left)) break;
    const Candidate candidate = queue_.top();
    queue_.pop();
    const std::uint32_t a = candidate.a, b = candidate.b;
    if (!mesh.used(a) || !mesh.used(b)) continue;
    if (candidate.stamp < touched_[a] || candidate.stamp < touched_[b]) {
      push(a, b);
      continue;
    }
    mesh.neighbours(a, of_a_);
    if (!apply_collapse(candidate)) continue;
    ++collapses;
    ++edits_;
    mesh.neighbours(a, around_);
    touched_[a] = edits_;
    for (const std::uint32_t v : around_) touched_[v] = edits_;
    // Pushes the edges that b had. The other edges at a are judged anew when they come up in the
    // queue.
    for (const std::uint32_t v : around_) {
      if (!std::binary_search(of_a_.begin(), of_a_.end(), v)) push(a, v);
    }
  }
  return collapses;
}

bool DecimationPasses::try_relocation(std::uint32_t vertex, int power, bool limit) {
  if (options_.features.fixed(vertex)) return false;
  if (!search_.prepare_relocation(vertex)) return false;
  const double before = search_.energy_before(power);
  if (before < (power > 4 ? kNothingOfHighPowers : kNothing)) return false;
  Fit fit;
  LocalSearch::Options options;
  options.power = power;
  if (!search_.fit(state_.mesh().position(vertex), options, fit)) return false;
  if (!(fit.energy < before * (1 - least_gain(power)))) return false;
  if (!search_.finish(fit, limit, edit_)) return false;
  return state_.permits(edit_, !limit);
}

bool DecimationPasses::try_flip(std::uint32_t a, std::uint32_t b, int power, bool limit) {
  if (options_.features.on(a, b) || !search_.prepare_flip(a, b)) return false;
  const double before = search_.energy_before(power);
  Fit fit;
  if (!search_.evaluate(Point::Zero(), power, fit, before * (1 - least_gain(power)))) return false;
  if (!search_.finish(fit, limit, edit_)) return false;
  return state_.permits(edit_, !limit);
}

std::size_t DecimationPasses::relocate(int power) {
  std::vector<std::uint32_t> vertices(state_.mesh().vertex_slots());
  std::iota(vertices.begin(), vertices.end(), 0u);
  return relocate_each(vertices, power, 0);
}

std::size_t DecimationPasses::relocate_each(const std::vector<std::uint32_t>& vertices, int power,
                                            double from) {
  std::size_t moved = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (poll(std::lerp(from, 1, share_of(i, vertices.size())))) break;
    if (!state_.mesh().used(vertices[i]) || !try_relocation(vertices[i], power, true)) continue;
    state_.apply(edit_);
    ++moved;
  }
  return moved;
}

std::size_t DecimationPasses::descend() {
  constexpr int kRounds = 8;
  std::size_t edits = 0;
  for (int round = 0; round < kRounds && !stopped_; ++round) {
    const std::size_t collapses = collapse();
    const std::size_t others = flip(2) + relocate(2);
    edits += collapses + others;
    if (collapses == 0 && 100 * others < state_.mesh().triangles()) break;
  }
  return edits;
}

std::size_t DecimationPasses::flip(int power) { return flip_each(edges(), power, 0, 1); }

std::size_t DecimationPasses::flip_each(const std::vector<Edge>& edges, int power, double from,
                                        double to) {
  std::size_t flips = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (poll(std::lerp(from, to, share_of(i, edges.size())))) break;
    if (!try_flip(edges[i][0], edges[i][1], power, true)) continue;
    state_.apply(edit_);
    ++flips;
  }
  return flips;
}

bool DecimationPasses::all_within(const std::vector<std::uint32_t>& points) const {
  return std::all_of(points.begin(), points.end(), [&](std::uint32_t p) {
    return state_.assigned().squared_distance(p) <= state_.squared_limit();
  });
}

// Whether a tried collapse, after the repairs so far, keeps every limit.
bool DecimationPasses::settled() {
  return all_within(unsettled_) && std::ranges::all_of(uncovered_, [&](std::uint32_t triangle) {
           return state_.prove(triangle);
         });
}

void DecimationPasses::apply(bool keep_undo) {
  if (!keep_undo) {
    state_.apply(edit_);
    return;
  }
  undo_.emplace_back();
  state_.apply(edit_, &undo_.back());
  for (const MeshEdit::Answer& a : edit_.answers) {
    if (a.squared_distance > state_.squared_limit()) unsettled_.push_back(a.point);
  }
  uncovered_.insert(uncovered_.end(), state_.given_up().begin(), state_.given_up().end());
}

bool DecimationPasses::mend(std::uint32_t vertex) {
  constexpr int kRounds = 4;
  const EditableMesh& mesh = state_.mesh();
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t before = undo_.size();
    mesh.neighbours(vertex, around_);
    std::vector<std::uint32_t> ring = around_;
    std::vector<std::array<std::uint32_t, 2>> flips;
    for (const std::uint32_t v : ring) {
      flips.push_back({vertex, v});
      mesh.for_each_slot_at(v, [&](std::uint32_t slot) {
        const Triangle& t = mesh.triangle(slot);
        for (std::size_t i = 0; i < 3; ++i) {
          const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
          flips.push_back({low, high});
        }
      });
    }
    sort_once(flips);
    ring.insert(ring.begin(), vertex);
    for (const auto& [a, b] : flips) {
      if (mesh.used(a) && mesh.used(b) && try_flip(a, b, 8, false)) apply(true);
    }
    if (settled()) return true;
    for (const std::uint32_t v : ring) {
      if (try_relocation(v, 8, false)) apply(true);
    }
    if (settled()) return true;
    if (undo_.size() == before) break;
  }
  return false;
}

std::size_t DecimationPasses::collapse_and_mend() {
  const EditableMesh& mesh = state_.mesh();
  struct Trial {
    double worst;
    std::uint32_t a, b;
    Fit fit;
  };
  const auto judge_trial = [&](std::uint32_t a, std::uint32_t b, Trial& trial) {
    if (options_.features.permitted(a, b) != FeatureEdges::Collapse::kAnywhere) return false;
    if (!search_.prepare_collapse(a, b)) return false;
    LocalSearch::Options options;
    options.power = 8;
    options.steps = 8;
    bool any = false;
    const Point pa = mesh.position(a), pb = mesh.position(b);
    for (const Point& start : {search_.quadric_optimum(), Point(0.5 * (pa + pb))}) {
      Fit fit;
      if (!search_.fit(start, options, fit)) continue;
      if (!any || fit.worst < trial.fit.worst) trial.fit = fit;
      any = true;
    }
    trial.a = a;
    trial.b = b;
    trial.worst = any ? trial.fit.worst : 0;
    return any && trial.worst <= kMendable;
  };
  std::vector<Trial> trials;
  const auto all = edges();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (poll(i, 4 * all.size())) return 0;
    Trial trial;
    if (judge_trial(all[i][0], all[i][1], trial)) trials.push_back(trial);
  }
  std::sort(trials.begin(), trials.end(), [](const Trial& s, const Trial& t) {
    return s.worst != t.worst ? s.worst < t.worst : s.a != t.a ? s.a < t.a : s.b < t.b;
  });
  std::size_t collapses = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    Trial& trial = trials[i];
    if (poll(0.25 + 0.75 * static_cast<double>(i) / static_cast<double>(trials.size()))) break;
    if (!mesh.used(trial.a) || !mesh.used(trial.b)) continue;
    if (!judge_trial(trial.a, trial.b, trial)) continue;
    if (!keeps_features(trial.a, trial.b, trial.fit.position)) continue;
    if (!search_.finish(trial.fit, false, edit_) || !state_.permits(edit_, true)) continue;
    undo_.clear();
    unsettled_.clear();
    uncovered_.clear();
    apply(true);
    if (settled() || mend(trial.a)) {
      options_.features.collapsed(trial.a, trial.b, mesh.positions());
      ++collapses;
      continue;
    }
    for (; !undo_.empty(); undo_.pop_back()) state_.undo(undo_.back());
  }
  return collapses;
}

}  // namespace emax
