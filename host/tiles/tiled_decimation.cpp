#include "host/tiles/tiled_decimation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

using Effort = DecimationSettings::Effort;

// Where the first cut of a round's tiles lies, as a share of the triangles. Cuts of different
// rounds meet along few lines only.
constexpr std::array<double, 4> kFirstCuts = {0.5, 0.3, 0.62, 0.4};
// The parts of the rounds in the time, roughly.
constexpr std::array<double, 4> kShares = {0.5, 0.2, 0.15, 0.15};

// The free triangles of a tile.
struct Patch {
  std::vector<Triangle> triangles;
  std::optional<BoxTree> tree;
  bool done = false;
};

}  // namespace

class TiledDecimator::Run {
 public:
  Run(const TiledDecimator& whole, const DecimationSettings& settings)
      : whole_(whole),
        settings_(settings),
        reach_(std::max(settings.epsilon,
                        settings.epsilon_back > 0 ? settings.epsilon_back : settings.epsilon)),
        mesh_(whole.reference_),
        seen_(whole.points_.end()) {}

  DecimatedMesh run() {
    for (std::size_t round = 0; round < kFirstCuts.size() && !stopped_; ++round) {
      cut(kFirstCuts[round]);
      decimate_patches(round);
      if (patches_.size() == 1) break;
      if (round == 0 && settings_.early && !stopped_) settings_.early(reached());
    }
    return reached();
  }

 private:
  DecimatedMesh reached() const {
    DecimatedMesh result{compact(), left_out_, stopped_, 0};
    if (points_seen_ == whole_.points_.count()) return result;
    const std::vector<std::uint32_t> near_no_tile = whole_.points_.unseen(seen_);
    result.left_out.insert(result.left_out.end(), near_no_tile.begin(), near_no_tile.end());
    sort_once(result.left_out);
    return result;
  }

