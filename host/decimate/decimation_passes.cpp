#include "host/decimate/decimation_passes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/parallel.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

// Squared distance / limit^2 for a collapse that keeps an end in place.
constexpr double kSecondChoice = 0.5;
constexpr std::size_t kBatch = 256;  // proposals between two looks at the clock

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

DecimationPasses::DecimationPasses(DecimationState& state, Options options, std::size_t threads,
                                   Poll poll)
    : state_(state),
      options_(std::move(options)),
      poll_(std::move(poll)),
      proposers_(threads, EditProposer(state, options_, known_)),
      search_(proposers_.front().search()),
      edit_(proposers_.front().edit()),
      batch_(kBatch),
      independent_(state.mesh()) {
  state_.use_threads(threads);
  mark_fixed();
}

void DecimationPasses::mark_fixed() {
  const std::vector<Point>& places = options_.fixed_places;
  if (places.empty()) return;
  const auto key = [](const Point& p) { return std::array{p[0], p[1], p[2]}; };
  std::vector<std::array<double, 3>> sorted;
  for (const Point& place : places) sorted.push_back(key(place));
  std::ranges::sort(sorted);
  const EditableMesh& mesh = state_.mesh();
  options_.fixed.assign(mesh.vertex_slots(), 0);
  for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
    const bool fixed = mesh.used(v) && std::ranges::binary_search(sorted, key(mesh.position(v)));
    options_.fixed[v] = fixed ? 1 : 0;
  }
}

std::vector<std::uint32_t> DecimationPasses::free_slots() const {
  std::vector<std::uint32_t> slots = state_.mesh().alive_slots();
  std::erase_if(slots, [&](std::uint32_t slot) {
    return !proposers_.front().may_split(state_.mesh().triangle(slot));
  });
  return slots;
}

void DecimationPasses::use(LocalSearch::Steps steps) {
  for (EditProposer& proposer : proposers_) proposer.search().use(steps);
}

void DecimationPasses::restart(const FeatureEdges& features) {
  options_.features = features;
  use(LocalSearch::Steps::kReweighted);
  free();
  mark_fixed();
  spare_ = kNoIndex;
}

void DecimationPasses::hold_around(const std::vector<Place>& places) {
  const EditableMesh& mesh = state_.mesh();
  options_.held.assign(mesh.vertex_slots(), 0);
  for (std::uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
    const bool near =
        mesh.used(v) && std::ranges::any_of(places, [&](const Place& place) {
          return (mesh.position(v) - place.at).squaredNorm() <= place.radius * place.radius;
        });
    options_.held[v] = near ? 1 : 0;
  }
}

bool DecimationPasses::poll_now(double done) {
  if (!stopped_ && poll_) stopped_ = poll_(done);
  return stopped_;
}

bool DecimationPasses::poll(double done) { return ++polls_ % 64 == 0 ? poll_now(done) : stopped_; }

bool DecimationPasses::poll(std::size_t at, std::size_t of) { return poll(share_of(at, of)); }

// Calls propose(proposer, i) for each i of [first, last); then, in order, make(edit) where that
// returned true.
void DecimationPasses::propose_batch(std::size_t first, std::size_t last, std::size_t threads,
                                     const Propose& propose, const Make& make) {
  known_.keep(search_.fresh(), state_.mesh());
  in_pieces(threads, last - first, 1, [&](std::size_t thread, std::size_t item, std::size_t) {
    EditProposer& proposer = proposers_[thread];
    Found& found = batch_[item];
    found.any = propose(proposer, first + item);
    if (make && found.any) found.back = state_.judge_back(proposer.edit(), thread);
    std::swap(found.edit, proposer.edit());
    std::swap(found.looked_at, proposer.search().fresh());
  });
  for (std::size_t item = 0; item < last - first; ++item) {
    if (make && batch_[item].any) make(batch_[item].edit, batch_[item].back);
    known_.keep(batch_[item].looked_at, state_.mesh());
  }
}

// In batches, until the passes are stopped. A few proposals are made before a thread has begun.
void DecimationPasses::propose_each(std::size_t count, const Part& part, const Propose& propose,
                                    const Make& make) {
  const std::size_t threads = part || count > kBatch ? proposers_.size() : 1;
  for (std::size_t first = 0; first < count; first += kBatch) {
    if (part) poll_now(std::lerp((*part)[0], (*part)[1], share_of(first, count)));
    if (stopped_) return;
    propose_batch(first, std::min(first + kBatch, count), threads, propose, make);
  }
}

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

