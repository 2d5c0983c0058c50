#include "host/app/piece_meter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "host/measure/point_distances.h"

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
    : mesh_(mesh),
      reference_(reference),
      brute_force_(brute_force),
      exact_of_mesh_(begun(&mesh)),
      exact_of_reference_(begun(reference)),
      kernel_(mesh.view(), normalization, brute_force, threads),
      exact_(exact_of_mesh_.get()),
      exact_reference_(exact_of_reference_.get()),
      certificate_(*exact_) {
  if (exact_reference_) of_reference_.emplace(*exact_reference_);
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
  if (question.worst || question.distances) {
    const auto start = std::chrono::steady_clock::now();
    found.squared_bits = kernel_.squared_distances(piece.points, interrupted);
    found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  if (question.worst) {
    std::vector<std::uint32_t> kept = found.squared_bits;
    for (const std::uint32_t i : excluded) kept[i] = 0;
    found.worst = worst_of(kept);
    found.worst.worst_point = piece.numbers[found.worst.worst_point];
  }
  if (question.distances) {
    find_distances(piece, question, found);
  } else {
    found.squared_bits = {};
  }
  if (question.certify) {
    certificate_.add(piece.points, piece.numbers, excluded);
    if (of_reference_) of_reference_->add(piece.points, piece.numbers, excluded);
  }
  return found;
}

void PieceMeter::find_distances(const ScanPieces::Piece& piece, const PieceQuestion& question,
                                PieceFindings& found) const {
  const std::optional<double>& limit = question.limit;
  found.distances.reserve(found.squared_bits.size());
  for (std::size_t i = 0; i < found.squared_bits.size(); ++i) {
    const double distance = in_file_units(normalization(), found.squared_bits[i]);
    const bool is_open = limit && std::abs(distance - *limit) <= question.margin;
    found.distances.push_back(is_open ? exact_->distance(piece.points[i]).upper : distance);
  }
  found.first_number = piece.numbers.first;
  found.listed_numbers.assign(piece.numbers.listed.begin(), piece.numbers.listed.end());
  found.farthest = farthest_of(piece, found.distances, question.farthest);
}

}  // namespace emax