  Bounds box_of(const Triangle& t) const {
    return bounds_of(std::array{mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]});
  }

  // Cuts space so that no part has the middles of more triangles of the reference than a tile may,
  // and gives each triangle to the part that has its middle.
  void cut(double first) {
    std::vector<Triangle> all = std::move(mesh_.triangles);
    for (Patch& patch : patches_) {
      all.insert(all.end(), patch.triangles.begin(), patch.triangles.end());
    }
    mesh_.triangles.clear();
    patches_.clear();
    std::vector<Point> middles(whole_.reference_.triangles.size());
    for (std::uint32_t r = 0; r < middles.size(); ++r) middles[r] = box_of_reference(r).midpoint();
    cut(middles, all, first);
    for (Patch& patch : patches_) plant(patch);
  }

  void cut(std::span<Point> middles, std::span<Triangle> triangles, double share) {
    if (middles.size() <= whole_.tile_) {
      patches_.push_back({{triangles.begin(), triangles.end()}, {}, false});
      return;
    }
    const Bounds box = bounds_of(middles);
    Eigen::Index axis;
    (box.upper - box.lower).maxCoeff(&axis);
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(middles.size()));
    std::ranges::nth_element(middles, middles.begin() + at, {},
                             [axis](const Point& p) { return p[axis]; });
    const double plane = middles[static_cast<std::size_t>(at)][axis];
    const auto beyond = std::stable_partition(
        triangles.begin(), triangles.end(),
        [&](const Triangle& t) { return box_of(t).midpoint()[axis] < plane; });
    const auto below = static_cast<std::size_t>(beyond - triangles.begin());
    const auto half = static_cast<std::size_t>(at);
    cut(middles.first(half), triangles.first(below), 0.5);
    cut(middles.subspan(half), triangles.subspan(below), 0.5);
  }

  void plant(Patch& patch) {
    patch.tree.emplace(static_cast<std::uint32_t>(patch.triangles.size()),
                       [this, &patch](std::uint32_t t) { return box_of(patch.triangles[t]); });
  }

  void decimate_patches(std::size_t round) {
    std::size_t done = 0;
    const std::size_t all = std::accumulate(
        patches_.begin(), patches_.end(), std::size_t{0},
        [](std::size_t sum, const Patch& patch) { return sum + patch.triangles.size(); });
    triangles_ = all;
    while (!stopped_) {
      const std::vector<std::size_t> batch = next_batch();
      if (batch.empty()) break;
      std::size_t work = 0;
      for (const std::size_t p : batch) work += patches_[p].triangles.size();
      const double before = round_begin(round) + kShares[round] * share(done, all);
      decimate_batch(batch, round, before, kShares[round] * share(work, all));
      done += work;
    }
  }

  static double share(std::size_t part, std::size_t all) {
    return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(all, 1));
  }
  static double round_begin(std::size_t round) {
    return std::accumulate(kShares.begin(), kShares.begin() + static_cast<std::ptrdiff_t>(round),
                           0.0);
  }

  // Patches that are not done and of which none sees a triangle of another.
  std::vector<std::size_t> next_batch() const {
    std::vector<std::size_t> batch;
    std::vector<std::set<std::size_t>> seen;
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      if (patches_[p].done || patches_[p].triangles.empty()) continue;
      std::set<std::size_t> sees;
      for (const auto& [patch, triangle] : surroundings(p)) sees.insert(patch);
      bool apart = true;
      for (std::size_t i = 0; i < batch.size(); ++i) {
        apart = apart && !sees.contains(batch[i]) && !seen[i].contains(p);
      }
      if (!apart) continue;
      batch.push_back(p);
      seen.push_back(std::move(sees));
    }
    return batch;
  }

  void decimate_batch(const std::vector<std::size_t>& batch, std::size_t round, double before,
                      double part) {
    DecimationSettings own = settings_;
    own.rival = 0;
    own.extent = whole_.extent_;
    own.progress = nullptr;
    own.advanced = nullptr;
    own.early = nullptr;
    if (round == 0 && patches_.size() > 1 && own.effort != Effort::kSweep) {
      own.leaves_room = own.effort != Effort::kCollapse;
      own.effort = Effort::kCollapse;
    }
    std::vector<Origin> origins(batch.size());
    const auto make = [&](std::size_t i) {
      Tile tile = tile_of(batch[i]);
      origins[i] = {tile.vertices, tile.point_numbers};
      return tile;
    };
    std::vector<double> advanced(batch.size());
    std::vector<DecimatedTile> results =
        whole_.runner_.run(batch.size(), make, own, [&](std::size_t i, double done) {
          advanced[i] = std::max(advanced[i], done);
          const double all = std::accumulate(advanced.begin(), advanced.end(), 0.0);
          if (!settings_.advanced) return;
          settings_.advanced(before + part * all / static_cast<double>(batch.size()), triangles_);
        });
    for (std::size_t i = 0; i < batch.size(); ++i) put(batch[i], origins[i], results[i]);
  }

  // Of a tile's vertices and points, their numbers among all.
  struct Origin {
    std::vector<std::uint32_t> vertices, points;
  };

  void put(std::size_t p, const Origin& origin, DecimatedTile& result) {
    Patch& patch = patches_[p];
    triangles_ -= patch.triangles.size() - result.triangles.size();
    const auto first_new = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto old = static_cast<std::uint32_t>(origin.vertices.size());
    mesh_.vertices.insert(mesh_.vertices.end(), result.added.begin(), result.added.end());
    for (Triangle& t : result.triangles) {
      for (std::uint32_t& v : t) v = v < old ? origin.vertices[v] : first_new + (v - old);
    }
    patch.triangles = std::move(result.triangles);
    plant(patch);
    patch.done = true;
    stopped_ = stopped_ || result.interrupted;
    for (const std::uint32_t point : origin.points) {
      if (!seen_[point]) ++points_seen_;
      seen_[point] = true;
    }
    left_out_.insert(left_out_.end(), result.left_out.begin(), result.left_out.end());
  }

  // Triangles of the reference whose box is within a distance of one of the patch's.
  std::vector<std::uint32_t> reference_near(const Patch& patch, double distance) const {
    std::vector<std::uint32_t> near;
    for (const Triangle& t : patch.triangles) {
      whole_.reference_tree_.for_each(inflated(box_of(t), distance),
                                      [&](std::uint32_t r) { near.push_back(r); });
    }
    sort_once(near);
    return near;
  }

  Bounds box_of_reference(std::uint32_t r) const {
    return bounds_of(whole_.reference_.view().corners(r));
  }

  using Place = std::pair<std::size_t, std::uint32_t>;  // patch and triangle in it

  // The triangles of other patches that may be near what the patch is to cover.
  std::vector<Place> surroundings(std::size_t p) const {
    return surroundings(p, reference_near(patches_[p], reach_));
  }

  std::vector<Place> surroundings(std::size_t p, const std::vector<std::uint32_t>& covered) const {
    std::vector<Place> places;
    Bounds around = inflated(patches_[p].tree->bounds(), 2 * reach_);
    for (const std::uint32_t r : covered) {
      around = joined(around, inflated(box_of_reference(r), 2 * reach_));
    }
    for (std::size_t other = 0; other < patches_.size(); ++other) {
      const BoxTree& tree = *patches_[other].tree;
      if (other == p || tree.empty()) continue;
      bool any = false;
      tree.for_each(around, [&any](std::uint32_t) { any = true; });
      if (!any) continue;
      std::vector<std::uint32_t> found;
      for (const std::uint32_t r : covered) {
        tree.for_each(inflated(box_of_reference(r), 2 * reach_),
                      [&](std::uint32_t t) { found.push_back(t); });
      }
      sort_once(found);
      for (const std::uint32_t t : found) places.emplace_back(other, t);
    }
    return places;
  }

  Tile tile_of(std::size_t p) const {
    const Patch& patch = patches_[p];
    const std::vector<std::uint32_t> covered = reference_near(patch, reach_);
    Tile tile;
    Patch all{patch.triangles, {}, false};
    for (const auto& [other, t] : surroundings(p, covered)) {
      all.triangles.push_back(patches_[other].triangles[t]);
    }
    tile.free = patch.triangles.size();
    tile.mesh = part_of(mesh_.vertices, all.triangles, &tile.vertices);
    // The whole tile, with what stays, lies within reach of these.
    std::vector<Triangle> reference;
    std::vector<char> taken(whole_.reference_.triangles.size());
    for (const std::uint32_t r : covered) {
      reference.push_back(whole_.reference_.triangles[r]);
      taken[r] = 1;
    }
    tile.covered = covered.size();
    for (const std::uint32_t r : reference_near(all, 1.5 * reach_)) {
      if (taken[r] == 0) reference.push_back(whole_.reference_.triangles[r]);
    }
    tile.reference = part_of(whole_.reference_.vertices, reference, nullptr);
    std::vector<Bounds> boxes;
    for (const Triangle& t : patch.triangles) boxes.push_back(inflated(box_of(t), reach_));
    for (const NumberedPoint& point : whole_.points_.within(boxes)) {
      tile.point_numbers.push_back(static_cast<std::uint32_t>(point.number));
      tile.points.push_back(point.position);
    }
    return tile;
  }

  // A mesh of its own of some triangles; `numbers`: of its vertices among all.
  static TriangleMesh part_of(const std::vector<Point>& vertices,
                              std::span<const Triangle> triangles,
                              std::vector<std::uint32_t>* numbers) {
    std::vector<std::uint32_t> used;
    for (const Triangle& t : triangles) used.insert(used.end(), t.begin(), t.end());
    sort_once(used);
    TriangleMesh part;
    for (const std::uint32_t v : used) part.vertices.push_back(vertices[v]);
    for (const Triangle& t : triangles) {
      Triangle& own = part.triangles.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) {
        own[i] = static_cast<std::uint32_t>(std::ranges::lower_bound(used, t[i]) - used.begin());
      }
    }
    if (numbers != nullptr) *numbers = std::move(used);
    return part;
  }

  TriangleMesh compact() const {
    std::vector<Triangle> all = mesh_.triangles;
    for (const Patch& patch : patches_) {
      all.insert(all.end(), patch.triangles.begin(), patch.triangles.end());
    }
    return part_of(mesh_.vertices, all, nullptr);
  }

  const TiledDecimator& whole_;
  const DecimationSettings& settings_;
  const double reach_;
  TriangleMesh mesh_;  // vertices; the triangles are the patches'
  std::vector<Patch> patches_;
  std::vector<bool> seen_;  // the points that a tile was given
  std::uint64_t points_seen_ = 0;
  std::vector<std::uint32_t> left_out_;
  std::size_t triangles_ = 0;
  bool stopped_ = false;
};

TiledDecimator::TiledDecimator(const TriangleMesh& reference, const TilePoints& points,
                               std::size_t triangles_of_a_tile, TileRunner& runner)
    : reference_(reference),
      points_(points),
      extent_(extent_of(reference, reference,
                        std::array{points.bounds().lower, points.bounds().upper})),
      runner_(runner),
      tile_(std::max<std::size_t>(triangles_of_a_tile, 1)),
      reference_tree_(
          static_cast<std::uint32_t>(reference.triangles.size()),
          [&reference](std::uint32_t t) { return bounds_of(reference.view().corners(t)); }) {}

DecimatedMesh TiledDecimator::run(const DecimationSettings& settings) const {
  return Run(*this, settings).run();
}

}  // namespace emax
