#include "host/block_search/block_search.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "hls/kernel/point_triangle.h"
#include "hls/kernel/reduce.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/model/emax_model.h"
#include "sw_model/model/error_bound.h"
#include "sw_model/simd/emax_simd.h"

namespace emax {
namespace {

constexpr std::size_t kHintTriangles = 8;
constexpr std::size_t kSeedGroups = 4;  // of each block that is prepared before R is known

// Greater distance first, then the lower index.
bool is_worse(const EmaxResult& a, const EmaxResult& b) {
  return a.squared_bits > b.squared_bits ||
         (a.squared_bits == b.squared_bits && a.worst_point < b.worst_point);
}

// Sends blocks and keeps R, the worst of the answers so far.
class Pipeline {
 public:
  Pipeline(const PreparedCloud& cloud, const TriangleTree& mesh, Evaluator& evaluator,
           const SearchOptions& options, std::vector<std::uint32_t>* listed)
      : evaluator_(evaluator), options_(options), listed_(listed) {
    std::vector<std::uint32_t> order;
    order.reserve(cloud.points().size());
    for (const PointGroup& group : cloud.groups()) {
      order.insert(order.end(), group.points.begin(), group.points.end());
    }
    evaluator_.lay_out(order);
    evaluator_.begin(cloud.points(), mesh.records());
  }

  // Call this before each block is prepared.
  void make_room() {
    if (options_.interrupted && options_.interrupted()) {
      drain();
      throw Interrupted{};
    }
    if (in_flight_.size() >= options_.depth) collect();
  }

  void submit(Block block) {
    evaluator_.submit(block, listed_ != nullptr);
    in_flight_.push_back(std::move(block.points));
  }

  void drain() {
    while (!in_flight_.empty()) collect();
  }

  const std::optional<EmaxResult>& worst() const { return worst_; }

 private:
  void collect() {
    const BlockAnswer answer = evaluator_.collect();
    if (!worst_ || is_worse(answer.worst, *worst_)) worst_ = answer.worst;
    if (listed_ != nullptr) {
      for (std::size_t i = 0; i < answer.squared_bits.size(); ++i) {
        (*listed_)[in_flight_.front()[i]] = answer.squared_bits[i];
      }
    }
    in_flight_.pop_front();
  }

  Evaluator& evaluator_;
  const SearchOptions& options_;
  std::vector<std::uint32_t>* listed_;
  std::deque<std::vector<std::uint32_t>> in_flight_;
  std::optional<EmaxResult> worst_;
};

class Search {
 public:
  Search(const PreparedCloud& cloud, const TriangleTree& mesh, const SearchOptions& options)
      : cloud_(cloud), mesh_(mesh), options_(options), stamp_(mesh.records().size(), 0) {
    bounds_.reserve(cloud.groups().size());
    for (const PointGroup& group : cloud.groups()) bounds_.push_back(upper_bound(group));
  }

  // Walks all groups that R does not settle, those with the greatest bound first, so that R rises
  // early.
  void walk(Pipeline& pipeline, std::size_t block_points, bool use_running_maximum) {
    std::vector<std::size_t> by_bound(bounds_.size());
    std::iota(by_bound.begin(), by_bound.end(), std::size_t{0});
    std::stable_sort(by_bound.begin(), by_bound.end(),
                     [this](std::size_t a, std::size_t b) { return bounds_[a] > bounds_[b]; });
    std::vector<bool> done(bounds_.size(), false);
    std::size_t next = 0;
    if (use_running_maximum) {
      for (std::size_t seed = 0; seed < options_.depth && next < by_bound.size(); ++seed) {
        Block block;
        pipeline.make_room();
        for (std::size_t i = 0; i < kSeedGroups && next < by_bound.size(); ++i, ++next) {
          add(by_bound[next], block);
          done[by_bound[next]] = true;
        }
        submit(std::move(block), pipeline);
      }
    }
    Block block;
    pipeline.make_room();
    for (std::size_t group = 0; group < bounds_.size(); ++group) {
      if (done[group] || (use_running_maximum && settled(group, pipeline.worst()))) continue;
      if (block.points.size() + PreparedCloud::kGroupPoints > block_points) {
        submit(std::exchange(block, {}), pipeline);
        pipeline.make_room();
        if (use_running_maximum && settled(group, pipeline.worst())) continue;
      }
      add(group, block);
    }
    if (!block.points.empty()) submit(std::move(block), pipeline);
    pipeline.drain();
  }

