#include "host/geometry/self_intersections.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <span>
#include <utility>

#include "host/geometry/box_pairs.h"
#include "host/geometry/edge_sides.h"
#include "host/geometry/exact_predicates.h"
#include "host/geometry/triangle_pair.h"
#include "sw_model/base/parallel.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

constexpr std::size_t kSamplesOfASlab = 256;

// Of the widest side.
Eigen::Index widest_axis(const MeshView& mesh) {
  Eigen::Index axis = 0;
  if (!mesh.vertices.empty()) {
    const Bounds box = bounds_of(mesh.vertices);
    (0.5 * box.upper - 0.5 * box.lower).maxCoeff(&axis);
  }
  return axis;
}

bool has_area(const MeshView& mesh, std::size_t triangle) {
  const std::array<Point, 3> corners = mesh.corners(triangle);
  return !repeats_index(mesh.triangles[triangle]) && !collinear(corners[0], corners[1], corners[2]);
}

// The triangles that reach into each of the slabs between planes across an axis.
class Slabs {
 public:
  Slabs(const MeshView& mesh, std::size_t triangles_of_a_slab)
      : mesh_(mesh), axis_(widest_axis(mesh)) {
    const std::size_t count = mesh.triangles.size() / std::max<std::size_t>(triangles_of_a_slab, 1);
    choose_planes(count + 1);
    begin_of_.assign(planes_.size() + 2, 0);
    std::vector<std::uint8_t> solid(mesh.triangles.size());
    for (std::size_t t = 0; t < solid.size(); ++t) {
      solid[t] = has_area(mesh, t) ? 1 : 0;
      if (solid[t] == 0) {
        ++flat_;
        continue;
      }
      const auto [first, last] = slabs_of(t);
      for (std::size_t s = first; s <= last; ++s) ++begin_of_[s + 1];
    }
    for (std::size_t s = 1; s < begin_of_.size(); ++s) begin_of_[s] += begin_of_[s - 1];
    triangles_.resize(begin_of_.back());
    std::vector<std::size_t> next = begin_of_;
    for (std::size_t t = 0; t < solid.size(); ++t) {
      if (solid[t] == 0) continue;
      const auto [first, last] = slabs_of(t);
      for (std::size_t s = first; s <= last; ++s) {
        triangles_[next[s]++] = static_cast<std::uint32_t>(t);
      }
    }
  }

  std::size_t size() const { return begin_of_.size() - 1; }
  std::size_t flat() const { return flat_; }

  std::span<const std::uint32_t> operator[](std::size_t slab) const {
    return std::span(triangles_).subspan(begin_of_[slab], begin_of_[slab + 1] - begin_of_[slab]);
  }

  // Two overlapping boxes are both in the slab in which the later of the two begins.
  bool is_of(std::size_t slab, const Bounds& a, const Bounds& b) const {
    return slab_of(std::max(a.lower[axis_], b.lower[axis_])) == slab;
  }

 private:
  void choose_planes(std::size_t slabs) {
    if (slabs == 1) return;
    std::vector<double> samples;
    const std::size_t step =
        std::max<std::size_t>(1, mesh_.triangles.size() / (slabs * kSamplesOfASlab));
    for (std::size_t t = 0; t < mesh_.triangles.size(); t += step) {
      samples.push_back(bounds_of(mesh_.corners(t)).lower[axis_]);
    }
    std::ranges::sort(samples);
    for (std::size_t s = 1; s < slabs; ++s) planes_.push_back(samples[s * samples.size() / slabs]);
    planes_.erase(std::unique(planes_.begin(), planes_.end()), planes_.end());
  }

  std::size_t slab_of(double coordinate) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(planes_, coordinate) -
                                    planes_.begin());
  }
  std::pair<std::size_t, std::size_t> slabs_of(std::size_t t) const {
    const Bounds box = bounds_of(mesh_.corners(t));
    return {slab_of(box.lower[axis_]), slab_of(box.upper[axis_])};
  }

  MeshView mesh_;
  Eigen::Index axis_;
  std::vector<double> planes_;  // ascending
  std::vector<std::size_t> begin_of_;
  std::vector<std::uint32_t> triangles_;
  std::size_t flat_ = 0;
};

}  // namespace

SelfIntersections self_intersections(const MeshView& mesh, std::size_t threads,
                                     std::size_t triangles_of_a_slab) {
  const Slabs slabs(mesh, triangles_of_a_slab);
  SelfIntersections found;
  found.flat = slabs.flat();
  std::mutex mutex;
  in_pieces(threads, slabs.size(), 1, [&](std::size_t, std::size_t slab, std::size_t) {
    const std::span<const std::uint32_t> triangles = slabs[slab];
    std::vector<Bounds> boxes;
    boxes.reserve(triangles.size());
    for (const std::uint32_t t : triangles) boxes.push_back(bounds_of(mesh.corners(t)));
    BoxPairs(boxes).for_each([&](std::uint32_t i, std::uint32_t j) {
      if (!slabs.is_of(slab, boxes[i], boxes[j])) return;
      if (!intersect_beyond_shared(mesh, triangles[i], triangles[j])) return;
      const std::lock_guard lock(mutex);
      ++found.pairs;
      found.triangles.insert(found.triangles.end(), {triangles[i], triangles[j]});
    });
  });
  sort_once(found.triangles);
  return found;
}

}  // namespace emax
