#include "host/tiles/partwise_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <vector>

#include "host/geometry/bounds.h"
#include "host/geometry/merge_vertices.h"
#include "host/geometry/triangle_mesh.h"
#include "host/tiles/record_bins.h"
#include "host/tiles/space_cells.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

// What a triangle takes while it is measured or measured against, with corners of its own.
constexpr std::uint64_t kBytesMeasured = 400;
constexpr double kOnBoth = 0.6;  // the share of triangles that two cells may have in common
constexpr std::uint64_t kMostBoxes = std::uint64_t{1} << 16;

struct LooseTriangle {
  std::array<std::array<double, 3>, 3> at;

  std::array<Point, 3> corners() const {
    return {Point(at[0].data()), Point(at[1].data()), Point(at[2].data())};
  }
};

LooseTriangle loose(const std::array<Point, 3>& corners) {
  LooseTriangle made;
  for (std::size_t i = 0; i < 3; ++i) made.at[i] = {corners[i].x(), corners[i].y(), corners[i].z()};
  return made;
}

TriangleMesh mesh_of(const std::vector<LooseTriangle>& triangles) {
  TriangleMesh mesh;
  mesh.vertices.reserve(3 * triangles.size());
  mesh.triangles.reserve(triangles.size());
  for (const LooseTriangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Point& p : t.corners()) mesh.vertices.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  merge_equal_vertices(mesh.vertices, mesh.triangles);
  return mesh;
}

SurfaceDistance decide(MeshView mesh, const ExactMesh& reference,
                       const PartwiseSurfaceOptions& options) {
  return surface_distance(
      mesh, reference,
      {.relative = 0, .absolute = 0, .limit = options.limit, .poll = options.poll});
}

void join(SurfaceDistance& all, const SurfaceDistance& found) {
  all.lower = std::max(all.lower, found.lower);
  all.upper = std::max(all.upper, found.upper);
  all.cuts += found.cuts;
}

class CellDistances {
 public:
  using Bins = RecordBins<LooseTriangle>;

  CellDistances(MeshView mesh, const MeshParts& reference, const PartwiseSurfaceOptions& options)
      : mesh_(mesh),
        parts_(reference),
        options_(options),
        part_(static_cast<std::size_t>(
            std::max<std::uint64_t>(options.memory / 4 / kBytesMeasured, 1))),
        most_(std::max<std::uint64_t>(options.memory / 2 / options.threads / kBytesMeasured, 4)),
        space_(bounds_of(mesh.vertices)),
        magnitude_(space_.lower.cwiseAbs().cwiseMax(space_.upper.cwiseAbs()).maxCoeff()),
        reach_(options.limit * (1 + 1e-9) + 0x1p-48 * magnitude_),
        stride_(*reference.promised() / std::min(kMostBoxes, options.memory / 400 + 1) + 1),
        cells_(sample(), static_cast<double>(stride_), static_cast<double>(most_) / 2, {}, kOnBoth),
        overhang_(overhang()),
        pieces_(reference.input(), cells_.cells().size(), options.memory / 16),
        references_(reference.input(), cells_.cells().size(), options.memory / 16) {}