// Those of the collapses that can be made, in the order of the edges.
std::vector<DecimationPasses::Collapse> DecimationPasses::judge_each(const std::vector<Edge>& edges,
                                                                     const Part& part,
                                                                     const Judge& judge) {
  std::vector<Collapse> judged(edges.size());
  std::vector<char> possible(edges.size(), 0);
  propose_each(edges.size(), part, [&](EditProposer& proposer, std::size_t i) {
    possible[i] = judge(proposer, edges[i], judged[i]) ? 1 : 0;
    judged[i].stamp = edits_;
    return false;
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (possible[i] != 0) judged[kept++] = judged[i];
  }
  judged.resize(kept);
  return judged;
}

std::vector<DecimationPasses::Collapse> DecimationPasses::judge_each(const std::vector<Edge>& edges,
                                                                     const Part& part, int power) {
  return judge_each(edges, part, [power](EditProposer& p, const Edge& e, Collapse& collapse) {
    return p.judge(e[0], e[1], power, collapse);
  });
}

void DecimationPasses::push(const std::vector<Edge>& edges, const Part& part) {
  const std::vector<Collapse> judged = judge_each(edges, part, kPower);
  auto next = judged.begin();
  for (const Edge& e : edges) {
    if (next != judged.end() && next->a == e[0] && next->b == e[1]) {
      queue_.push(*next++);
    } else {
      refused_.push_back({e, edits_});
    }
  }
}

// Of the refused edges, those with another triangle at an end since then.
std::vector<DecimationPasses::Edge> DecimationPasses::take_changed() {
  std::vector<Edge> changed;
  std::erase_if(refused_, [&](const Refused& refused) {
    const auto [a, b] = refused.edge;
    if (!state_.mesh().used(a) || !state_.mesh().used(b)) return true;
    if (refused.stamp >= touched_[a] && refused.stamp >= touched_[b]) return false;
    changed.push_back(refused.edge);
    return true;
  });
  return changed;
}

bool DecimationPasses::apply_collapse(const Collapse& candidate) {
  const std::uint32_t a = candidate.a, b = candidate.b;
  if (!search_.prepare_collapse(a, b)) return false;
  const auto try_at = [&](const Fit& fit) {
    return proposers_.front().keeps_features(a, b, fit.position) &&
           search_.finish(fit, true, edit_) && state_.permits(edit_);
  };
  bool made = try_at(candidate.fit);
  if (!made && search_.place()) {
    Collapse free;
    made = proposers_.front().judge(a, b, kPower, free, false) && try_at(free.fit);
  }
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
      Collapse candidate;
      return proposers_.front().judge(e[0], e[1], kPower, candidate) && apply_collapse(candidate);
    });
  };
  std::size_t collapses = 0;
  for (std::size_t i = 0; i < slots.size() && !poll(i, slots.size()); ++i) {
    collapses += state_.mesh().alive(slots[i]) && collapse_one(slots[i]) ? 1 : 0;
  }
  return collapses;
}

void DecimationPasses::make_collapse(std::uint32_t a, std::uint32_t b) {
  state_.apply(edit_);
  options_.features.collapsed(a, b, state_.mesh().positions());
}