 private:
  // Whether no point of the group can change R. The bound is a kernel distance, so no margin is
  // needed.
  bool settled(std::size_t group, const std::optional<EmaxResult>& worst) const {
    if (!worst) return false;
    if (bounds_[group] != worst->squared_bits) return bounds_[group] < worst->squared_bits;
    return EMAX_FAULT(kSearchDropsTies) ||
           cloud_.groups()[group].points.front() > worst->worst_point;
  }

  // Kernel bits that no point of the group exceeds. They come from near triangles: a few of the
  // centre, then, round by round, the nearest one of the point that has the bound, until the bound
  // stays or is below another group's that stayed, which R will hardly be below.
  std::uint32_t upper_bound(const PointGroup& group) {
    arrays_.clear();
    for (const std::uint32_t i : group.points) arrays_.push_back(cloud_.points()[i]);
    nearest_.assign(group.points.size(), kInfinityWord);
    const Point centre = group.box.center();
    const TriangleTree::Node& hint = mesh_.hint(centre, kHintTriangles);
    meet(hint.first, hint.last - hint.first);
    meet(nearest_to(centre, hint), 1);
    EmaxResult bound = worst_of(nearest_);
    for (std::size_t i = 0; i < group.points.size() && bound.squared_bits >= greatest_; ++i) {
      const Vector3<float>& point = cloud_.points()[group.points[bound.worst_point]];
      meet(nearest_to({point.x, point.y, point.z}, hint), 1);
      const EmaxResult lower = worst_of(nearest_);
      if (lower.squared_bits == bound.squared_bits) break;
      bound = lower;
    }
    greatest_ = std::max(greatest_, bound.squared_bits);
    return bound.squared_bits;
  }

  void meet(std::size_t first, std::size_t count) {
    simd_.update_nearest(arrays_, mesh_.records().subspan(first, count), nearest_);
  }

  // A record that is nearest to a point, or nearly: it only makes the bound tighter, so plain
  // binary32 without flushing or margin is enough.
  std::uint32_t nearest_to(const Point& p, const TriangleTree::Node& hint) const {
    const Vector3<float> point = {static_cast<float>(p.x()), static_cast<float>(p.y()),
                                  static_cast<float>(p.z())};
    std::uint32_t best = hint.first;
    double best_squared = std::numeric_limits<double>::infinity();
    const auto try_records = [&](const TriangleTree::Node& node) {
      for (std::uint32_t i = node.first; i < node.last; ++i) {
        const TriangleRecord<float>& record = mesh_.records()[i];
        const double squared =
            static_cast<double>(squared_distance(record, (record.tag & kSegmentFlag) != 0, point));
        if (squared < best_squared) {
          best_squared = squared;
          best = i;
        }
      }
    };
    try_records(hint);
    const auto descend = [&](const auto& self, const TriangleTree::Node& node) -> void {
      if (node.is_leaf()) {
        try_records(node);
        return;
      }
      const TriangleTree::Node* near = &mesh_.left(node);
      const TriangleTree::Node* far = &mesh_.right(node);
      double to_near = near->box.squaredExteriorDistance(p);
      double to_far = far->box.squaredExteriorDistance(p);
      if (to_far < to_near) {
        std::swap(near, far);
        std::swap(to_near, to_far);
      }
      if (to_near < best_squared) self(self, *near);
      if (to_far < best_squared) self(self, *far);
    };
    descend(descend, mesh_.root());
    return best;
  }

  void add(std::size_t group, Block& block) {
    const PointGroup& g = cloud_.groups()[group];
    block.points.insert(block.points.end(), g.points.begin(), g.points.end());
    if (block.candidates.empty()) ++epoch_;
    collect_candidates(mesh_.root(), g.box, distance_of(bounds_[group]), block);
  }

