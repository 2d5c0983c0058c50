#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>

namespace emax {

// The cells of space in which points are counted and between which it is cut: kSide along each axis
// of the cube from -1 to 1, in which normalised clouds lie.
using SpaceCell = Eigen::Array3i;
inline constexpr int kSpaceCells = 1 << 20;
SpaceCell space_cell(const Eigen::Vector3f& normalised);
// Where the cells of this number begin, normalised; exact.
double space_plane(int cell);

// How many points lie where, in cells as small as `most_cells` allow: where more are used, all
// become twice as great. So what is counted does not depend on the order of the points. Safe for
// concurrent use.
class SpaceCount {
 public:
  explicit SpaceCount(std::size_t most_cells = std::size_t{1} << 18) : most_cells_(most_cells) {}

  void add(std::span<const SpaceCell> cells);

  struct Entry {
    SpaceCell cell;  // in cells of 2^level
    std::uint64_t points;
  };
  int level() const { return level_; }
  std::vector<Entry> entries() const;  // in the order of x, y, z

 private:
  void coarsen();

  const std::size_t most_cells_;
  mutable std::mutex mutex_;
  int level_ = 0;
  std::unordered_map<std::uint64_t, std::uint64_t> counts_;
};

// Space cut by planes between cells until no part holds more points than `most_points`, where the
// cells are small enough for that. O(cells log cells log parts).
class SpacePartition {
 public:
  struct Part {
    SpaceCell first = SpaceCell::Zero(), last = SpaceCell::Constant(kSpaceCells);  // to before last
    std::uint64_t points = 0;
  };

  struct Node {
    int axis = -1;                      // -1: a leaf
    int plane = 0;                      // cells before it are the first child's
    std::uint32_t first = 0, last = 0;  // children; the part, of a leaf
  };

  SpacePartition() = default;
  SpacePartition(const SpaceCount& count, std::uint64_t most_points);
  // As another one's nodes, and the points of its parts.
  SpacePartition(std::vector<Node> nodes, std::span<const std::uint64_t> points);

  std::span<const Part> parts() const { return parts_; }
  std::span<const Node> nodes() const { return nodes_; }  // the first is the root
  std::size_t part_of(const SpaceCell& cell) const;

 private:
  void find_parts(std::uint32_t node, const Part& part, std::span<const std::uint64_t> points);
  std::uint32_t cut(std::span<SpaceCount::Entry> entries, int level, Part part,
                    std::uint64_t most_points);

  std::vector<Node> nodes_;
  std::vector<Part> parts_;
};

}  // namespace emax