bool DecimationPasses::try_plain_collapse(std::uint32_t a, std::uint32_t b, double most) {
  EditProposer& proposer = proposers_.front();
  if (proposer.plain_collapse(a, b, most, true) && state_.permits(edit_)) return true;
  return search_.place() && proposer.plain_collapse(a, b, most, false) && state_.permits(edit_);
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

std::size_t DecimationPasses::collapse(bool again) {
  const EditableMesh& mesh = state_.mesh();
  queue_ = {};
  refused_.clear();
  touched_.assign(mesh.vertex_slots(), 0);
  edits_ = 0;
  push(edges(), {{0, 0.5}});
  if (stopped_) return 0;
  std::size_t collapses = 0;
  const std::size_t triangles = mesh.triangles();
  while (true) {
    // The queue shrinks with the triangles. When no more of them can be removed, it empties.
    const double done = 1 - 0.5 * share_of(mesh.triangles(), triangles);
    if (queue_.empty() && again && !EMAX_FAULT(kForgetsRefused))
      push(take_changed(), {{done, done}});
    if (queue_.empty() || poll(done)) break;
    const Collapse candidate = queue_.top();
    queue_.pop();
    const std::uint32_t a = candidate.a, b = candidate.b;
    if (!mesh.used(a) || !mesh.used(b)) continue;
    if (candidate.stamp < touched_[a] || candidate.stamp < touched_[b]) {
      push({{a, b}}, {});
      continue;
    }
    mesh.neighbours(a, of_a_);
    if (!apply_collapse(candidate)) {
      refused_.push_back({{a, b}, edits_});
      continue;
    }
    ++collapses;
    ++edits_;
    mesh.neighbours(a, around_);
    touched_[a] = edits_;
    for (const std::uint32_t v : around_) touched_[v] = edits_;
    // Pushes the edges that b had. The other edges at a are judged anew when they come up in the
    // queue.
    std::vector<Edge> of_b;
    for (const std::uint32_t v : around_) {
      if (!std::ranges::binary_search(of_a_, v)) of_b.push_back({std::min(a, v), std::max(a, v)});
    }
    push(of_b, {});
  }
  return collapses;
}

// Proposes and makes edits of items in parts that do not touch each other.
template <class Item, class ProposeItem>
std::size_t DecimationPasses::edit_each(std::vector<Item> left, const Share& whole,
                                        const ProposeItem& propose) {
  const std::size_t all = left.size();
  std::size_t edits = 0;
  const auto reached = [&] {
    return std::lerp(whole[0], whole[1], 1 - share_of(left.size(), all));
  };
  while (!left.empty() && !stopped_) {
    const double from = reached();
    const std::vector<Item> part = independent_.take(left);
    propose_each(
        part.size(), Share{from, reached()},
        [&](EditProposer& proposer, std::size_t i) { return propose(proposer, part[i]); },
        [&](const MeshEdit& edit, DecimationState::BackVerdict& back) {
          if (!state_.permits(edit, std::move(back))) return;
          state_.apply(edit);
          ++edits;
        });
  }
  return edits;
}

std::size_t DecimationPasses::relocate(int power) {
  std::vector<std::uint32_t> vertices(state_.mesh().vertex_slots());
  std::iota(vertices.begin(), vertices.end(), 0u);
  std::erase_if(vertices, [&](std::uint32_t v) { return !state_.mesh().used(v); });
  return relocate_each(std::move(vertices), power, {{0, 1}});
}

std::size_t DecimationPasses::move_into_place() {
  if (!state_.follows_shapes()) return 0;
  std::vector<std::uint32_t> vertices(state_.mesh().vertex_slots());
  std::iota(vertices.begin(), vertices.end(), 0u);
  std::erase_if(vertices, [&](std::uint32_t v) { return !state_.mesh().used(v); });
  return edit_each(std::move(vertices), {{0, 1}}, [](EditProposer& proposer, std::uint32_t vertex) {
    return proposer.into_place(vertex);
  });
}

std::size_t DecimationPasses::move_toward_edges() {
  options_.true_edges.assign(state_);
  std::vector<std::uint32_t> vertices(state_.mesh().vertex_slots());
  std::iota(vertices.begin(), vertices.end(), 0u);
  std::erase_if(vertices, [&](std::uint32_t v) { return !state_.mesh().used(v); });
  return edit_each(std::move(vertices), {{0, 1}},
                   [this](EditProposer& proposer, std::uint32_t vertex) {
                     return proposer.toward_edges(vertex, options_.true_edges);
                   });
}

std::size_t DecimationPasses::relocate_each(std::vector<std::uint32_t> vertices, int power,
                                            const Share& share) {
  return edit_each(std::move(vertices), share,
                   [power](EditProposer& proposer, std::uint32_t vertex) {
                     return proposer.relocation(vertex, power, true);
                   });
}

std::size_t DecimationPasses::flip(int power) { return flip_each(edges(), power, {{0, 1}}); }

std::size_t DecimationPasses::flip_each(std::vector<Edge> edges, int power, const Share& share) {
  return edit_each(std::move(edges), share, [power](EditProposer& proposer, const Edge& edge) {
    return proposer.flip(edge[0], edge[1], power, true);
  });
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
  EditProposer& proposer = proposers_.front();
  const auto permitted = [&] { return state_.permits(edit_, true); };
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
      if (mesh.used(a) && mesh.used(b) && proposer.flip(a, b, 8, false) && permitted()) apply(true);
    }
    if (settled()) return true;
    for (const std::uint32_t v : ring) {
      if (proposer.relocation(v, 8, false) && permitted()) apply(true);
    }
    if (settled()) return true;
    if (undo_.size() == before) break;
  }
  return false;
}

std::size_t DecimationPasses::collapse_and_mend() {
  const EditableMesh& mesh = state_.mesh();
  EditProposer& proposer = proposers_.front();
  std::vector<Collapse> trials =
      judge_each(edges(), {{0, 0.25}}, [](EditProposer& other, const Edge& e, Collapse& trial) {
        return other.judge_beyond(e[0], e[1], trial);
      });
  if (stopped_) return 0;
  std::ranges::sort(trials, Collapse::costs_less);
  std::size_t collapses = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    Collapse& trial = trials[i];
    if (poll(0.25 + 0.75 * share_of(i, trials.size()))) break;
    if (!mesh.used(trial.a) || !mesh.used(trial.b)) continue;
    if (!proposer.judge_beyond(trial.a, trial.b, trial)) continue;
    if (!proposer.keeps_features(trial.a, trial.b, trial.fit.position)) continue;
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
