#include "host/app/partwise_distances.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <mutex>

#include "host/measure/piece_measurement.h"
#include "host/measure/point_distances.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"
#include "sw_model/certify/exact_distance.h"

namespace emax {

namespace {

// Some triangles from all of the mesh, as many as a fraction of a part. A point is near one of
// them, and so looks into few of the parts.
MeshPart sample_of(const MeasuredMesh& mesh) {
  constexpr std::size_t kOfPart = 4;
  const std::size_t most = mesh.part_triangles() / kOfPart + 1;
  const std::size_t stride = static_cast<std::size_t>(*mesh.parts().promised()) / most + 1;
  MeshPart sample;
  TriangleMesh& taken = sample.mesh;
  mesh.parts().read(mesh.part_triangles(), [&](const MeshPart& part) {
    for (std::size_t i = 0; i < part.mesh.triangles.size(); i += stride) {
      const auto first = static_cast<std::uint32_t>(taken.vertices.size());
      const std::array<Point, 3> corners = part.mesh.view().corners(i);
      taken.vertices.insert(taken.vertices.end(), corners.begin(), corners.end());
      taken.triangles.push_back({first, first + 1, first + 2});
    }
  });
  return sample;
}

}  // namespace

// A part of the mesh, prepared for the kernel and the oracle at a time.
class PartwiseDistances::Part {
 public:
  Part(const MeshPart& part, const Normalization& normalization, bool brute_force)
      : first_(part.first),
        every_pair_(brute_force),
        extent_(part.mesh.view(), normalization),
        exact_begun_(std::async(
            std::launch::async,
            [mesh = part.mesh.view()] { return std::make_unique<const ExactMesh>(mesh); })),
        kernel_(part.mesh.view(), normalization, brute_force, processor_threads()),
        exact_(exact_begun_.get()) {}

  const MeshExtent& extent() const { return extent_; }

  // Lowers what the points have from the parts before. Returns the kernel's seconds.
  double lower(std::span<const Point> points, std::vector<LeastDistance>& least,
               const std::function<bool()>& interrupted) const {
    const std::vector<std::uint32_t> chosen = near(points, least);
    if (chosen.empty()) return 0;
    std::vector<Point> near_points;
    std::vector<std::uint32_t> squared_bits;
    for (const std::uint32_t i : chosen) {
      near_points.push_back(points[i]);
      squared_bits.push_back(least[i].squared_bits);
    }
    const auto start = std::chrono::steady_clock::now();
    kernel_.lower(near_points, squared_bits, interrupted);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    for (std::size_t n = 0; n < chosen.size(); ++n) {
      LeastDistance& l = least[chosen[n]];
      ExactMesh::Nearest nearest = {{0, l.upper}, l.triangle};
      exact_->lower(near_points[n], first_, nearest);
      l = {nearest.distance.upper, squared_bits[n], nearest.triangle};
    }
    return took.count();
  }

 private:
  // All points but those whose distances are less than that of the box of the part, by more than
  // the error of the kernel.
  std::vector<std::uint32_t> near(std::span<const Point> points,
                                  std::span<const LeastDistance> least) const {
    const Normalization& normalization = kernel_.normalization();
    double greatest = 0;
    for (const LeastDistance& l : least) {
      greatest = std::max({greatest, l.upper, in_file_units(normalization, l.squared_bits)});
    }
    const double margin = point_distance_margin(normalization, extent_, greatest);
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const double gap =
          (extent_.lower - points[i]).cwiseMax(points[i] - extent_.upper).cwiseMax(0.0).norm();
      const double so_far =
          std::max(least[i].upper, in_file_units(normalization, least[i].squared_bits));
      const bool is_beyond = gap > so_far + margin;  // not for what is not finite
      if (every_pair_ || !is_beyond) chosen.push_back(i);
    }
    return chosen;
  }

  std::uint32_t first_;
  bool every_pair_;
  MeshExtent extent_;
  std::future<std::unique_ptr<const ExactMesh>> exact_begun_;
  PieceMeasurement kernel_;
  std::unique_ptr<const ExactMesh> exact_;
};

PartwiseDistances::PartwiseDistances(const ScanPieces& scan, const MeasuredMesh& mesh,
                                     const PartwiseOptions& options)
    : scan_(scan), mesh_(mesh), store_(scan.points(), options.memory, scan.scan().path.string()) {
  if (*mesh.parts().promised() > mesh.part_triangles()) bound(sample_of(mesh), options);
  mesh.parts().read(mesh.part_triangles(), [&](const MeshPart& part) { measure(part, options); });
}

void PartwiseDistances::bound(const MeshPart& sample, const PartwiseOptions& options) {
  const Part prepared(sample, scan_.normalization(), options.brute_force);
  scan_.for_each(processor_threads(), [&](const ScanPieces::Piece& piece) {
    std::vector<LeastDistance> least(piece.points.size());
    prepared.lower(piece.points, least, options.interrupted);
    // A little farther, so that the part that has the triangle finds it again, with its number.
    for (LeastDistance& l : least) {
      l.upper = std::nextafter(l.upper, std::numeric_limits<double>::infinity());
    }
    store_.put(piece.first, least);
  });
  is_begun_ = true;
}

void PartwiseDistances::measure(const MeshPart& part, const PartwiseOptions& options) {
  const Part prepared(part, scan_.normalization(), options.brute_force);
  extent_.join(prepared.extent());
  const auto all = static_cast<double>(*mesh_.parts().promised());
  const double before = static_cast<double>(triangles_) / all;
  const double share = static_cast<double>(part.mesh.triangles.size()) / all;
  const auto points = static_cast<double>(scan_.points());
  std::mutex mutex;
  std::uint64_t done = 0;
  scan_.for_each(processor_threads(), [&](const ScanPieces::Piece& piece) {
    std::vector<LeastDistance> least(piece.points.size());
    if (is_begun_ && !EMAX_FAULT(kForgetsParts)) store_.get(piece.first, least);
    const double seconds = prepared.lower(piece.points, least, options.interrupted);
    store_.put(piece.first, least);
    const std::lock_guard lock(mutex);
    kernel_seconds_ += seconds;
    done += least.size();
    const double so_far = before + share * static_cast<double>(done) / points;
    if (options.advance) options.advance(std::min(so_far, 1.0));
  });
  triangles_ += part.mesh.triangles.size();
  is_begun_ = true;
}

std::vector<LeastDistance> PartwiseDistances::of(const ScanPieces::Piece& piece) const {
  std::vector<LeastDistance> least(piece.points.size());
  store_.get(piece.first, least);
  return least;
}

LeastDistance PartwiseDistances::of(std::uint64_t index) const {
  LeastDistance least;
  store_.get(index, {&least, 1});
  return least;
}

double PartwiseDistances::lower_end(const Point& p, double upper) const {
  double lower = upper;
  MeshExtent extent;
  mesh_.parts().read(mesh_.part_triangles(), [&](const MeshPart& part) {
    lower = std::min(lower, emax::lower_end(p, part.mesh.view(), upper));
    extent.join(MeshExtent(part.mesh.view(), scan_.normalization()));
  });
  if (extent != extent_) {
    throw Error(mesh_.path().string() +
                ": was changed while it was read; leave it as it is meanwhile");
  }
  return lower;
}

}  // namespace emax