  // Every triangle that may be nearest, in the kernel's arithmetic, to some point in the box.
  void collect_candidates(const TriangleTree::Node& node, const Eigen::AlignedBox3d& box,
                          double bound, Block& block) {
    const double lower = std::sqrt(node.box.squaredExteriorDistance(box));
    const double farthest = node.box.min().cwiseAbs().cwiseMax(node.box.max().cwiseAbs()).norm();
    const double margin = EMAX_FAULT(kSearchWithoutMargin)
                              ? 0
                              : kernel_distance_margin(lower, node.box.diagonal().norm(), farthest);
    if (lower - margin > bound) return;
    if (node.is_leaf()) {
      if (std::exchange(stamp_[node.first], epoch_) != epoch_) {
        block.candidates.push_back(node.first);
      }
      return;
    }
    collect_candidates(mesh_.left(node), box, bound, block);
    collect_candidates(mesh_.right(node), box, bound, block);
  }

  void submit(Block block, Pipeline& pipeline) {
    std::sort(block.points.begin(), block.points.end());
    std::sort(block.candidates.begin(), block.candidates.end());
    pipeline.submit(std::move(block));
  }

  const PreparedCloud& cloud_;
  const TriangleTree& mesh_;
  const SearchOptions& options_;
  const SimdTarget& simd_ = simd_targets().front();
  PointArrays arrays_;
  std::vector<std::uint32_t> nearest_;
  std::vector<std::uint32_t> bounds_;  // by group
  std::uint32_t greatest_ = 0;         // of these bounds so far
  std::vector<std::uint32_t> stamp_;   // by record: the last block it became a candidate of
  std::uint32_t epoch_ = 0;
};

void send_all_pairs(Pipeline& pipeline, std::size_t points, std::size_t records,
                    std::size_t block_points) {
  std::vector<std::uint32_t> all(records);
  std::iota(all.begin(), all.end(), 0u);
  for (std::uint32_t first = 0; first < points;) {
    Block block;
    block.candidates = all;
    pipeline.make_room();
    while (first < points && block.points.size() < block_points) block.points.push_back(first++);
    pipeline.submit(std::move(block));
  }
  pipeline.drain();
}

}  // namespace

EmaxResult search_emax(const PreparedCloud& cloud, const TriangleTree& mesh, Evaluator& evaluator,
                       const SearchOptions& options) {
  Pipeline pipeline(cloud, mesh, evaluator, options, nullptr);
  Search(cloud, mesh, options).walk(pipeline, evaluator.block_points(), true);
  return *pipeline.worst();
}

std::vector<std::uint32_t> search_nearest(const PreparedCloud& cloud, const TriangleTree& mesh,
                                          Evaluator& evaluator, const SearchOptions& options) {
  std::vector<std::uint32_t> squared_bits(cloud.points().size());
  Pipeline pipeline(cloud, mesh, evaluator, options, &squared_bits);
  Search(cloud, mesh, options).walk(pipeline, evaluator.block_points(), false);
  return squared_bits;
}

EmaxResult brute_force_emax(const PreparedCloud& cloud, const TriangleTree& mesh,
                            Evaluator& evaluator, const SearchOptions& options) {
  Pipeline pipeline(cloud, mesh, evaluator, options, nullptr);
  send_all_pairs(pipeline, cloud.points().size(), mesh.records().size(), evaluator.block_points());
  return *pipeline.worst();
}

std::vector<std::uint32_t> brute_force_nearest(const PreparedCloud& cloud, const TriangleTree& mesh,
                                               Evaluator& evaluator, const SearchOptions& options) {
  std::vector<std::uint32_t> squared_bits(cloud.points().size());
  Pipeline pipeline(cloud, mesh, evaluator, options, &squared_bits);
  send_all_pairs(pipeline, cloud.points().size(), mesh.records().size(), evaluator.block_points());
  return squared_bits;
}

}  // namespace emax
