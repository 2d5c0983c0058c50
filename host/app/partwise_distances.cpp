#include "host/app/partwise_distances.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>

#include "host/measure/piece_measurement.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/base/parallel.h"
#include "sw_model/certify/exact_distance.h"

namespace emax {

// A part of the mesh, prepared for the kernel and the oracle at a time.
class PartwiseDistances::Part {
 public:
  Part(const MeshPart& part, const Normalization& normalization, bool brute_force)
      : first_(part.first),
        exact_begun_(std::async(
            std::launch::async,
            [mesh = part.mesh.view()] { return std::make_unique<const ExactMesh>(mesh); })),
        kernel_(part.mesh.view(), normalization, brute_force, processor_threads()),
        exact_(exact_begun_.get()) {}

  // Lowers what the points have from the parts before. Returns the kernel's seconds.
  double lower(std::span<const Point> points, std::vector<LeastDistance>& least,
               const std::function<bool()>& interrupted) const {
    std::vector<std::uint32_t> squared_bits;
    for (const LeastDistance& l : least) squared_bits.push_back(l.squared_bits);
    const auto start = std::chrono::steady_clock::now();
    kernel_.lower(points, squared_bits, interrupted);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    for (std::size_t i = 0; i < points.size(); ++i) {
      ExactMesh::Nearest nearest = {{0, least[i].upper}, least[i].triangle};
      exact_->lower(points[i], first_, nearest);
      least[i] = {nearest.distance.upper, squared_bits[i], nearest.triangle};
    }
    return took.count();
  }

 private:
  std::uint32_t first_;
  std::future<std::unique_ptr<const ExactMesh>> exact_begun_;
  PieceMeasurement kernel_;
  std::unique_ptr<const ExactMesh> exact_;
};

PartwiseDistances::PartwiseDistances(const ScanPieces& scan, const MeasuredMesh& mesh,
                                     const PartwiseOptions& options)
    : scan_(scan), mesh_(mesh), store_(scan.points(), options.memory, scan.scan().path.string()) {
  mesh.parts().read(mesh.part_triangles(), [&](const MeshPart& part) { measure(part, options); });
}

void PartwiseDistances::measure(const MeshPart& part, const PartwiseOptions& options) {
  extent_.join(MeshExtent(part.mesh.view(), scan_.normalization()));
  const Part prepared(part, scan_.normalization(), options.brute_force);
  const auto all = static_cast<double>(*mesh_.parts().promised());
  const double before = static_cast<double>(triangles_) / all;
  const double share = static_cast<double>(part.mesh.triangles.size()) / all;
  const auto points = static_cast<double>(scan_.points());
  std::mutex mutex;
  std::uint64_t done = 0;
  scan_.for_each(processor_threads(), [&](const ScanPieces::Piece& piece) {
    std::vector<LeastDistance> least(piece.points.size());
    if (triangles_ > 0 && !EMAX_FAULT(kForgetsParts)) store_.get(piece.first, least);
    const double seconds = prepared.lower(piece.points, least, options.interrupted);
    store_.put(piece.first, least);
    const std::lock_guard lock(mutex);
    kernel_seconds_ += seconds;
    done += least.size();
    const double so_far = before + share * static_cast<double>(done) / points;
    if (options.advance) options.advance(std::min(so_far, 1.0));
  });
  triangles_ += part.mesh.triangles.size();
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