  SurfaceDistance run() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) put_piece(mesh_.corners(t), 0);
    const std::uint64_t read = parts_.read(part_, [&](const MeshPart& part) {
      poll();
      for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
        put_reference(part.mesh.view().corners(t));
      }
    });
    if (read != sampled_from_) {
      parts_.input().fail("was changed while it was read", "leave it as it is meanwhile");
    }
    SurfaceDistance all;
    std::mutex mutex;
    in_pieces(options_.threads, cells_.cells().size(), 1,
              [&](std::size_t, std::size_t cell, std::size_t) {
                const SurfaceDistance found = measure(cell);
                const std::lock_guard lock(mutex);
                join(all, found);
              });
    return all;
  }

 private:
  void poll() const {
    if (options_.poll) options_.poll();
  }

  Bounds within_reach(const std::array<Point, 3>& corners) const {
    const Bounds box = bounds_of(corners);
    return {box.lower.array() - reach_, box.upper.array() + reach_};
  }

  std::vector<Bounds> sample() {
    std::vector<Bounds> boxes;
    sampled_from_ = parts_.read(part_, [&](const MeshPart& part) {
      poll();
      for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
        if ((part.first + t) % stride_ != 0) continue;
        boxes.push_back(within_reach(part.mesh.view().corners(t)));
      }
    });
    return boxes;
  }

  // A fraction of a cell's side, and more than roundings.
  double overhang() const {
    const auto cells = static_cast<double>(cells_.cells().size());
    return std::max(space_.width() / (16 * std::sqrt(cells)), 0x1p-48 * magnitude_ + 0x1p-1000);
  }

  // Cuts the longest edge until the triangle lies in one cell, or reaches little beyond that of its
  // lower corner.
  void put_piece(const std::array<Point, 3>& corners, unsigned depth) {
    const Bounds box = bounds_of(corners);
    std::size_t reached = 0, cell = 0;
    cells_.for_each_reached(box, false, [&](std::size_t) { ++reached; });
    if (reached > 1 && box.width() > overhang_) {
      std::array<double, 3> lengths;
      for (std::size_t i = 0; i < 3; ++i) lengths[i] = (corners[(i + 1) % 3] - corners[i]).norm();
      const auto i = static_cast<std::size_t>(std::ranges::max_element(lengths) - lengths.begin());
      const std::size_t j = (i + 1) % 3;
      std::array<Point, 3> first = corners, second = corners;
      first[j] = second[i] = 0.5 * corners[i] + 0.5 * corners[j];
      put_piece(first, depth + 1);
      put_piece(second, depth + 1);
      return;
    }
    cells_.for_each_reached(box, true, [&](std::size_t c) { cell = c; });
    deepest_ = std::max(deepest_, depth);
    pieces_.add(cell, loose(corners));
  }

  void put_reference(const std::array<Point, 3>& corners) {
    Bounds box = within_reach(corners);
    box.lower.array() -= overhang_;
    if (EMAX_FAULT(kForgetsReach)) box = bounds_of(corners);
    cells_.for_each_reached(box, false, [&](std::size_t cell) {
      if (pieces_.size(cell) > 0) references_.add(cell, loose(corners));
    });
  }

  SurfaceDistance measure(std::size_t cell) const {
    poll();
    if (pieces_.size(cell) == 0) return {};
    if (references_.size(cell) > 2 * most_) {
      parts_.input().fail(
          fmt::format("{} of its triangles come near to one part of the mesh, more than the memory "
                      "holds",
                      references_.size(cell)),
          "give more --memory");
    }
    const TriangleMesh reference = mesh_of(references_.read(cell));
    SurfaceDistance all;
    if (reference.triangles.empty()) {
      all.lower = reach_;
      all.upper = std::numeric_limits<double>::infinity();
      return all;
    }
    const ExactMesh exact(reference.view());
    for (std::uint64_t first = 0; first < pieces_.size(cell); first += most_) {
      const auto count = static_cast<std::size_t>(std::min(most_, pieces_.size(cell) - first));
      const TriangleMesh pieces = mesh_of(pieces_.read(cell, first, count));
      SurfaceDistance found = decide(pieces.view(), exact, options_);
      // Beyond the reach another triangle may be nearer.
      found.lower = std::max(std::min(found.lower, reach_) - rounding(), 0.0);
      found.upper =
          std::nextafter(found.upper + rounding(), std::numeric_limits<double>::infinity());
      join(all, found);
    }
    return all;
  }

  // How far cuts have moved the pieces from the triangles: for each cut half a unit in the last
  // place of every coordinate.
  double rounding() const {
    constexpr double kOfACut = 0x1p-52;
    return deepest_ == 0 ? 0 : deepest_ * (kOfACut * magnitude_ + 0x1p-1060);
  }

  MeshView mesh_;
  const MeshParts& parts_;
  const PartwiseSurfaceOptions& options_;
  std::size_t part_;
  std::uint64_t most_;  // triangles that a thread holds of either
  Bounds space_;
  double magnitude_;      // of coordinates
  double reach_;          // a triangle of the reference that is farther does not matter
  std::uint64_t stride_;  // of the sample
  std::uint64_t sampled_from_ = 0;
  SpaceCells cells_;
  double overhang_;
  unsigned deepest_ = 0;
  Bins pieces_, references_;
};

}  // namespace

SurfaceDistance distance_from_parts(const MeshParts& mesh, const ExactMesh& reference,
                                    const PartwiseSurfaceOptions& options) {
  const std::uint64_t part = options.memory / 2 / kBytesMeasured;
  SurfaceDistance all;
  mesh.read(static_cast<std::size_t>(std::max<std::uint64_t>(part, 1)), [&](const MeshPart& p) {
    if (options.poll) options.poll();
    join(all, decide(p.mesh.view(), reference, options));
  });
  return all;
}

SurfaceDistance distance_to_parts(MeshView mesh, const MeshParts& reference,
                                  const PartwiseSurfaceOptions& options) {
  return CellDistances(mesh, reference, options).run();
}

}  // namespace emax
