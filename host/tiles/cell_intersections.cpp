#include "host/tiles/cell_intersections.h"

#include <algorithm>
#include <array>
#include <bit>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

#include "host/geometry/box_pairs.h"
#include "host/geometry/edge_sides.h"
#include "host/geometry/exact_predicates.h"
#include "host/geometry/triangle_pair.h"
#include "host/tiles/record_bins.h"
#include "host/tiles/sorted_records.h"
#include "host/tiles/space_cells.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

// Two corners are one vertex if their numbers and their positions are equal.
struct CellTriangle {
  std::array<std::array<double, 3>, 3> at;
  std::array<std::uint32_t, 3> numbers;  // in the file, or made of the position
  std::uint32_t triangle;

  std::array<Point, 3> corners() const {
    return {Point(at[0].data()), Point(at[1].data()), Point(at[2].data())};
  }
  Bounds box() const { return bounds_of(corners()); }
};

// A triangle takes as much while its cell is looked at: itself, its box twice and nodes; measured.
constexpr std::uint64_t kBytesInCell = 400;
constexpr std::size_t kMostSamples = std::size_t{1} << 14;

std::uint32_t number_of_place(const Point& p) {
  std::uint64_t hash = 0;
  for (int k = 0; k < 3; ++k) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(p[k])) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 32;
  }
  return static_cast<std::uint32_t>(hash);
}

CellTriangle cell_triangle(const MeshPart& part, std::size_t t) {
  CellTriangle made = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t v = part.mesh.triangles[t][i];
    const Point& p = part.mesh.vertices[v];
    made.at[i] = {p.x(), p.y(), p.z()};
    made.numbers[i] = part.vertex_numbers.empty() ? number_of_place(p) : part.vertex_numbers[v];
  }
  made.triangle = part.first + static_cast<std::uint32_t>(t);
  return made;
}

bool intersect(const CellTriangle& a, const CellTriangle& b) {
  std::array<Point, 6> vertices;
  std::array<Triangle, 2> triangles = {{{0, 1, 2}, {3, 4, 5}}};
  for (std::size_t i = 0; i < 3; ++i) {
    vertices[i] = Point(a.at[i].data());
    vertices[3 + i] = Point(b.at[i].data());
    for (std::size_t j = 0; j < 3; ++j) {
      const bool is_shared = a.numbers[j] == b.numbers[i] && a.at[j] == b.at[i];
      if (is_shared) triangles[1][i] = static_cast<std::uint32_t>(j);
    }
  }
  return intersect_beyond_shared({vertices, triangles}, 0, 1);
}

class CellSearch {
 public:
  CellSearch(const NamedInput& input, std::uint64_t memory, std::size_t threads,
             const std::function<void()>& poll)
      : input_(input),
        bin_memory_(memory / 8),
        most_(std::max<std::size_t>(static_cast<std::size_t>(memory / 2 / threads / kBytesInCell),
                                    4)),
        poll_(poll),
        triangles_(input, memory / 8) {}

