#include "host/tiles/space_partition.h"

#include <algorithm>
#include <array>
#include <utility>

namespace emax {
namespace {

std::uint64_t key_of_cell(const SpaceCell& c) {
  return (static_cast<std::uint64_t>(c.x()) * kSpaceCells + static_cast<std::uint64_t>(c.y())) *
             kSpaceCells +
         static_cast<std::uint64_t>(c.z());
}

SpaceCell cell_of_key(std::uint64_t key) {
  const auto part = [](std::uint64_t k) { return static_cast<int>(k % kSpaceCells); };
  return {part(key / kSpaceCells / kSpaceCells), part(key / kSpaceCells), part(key)};
}

SpaceCell shifted(const SpaceCell& c, int level) {
  return {c.x() >> level, c.y() >> level, c.z() >> level};
}

// Between which of the entries, sorted along the axis, a plane halves the points best; 0 if all
// have the same coordinate.
std::size_t middle(std::span<const SpaceCount::Entry> entries, int axis, std::uint64_t points) {
  std::size_t best = 0;
  std::uint64_t before = 0, best_difference = points + 1;
  for (std::size_t i = 1; i < entries.size(); ++i) {
    before += entries[i - 1].points;
    if (entries[i].cell[axis] == entries[i - 1].cell[axis]) continue;
    const std::uint64_t after = points - before;
    const std::uint64_t difference = std::max(before, after) - std::min(before, after);
    if (difference < best_difference) {
      best_difference = difference;
      best = i;
    }
  }
  return best;
}

}  // namespace

SpaceCell space_cell(const Eigen::Vector3f& normalised) {
  const auto at = [](float coordinate) {
    const double cell = (static_cast<double>(coordinate) + 1) * (0.5 * kSpaceCells);
    return static_cast<int>(std::clamp(cell, 0.0, kSpaceCells - 1.0));
  };
  return {at(normalised.x()), at(normalised.y()), at(normalised.z())};
}

double space_plane(int cell) { return static_cast<double>(cell) / (0.5 * kSpaceCells) - 1; }

void SpaceCount::add(std::span<const SpaceCell> cells) {
  int level = 0;
  {
    const std::lock_guard lock(mutex_);
    level = level_;
  }
  std::unordered_map<std::uint64_t, std::uint64_t> own;
  for (const SpaceCell& cell : cells) ++own[key_of_cell(shifted(cell, level))];
  const std::lock_guard lock(mutex_);
  for (const auto& [key, points] : own) {
    counts_[key_of_cell(shifted(cell_of_key(key), level_ - level))] += points;
    if (counts_.size() > most_cells_) coarsen();
  }
}

void SpaceCount::coarsen() {
  while (counts_.size() > most_cells_) {
    ++level_;
    std::unordered_map<std::uint64_t, std::uint64_t> coarse;
    for (const auto& [key, points] : counts_) {
      coarse[key_of_cell(shifted(cell_of_key(key), 1))] += points;
    }
    counts_ = std::move(coarse);
  }
}

std::vector<SpaceCount::Entry> SpaceCount::entries() const {
  std::vector<Entry> all;
  for (const auto& [key, points] : std::map(counts_.begin(), counts_.end())) {
    all.push_back({cell_of_key(key), points});
  }
  return all;
}

SpacePartition::SpacePartition(const SpaceCount& count, std::uint64_t most_points) {
  std::vector<SpaceCount::Entry> entries = count.entries();
  cut(entries, count.level(), {}, most_points);
}

SpacePartition::SpacePartition(std::vector<Node> nodes, std::span<const std::uint64_t> points)
    : nodes_(std::move(nodes)), parts_(points.size()) {
  find_parts(0, {}, points);
}

void SpacePartition::find_parts(std::uint32_t node, const Part& part,
                                std::span<const std::uint64_t> points) {
  const Node& n = nodes_.at(node);
  if (n.axis < 0) {
    parts_.at(n.first) = part;
    parts_[n.first].points = points[n.first];
    return;
  }
  Part before = part, after = part;
  before.last[n.axis] = after.first[n.axis] = n.plane;
  find_parts(n.first, before, points);
  find_parts(n.last, after, points);
}

std::uint32_t SpacePartition::cut(std::span<SpaceCount::Entry> entries, int level, Part part,
                                  std::uint64_t most_points) {
  const auto node = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  part.points = 0;
  SpaceCell low = SpaceCell::Constant(kSpaceCells), high = SpaceCell::Zero();
  for (const SpaceCount::Entry& e : entries) {
    part.points += e.points;
    low = low.min(e.cell);
    high = high.max(e.cell);
  }
  std::array<int, 3> axes = {0, 1, 2};
  const SpaceCell extent = high - low;
  std::ranges::stable_sort(axes, [&](int a, int b) { return extent[a] > extent[b]; });
  if (part.points <= most_points || entries.size() < 2) {
    nodes_[node].first = static_cast<std::uint32_t>(parts_.size());
    parts_.push_back(part);
    return node;
  }
  const int axis = axes[0];
  std::ranges::stable_sort(entries, {}, [&](const SpaceCount::Entry& e) { return e.cell[axis]; });
  const std::size_t at = middle(entries, axis, part.points);
  const int plane = entries[at].cell[axis] << level;
  Part before = part, after = part;
  before.last[axis] = after.first[axis] = plane;
  nodes_[node].axis = axis;
  nodes_[node].plane = plane;
  const std::uint32_t first = cut(entries.first(at), level, before, most_points);
  const std::uint32_t last = cut(entries.subspan(at), level, after, most_points);
  nodes_[node].first = first;
  nodes_[node].last = last;
  return node;
}

std::size_t SpacePartition::part_of(const SpaceCell& cell) const {
  const Node* node = &nodes_.front();
  while (node->axis >= 0) {
    node = &nodes_[cell[node->axis] < node->plane ? node->first : node->last];
  }
  return node->first;
}

}  // namespace emax
