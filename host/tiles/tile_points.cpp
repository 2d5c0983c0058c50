#include "host/tiles/tile_points.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "sw_model/base/parallel.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

BoxTree tree_of(std::span<const Point> points) {
  return {static_cast<std::uint32_t>(points.size()), [points](std::uint32_t p) {
            return Bounds{points[p], points[p]};
          }};
}

BoxTree tree_of(std::span<const NumberedPoint> points) {
  return {static_cast<std::uint32_t>(points.size()), [points](std::uint32_t p) {
            return Bounds{points[p].position, points[p].position};
          }};
}

Bounds no_bounds() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {Point::Constant(kInfinity), Point::Constant(-kInfinity)};
}

bool has(const std::vector<std::uint32_t>& ascending, std::uint64_t number) {
  return std::ranges::binary_search(ascending, number);
}

}  // namespace

PointsInMemory::PointsInMemory(std::span<const Point> points, std::vector<std::uint32_t> excluded,
                               std::span<const std::uint32_t> numbers)
    : points_(points),
      numbers_(numbers),
      excluded_(std::move(excluded)),
      bounds_(points.empty() ? no_bounds() : bounds_of(points)),
      tree_(tree_of(points)) {}

std::uint64_t PointsInMemory::end() const {
  if (points_.empty()) return 0;
  return std::uint64_t{number(static_cast<std::uint32_t>(points_.size() - 1))} + 1;
}

std::vector<NumberedPoint> PointsInMemory::within(std::span<const Bounds> boxes) const {
  std::vector<std::uint32_t> indices;
  for (const Bounds& box : boxes) {
    tree_.for_each(box, [&](std::uint32_t p) { indices.push_back(p); });
  }
  sort_once(indices);
  std::vector<NumberedPoint> found;
  for (const std::uint32_t p : indices) {
    if (!has(excluded_, number(p))) found.push_back({points_[p], number(p)});
  }
  return found;
}

std::vector<std::uint32_t> PointsInMemory::unseen(const std::vector<bool>& seen) const {
  std::vector<std::uint32_t> missing;
  for (std::uint32_t p = 0; p < points_.size(); ++p) {
    if (!seen[number(p)] && !has(excluded_, number(p))) missing.push_back(number(p));
  }
  return missing;
}

PointsInFiles::PointsInFiles(const CloudPartition& partition, std::vector<std::uint32_t> excluded,
                             std::size_t threads)
    : partition_(partition),
      excluded_(std::move(excluded)),
      boxes_(partition.parts().size(), no_bounds()),
      bounds_(no_bounds()) {
  std::vector<std::uint64_t> ends(boxes_.size());
  in_pieces(threads, boxes_.size(), 1, [&](std::size_t, std::size_t part, std::size_t) {
    partition.for_each(part, [&](std::span<const NumberedPoint> piece) {
      for (const NumberedPoint& p : piece) {
        boxes_[part] = joined(boxes_[part], Bounds{p.position, p.position});
        ends[part] = std::max(ends[part], p.number + 1);
      }
    });
  });
  for (const Bounds& box : boxes_) bounds_ = joined(bounds_, box);
  for (const std::uint64_t of_part : ends) end_ = std::max(end_, of_part);
}

std::vector<NumberedPoint> PointsInFiles::points_of(std::size_t part) const {
  std::vector<NumberedPoint> points;
  partition_.for_each(part, [&](std::span<const NumberedPoint> piece) {
    for (const NumberedPoint& p : piece) {
      if (!has(excluded_, p.number)) points.push_back(p);
    }
  });
  return points;
}

std::vector<NumberedPoint> PointsInFiles::within(std::span<const Bounds> boxes) const {
  const BoxTree of_boxes(static_cast<std::uint32_t>(boxes.size()),
                         [boxes](std::uint32_t i) { return boxes[i]; });
  std::vector<NumberedPoint> found;
  for (std::size_t part = 0; part < boxes_.size(); ++part) {
    std::vector<std::uint32_t> touching;
    of_boxes.for_each(boxes_[part], [&](std::uint32_t i) { touching.push_back(i); });
    if (touching.empty()) continue;
    const std::vector<NumberedPoint> points = points_of(part);
    const BoxTree of_points = tree_of(points);
    std::vector<char> taken(points.size());
    for (const std::uint32_t i : touching) {
      of_points.for_each(boxes[i], [&](std::uint32_t p) { taken[p] = 1; });
    }
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (taken[p] != 0) found.push_back(points[p]);
    }
  }
  std::ranges::sort(found, {}, &NumberedPoint::number);
  return found;
}

std::vector<std::uint32_t> PointsInFiles::unseen(const std::vector<bool>& seen) const {
  std::vector<std::uint32_t> missing;
  for (std::size_t part = 0; part < boxes_.size(); ++part) {
    for (const NumberedPoint& p : points_of(part)) {
      if (!seen[p.number]) missing.push_back(static_cast<std::uint32_t>(p.number));
    }
  }
  sort_once(missing);
  return missing;
}

}  // namespace emax