  // Takes all of the triangles of a mesh, and gives the counts.
  IntersectionCounts run(const MeshParts& mesh, std::size_t part_triangles, BoxSample sample,
                         std::size_t threads) {
    const double all = static_cast<double>(sample.boxes.size()) * sample.weight;
    const double most = most_in_cell(all, bin_memory_);
    const SpaceCells cells(std::move(sample.boxes), sample.weight, most, {});
    RecordBins<CellTriangle> bins(input_, cells.cells().size(), bin_memory_);
    found_.read = mesh.read(part_triangles, [&](const MeshPart& part) {
      poll_();
      for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
        const std::array<Point, 3> corners = part.mesh.view().corners(t);
        if (repeats_index(part.mesh.triangles[t]) ||
            collinear(corners[0], corners[1], corners[2])) {
          ++found_.flat;
        } else {
          put(cells, cell_triangle(part, t), bins);
        }
      }
    });
    in_pieces(threads, bins.bins(), 1, [&](std::size_t, std::size_t cell, std::size_t) {
      search(bins, cell, cells.cells()[cell]);
    });
    std::optional<std::uint32_t> last;
    triangles_.take([&](std::uint32_t t) {
      if (t != last) ++found_.triangles;
      last = t;
    });
    return found_;
  }

 private:
  using Bins = RecordBins<CellTriangle>;

  // There are no more cells than so many bytes have blocks for.
  double most_in_cell(double triangles, std::uint64_t bytes) const {
    constexpr double kBytesOfABlock = 4096;
    return std::max(static_cast<double>(most_),
                    kBytesOfABlock * triangles / static_cast<double>(bytes + 1));
  }

  static void put(const SpaceCells& cells, const CellTriangle& triangle, Bins& bins) {
    cells.for_each_reached(triangle.box(), EMAX_FAULT(kOneCellEach),
                           [&](std::size_t cell) { bins.add(cell, triangle); });
  }

  void search(const Bins& bins, std::size_t cell, const SpaceCells::Region& region) {
    const std::uint64_t size = bins.size(cell);
    poll_();
    if (size <= most_) {
      meet(bins.read(cell), 0, region);
      return;
    }
    const SpaceCells cells = cut(bins, cell, region);
    if (cells.cells().size() == 1) {
      search_blocks(bins, cell, region);
      return;
    }
    Bins smaller(input_, cells.cells().size(), bin_memory_ / 8);
    bins.for_each(cell, [&](const CellTriangle& t) { put(cells, t, smaller); });
    for (std::size_t c = 0; c < smaller.bins(); ++c) {
      if (smaller.size(c) < size) {
        search(smaller, c, cells.cells()[c]);
      } else {
        search_blocks(smaller, c, cells.cells()[c]);
      }
    }
  }

  SpaceCells cut(const Bins& bins, std::size_t cell, const SpaceCells::Region& region) const {
    const std::uint64_t size = bins.size(cell);
    const std::uint64_t stride = size / std::min<std::uint64_t>(kMostSamples, most_) + 1;
    std::vector<Bounds> sample;
    std::uint64_t i = 0;
    bins.for_each(cell, [&](const CellTriangle& t) {
      if (i++ % stride == 0) sample.push_back(t.box());
    });
    const double most = most_in_cell(static_cast<double>(size), bin_memory_ / 8);
    return {std::move(sample), static_cast<double>(stride), most, region};
  }

  // Every block with itself and with all that follow.
  void search_blocks(const Bins& bins, std::size_t cell, const SpaceCells::Region& region) {
    const std::uint64_t size = bins.size(cell);
    const std::size_t block = most_ / 2;
    const auto read = [&](std::uint64_t first) {
      return bins.read(cell, first,
                       static_cast<std::size_t>(std::min<std::uint64_t>(block, size - first)));
    };
    for (std::uint64_t first = 0; first < size; first += block) {
      meet(read(first), 0, region);
      for (std::uint64_t second = first + block; second < size; second += block) {
        poll_();
        std::vector<CellTriangle> both = read(first);
        const std::size_t split = both.size();
        const std::vector<CellTriangle> others = read(second);
        both.insert(both.end(), others.begin(), others.end());
        meet(both, split, region);
      }
    }
  }

  // With `split`: only those before it with those from it on.
  void meet(const std::vector<CellTriangle>& triangles, std::size_t split,
            const SpaceCells::Region& region) {
    const auto pairs = [&] {
      std::vector<Bounds> boxes;
      boxes.reserve(triangles.size());
      for (const CellTriangle& t : triangles) boxes.push_back(t.box());
      return BoxPairs(boxes);
    }();
    pairs.for_each([&](std::uint32_t i, std::uint32_t j) {
      if (split > 0 && (i < split) == (j < split)) return;
      const CellTriangle &a = triangles[i], &b = triangles[j];
      if (!region.holds(a.box().lower.cwiseMax(b.box().lower)) || !intersect(a, b)) return;
      const std::lock_guard lock(mutex_);
      ++found_.pairs;
      triangles_.add(a.triangle);
      triangles_.add(b.triangle);
    });
  }

  const NamedInput& input_;
  std::uint64_t bin_memory_;
  std::size_t most_;  // triangles that a thread holds
  const std::function<void()>& poll_;
  std::mutex mutex_;                        // of what follows
  SortedRecords<std::uint32_t> triangles_;  // of the pairs
  IntersectionCounts found_;
};

}  // namespace

IntersectionCounts intersections_in_parts(const MeshParts& mesh, std::size_t part_triangles,
                                          std::uint64_t memory, std::size_t threads,
                                          BoxSample sample, const std::function<void()>& poll) {
  return CellSearch(mesh.input(), memory, threads, poll)
      .run(mesh, part_triangles, std::move(sample), threads);
}

}  // namespace emax
