#include "host/app/piece_meter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "host/measure/point_distances.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

std::vector<FarthestPoint> farthest_of(const ScanPieces::Piece& piece,
                                       std::span<const double> distances, std::size_t most) {
  std::set<FarthestPoint> farthest;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const FarthestPoint point = {distances[i], piece.numbers[i], piece.first + i, piece.points[i]};
    if (farthest.size() == most && !(point < *farthest.rbegin())) continue;
    farthest.insert(point);
    if (farthest.size() > most) farthest.erase(std::prev(farthest.end()));
  }
  return {farthest.begin(), farthest.end()};
}

}  // namespace

PieceMeter::PieceMeter(const TriangleMesh& mesh, const TriangleMesh* reference,
                       const Normalization& normalization, bool brute_force, std::size_t threads)
    : mesh_(&mesh),
      reference_(reference),
      normalization_(normalization),
      brute_force_(brute_force),
      exact_of_mesh_(begun(&mesh)),
      exact_of_reference_(begun(reference)),
      kernel_(std::in_place, mesh.view(), normalization, brute_force, threads),
      exact_(exact_of_mesh_.get()),
      exact_reference_(exact_of_reference_.get()),
      certificate_(std::in_place, *exact_) {
  if (exact_reference_) of_reference_.emplace(*exact_reference_);
}

PieceMeter::PieceMeter(std::unique_ptr<const PartwiseDistances> parts)
    : parts_(std::move(parts)),
      normalization_(parts_->scan().normalization()),
      certificate_(std::in_place) {}

std::unique_ptr<PieceMeter> meter_of(const ScanPieces& scan, const MeasuredMesh& mesh,
                                     const TriangleMesh* reference,
                                     const PartwiseOptions& options) {
  if (!mesh.is_whole()) {
    return std::make_unique<PieceMeter>(
        std::make_unique<const PartwiseDistances>(scan, mesh, options));
  }
  return std::make_unique<PieceMeter>(mesh.whole(), reference, scan.normalization(),
                                      options.brute_force, processor_threads());
}

std::future<PieceMeter::Exact> PieceMeter::begun(const TriangleMesh* mesh) {
  return std::async(std::launch::async, [mesh] {
    return mesh ? std::make_unique<const ExactMesh>(mesh->view()) : nullptr;
  });
}

PieceFindings PieceMeter::measure(const ScanPieces::Piece& piece, const PieceQuestion& question,
                                  const std::function<bool()>& interrupted) {
  PieceFindings found;
  found.first = piece.first;
  found.points = piece.points.size();
  const std::vector<std::uint32_t> excluded = piece.indices_of(question.excluded);
  std::vector<double> uppers;  // where they are known
  if (parts_) {
    for (const LeastDistance& least : parts_->of(piece)) {
      uppers.push_back(least.upper);
      found.squared_bits.push_back(least.squared_bits);
    }
  } else if (question.worst || question.distances) {
    const auto start = std::chrono::steady_clock::now();
    found.squared_bits = kernel_->squared_distances(piece.points, interrupted);
    found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  if (question.worst) {
    std::vector<std::uint32_t> kept = found.squared_bits;
    for (const std::uint32_t i : excluded) kept[i] = 0;
    found.worst = worst_of(kept);
    found.worst.worst_point = piece.numbers[found.worst.worst_point];
  }
  if (question.distances) {
    find_distances(piece, question, uppers, found);
  } else {
    found.squared_bits = {};
  }
  if (question.certify && parts_) {
    certificate_->add_known(piece.points, piece.numbers, uppers, excluded);
  } else if (question.certify) {
    certificate_->add(piece.points, piece.numbers, excluded);
    if (of_reference_) of_reference_->add(piece.points, piece.numbers, excluded);
  }
  return found;
}

CertifiedError PieceMeter::certified() {
  if (!parts_) return certificate_->finish();
  return certificate_->finish(
      [this](const Point& p, double upper) { return parts_->lower_end(p, upper); });
}

MeshExtent PieceMeter::extent() const {
  return parts_ ? parts_->extent() : MeshExtent(mesh_->view(), normalization_);
}

ExactMesh::Nearest PieceMeter::nearest(const Point& p, std::uint64_t index) const {
  if (!parts_) return exact_->nearest(p);
  const LeastDistance least = parts_->of(index);
  return {{0, least.upper}, least.triangle};
}

// `uppers`: of the exact distances, where they are known; else empty.
void PieceMeter::find_distances(const ScanPieces::Piece& piece, const PieceQuestion& question,
                                std::span<const double> uppers, PieceFindings& found) const {
  const std::optional<double>& limit = question.limit;
  const auto exact_upper = [&](std::size_t i) {
    return uppers.empty() ? exact_->distance(piece.points[i]).upper : uppers[i];
  };
  found.distances.reserve(found.squared_bits.size());
  for (std::size_t i = 0; i < found.squared_bits.size(); ++i) {
    const double distance = in_file_units(normalization(), found.squared_bits[i]);
    const bool is_open = limit && std::abs(distance - *limit) <= question.margin;
    found.distances.push_back(is_open ? exact_upper(i) : distance);
  }
  found.first_number = piece.numbers.first;
  found.listed_numbers.assign(piece.numbers.listed.begin(), piece.numbers.listed.end());
  found.farthest = farthest_of(piece, found.distances, question.farthest);
}

}  // namespace emax
