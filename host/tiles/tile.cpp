#include "host/tiles/tile.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <stdexcept>

#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

using Corner = std::array<double, 3>;
using Corners = std::array<Corner, 3>;

// The corners in their sense of rotation, the least first.
Corners corners_of(const TriangleMesh& mesh, const Triangle& t, std::size_t& first) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& p = mesh.vertices[t[i]];
    corners[i] = {p[0], p[1], p[2]};
  }
  first = static_cast<std::size_t>(std::ranges::min_element(corners) - corners.begin());
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first), corners.end());
  return corners;
}

// The triangles of the tile's mesh that stay, by corners.
class KeptTriangles {
 public:
  explicit KeptTriangles(const Tile& tile) : tile_(tile), fixed_(tile.mesh.vertices.size()) {
    const std::vector<Triangle>& triangles = tile.mesh.triangles;
    for (std::size_t t = tile.free; t < triangles.size(); ++t) {
      for (const std::uint32_t v : triangles[t]) fixed_[v] = true;
    }
    for (auto t = static_cast<std::uint32_t>(tile.free); t < triangles.size(); ++t) {
      std::size_t first = 0;
      const Corners corners = corners_of(tile.mesh, triangles[t], first);
      kept_.push_back({corners, t, static_cast<std::uint32_t>(first)});
    }
    std::ranges::sort(kept_, {}, &Kept::corners);
  }

  std::vector<Point> fixed_places() const {
    std::vector<Point> places;
    for (std::size_t v = 0; v < fixed_.size(); ++v) {
      if (fixed_[v]) places.push_back(tile_.mesh.vertices[v]);
    }
    return places;
  }

  // How many there are.
  std::size_t size() const { return kept_.size(); }

  // Whether a triangle of another mesh is one of them; `same` has the same corners one by one, by
  // their numbers in the tile.
  bool find(const TriangleMesh& mesh, const Triangle& t, Triangle& same) const {
    std::size_t first = 0;
    const Corners corners = corners_of(mesh, t, first);
    const auto kept = std::ranges::lower_bound(kept_, corners, {}, &Kept::corners);
    if (kept == kept_.end() || kept->corners != corners) return false;
    const Triangle& its = tile_.mesh.triangles[kept->triangle];
    for (std::size_t i = 0; i < 3; ++i) same[(first + i) % 3] = its[(kept->first + i) % 3];
    return true;
  }

 private:
  struct Kept {
    Corners corners;
    std::uint32_t triangle, first;
  };
  const Tile& tile_;
  std::vector<bool> fixed_;
  std::vector<Kept> kept_;
};

}  // namespace

DecimatedTile decimate_tile(const Tile& tile, DecimationSettings settings) {
  const KeptTriangles kept(tile);
  if (!EMAX_FAULT(kMovesSeams)) settings.fixed = kept.fixed_places();
  const BoundedDecimator decimator(tile.reference, tile.points, tile.covered);
  const DecimatedMesh decimated = decimator.run(tile.mesh, settings);
  DecimatedTile result;
  result.interrupted = decimated.interrupted;
  for (const std::uint32_t p : decimated.left_out) result.left_out.push_back(tile.point_numbers[p]);

  // What stays says which vertices are the tile's; the others are new.
  std::vector<std::uint32_t> number(decimated.mesh.vertices.size(), kNone);
  std::vector<char> is_kept(decimated.mesh.triangles.size());
  std::size_t found = 0;
  for (std::size_t t = 0; t < decimated.mesh.triangles.size(); ++t) {
    const Triangle& triangle = decimated.mesh.triangles[t];
    Triangle same{};
    if (!kept.find(decimated.mesh, triangle, same)) continue;
    ++found;
    is_kept[t] = 1;
    for (std::size_t i = 0; i < 3; ++i) number[triangle[i]] = same[i];
  }
  if (found != kept.size()) throw std::logic_error("a triangle that is to stay was changed");
  for (std::size_t t = 0; t < decimated.mesh.triangles.size(); ++t) {
    if (is_kept[t] != 0) continue;
    Triangle triangle = decimated.mesh.triangles[t];
    for (std::uint32_t& v : triangle) {
      if (number[v] == kNone) {
        number[v] = static_cast<std::uint32_t>(tile.mesh.vertices.size() + result.added.size());
        result.added.push_back(decimated.mesh.vertices[v]);
      }
      v = number[v];
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

std::vector<DecimatedTile> LocalTiles::run(std::size_t count, const MakeTile& make,
                                           const DecimationSettings& settings,
                                           const Advanced& advanced) {
  std::vector<DecimatedTile> results(count);
  const std::size_t threads = std::clamp<std::size_t>(count, 1, settings.threads);
  std::mutex mutex;
  bool stopped = false;
  in_pieces(threads, count, 1, [&](std::size_t, std::size_t i, std::size_t) {
    DecimationSettings own = settings;
    own.threads = settings.threads / threads;
    own.interrupted = [&] {
      const std::scoped_lock lock(mutex);
      stopped = stopped || (settings.interrupted && settings.interrupted());
      return stopped;
    };
    own.advanced = [&, i](double share, std::size_t) {
      const std::scoped_lock lock(mutex);
      advanced(i, share);
    };
    results[i] = decimate_tile(make(i), own);
  });
  return results;
}

}  // namespace emax
