#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/geometry/bounds.h"
#include "host/tiles/box_tree.h"
#include "host/tiles/cloud_partition.h"

namespace emax {

// The points that a mesh in tiles has to keep to, wherever they are, by their numbers.
class TilePoints {
 public:
  virtual ~TilePoints() = default;

  virtual const Bounds& bounds() const = 0;  // of all points, the excluded ones too
  virtual std::uint64_t end() const = 0;     // above all numbers
  virtual std::uint64_t count() const = 0;
  // The points that lie in any of these boxes or on their faces, in the order of their numbers.
  // Several threads may ask at a time.
  virtual std::vector<NumberedPoint> within(std::span<const Bounds> boxes) const = 0;
  // The numbers of the points that `seen`, of `end()` flags, lacks; they ascend.
  virtual std::vector<std::uint32_t> unseen(const std::vector<bool>& seen) const = 0;
};

// In memory, where they have to outlive this: eight bytes a point for a tree. within() is
// O(boxes log n + found).
class PointsInMemory final : public TilePoints {
 public:
  // Without those of these numbers, which ascend. `numbers`: of each point, ascending; empty: its
  // index is.
  explicit PointsInMemory(std::span<const Point> points, std::vector<std::uint32_t> excluded = {},
                          std::span<const std::uint32_t> numbers = {});

  const Bounds& bounds() const override { return bounds_; }
  std::uint64_t end() const override;
  std::uint64_t count() const override { return points_.size() - excluded_.size(); }
  std::vector<NumberedPoint> within(std::span<const Bounds> boxes) const override;
  std::vector<std::uint32_t> unseen(const std::vector<bool>& seen) const override;

 private:
  std::uint32_t number(std::uint32_t index) const {
    return numbers_.empty() ? index : numbers_[index];
  }
  std::span<const Point> points_;
  std::span<const std::uint32_t> numbers_;
  std::vector<std::uint32_t> excluded_;
  Bounds bounds_;
  BoxTree tree_;
};

// In the files of a partition, which must outlive this: each question reads the parts that the
// boxes touch. Memory for a question is that of a part and of what is found.
class PointsInFiles final : public TilePoints {
 public:
  // Without those of these numbers, which ascend. Reads all parts once, for their boxes.
  PointsInFiles(const CloudPartition& partition, std::vector<std::uint32_t> excluded,
                std::size_t threads);

  const Bounds& bounds() const override { return bounds_; }
  std::uint64_t end() const override { return end_; }
  std::uint64_t count() const override { return partition_.points() - excluded_.size(); }
  std::vector<NumberedPoint> within(std::span<const Bounds> boxes) const override;
  std::vector<std::uint32_t> unseen(const std::vector<bool>& seen) const override;

 private:
  std::vector<NumberedPoint> points_of(std::size_t part) const;

  const CloudPartition& partition_;
  std::vector<std::uint32_t> excluded_;
  std::vector<Bounds> boxes_;  // of the parts' points
  Bounds bounds_;
  std::uint64_t end_ = 0;
};

}  // namespace emax
