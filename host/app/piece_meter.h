#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host/app/partwise_distances.h"
#include "host/app/scan_pieces.h"
#include "host/geometry/triangle_mesh.h"
#include "host/measure/piece_measurement.h"
#include "sw_model/certify/certificate.h"
#include "sw_model/certify/exact_distance.h"
#include "sw_model/model/emax_model.h"

namespace emax {

// What is asked of every piece of a cloud.
struct PieceQuestion {
  bool worst = false;                // the kernel's worst point of those that are not excluded
  bool distances = false;            // the kernel's distance of every point
  bool certify = true;               // the points are added to the certificates
  std::optional<double> limit = {};  // distances within `margin` of it are exact ones
  double margin = 0;
  std::size_t farthest = 1;                  // that many, where distances are asked
  std::vector<std::uint32_t> excluded = {};  // numbers in the file, ascending
};

// A point that is among the farthest of a cloud.
struct FarthestPoint {
  double distance;
  std::uint32_t number;  // in the file
  std::uint64_t index;   // in the cloud
  Point at;
  // The farthest first.
  bool operator<(const FarthestPoint& other) const {
    return distance != other.distance ? distance > other.distance : index < other.index;
  }
};

// What is found of a piece.
struct PieceFindings {
  std::uint64_t first = 0;  // the index of its first point in the cloud
  std::uint64_t points = 0;
  EmaxResult worst = {};  // its point by its number in the file

  // Where distances are asked:
  std::vector<std::uint32_t> squared_bits;
  std::vector<double> distances;  // in the cloud's unit, the exact ones among them
  std::uint32_t first_number = 0;
  std::vector<std::uint32_t> listed_numbers;
  std::vector<FarthestPoint> farthest;
  double seconds = 0;  // of the kernel

  PointNumbers numbers() const { return {first_number, listed_numbers}; }
};

// Measures pieces of a cloud against one mesh, by the kernel, and certifies them. For a mesh in
// parts it takes what is known of the points.
class PieceMeter {
 public:
  // `reference`: another mesh that the points are certified against; nullptr: none. The meshes must
  // outlive this. `threads`: those that prepare the mesh. Throws as PreparedMesh and ExactMesh do.
  PieceMeter(const TriangleMesh& mesh, const TriangleMesh* reference,
             const Normalization& normalization, bool brute_force, std::size_t threads);

  // Of a mesh that was measured part by part.
  explicit PieceMeter(std::unique_ptr<const PartwiseDistances> parts);

  // Several threads may measure pieces at a time. Throws Interrupted when `interrupted` returns
  // true.
  PieceFindings measure(const ScanPieces::Piece& piece, const PieceQuestion& question,
                        const std::function<bool()>& interrupted = nullptr);

  const PartwiseDistances* parts() const { return parts_.get(); }  // nullptr: the mesh is whole
  const TriangleMesh& mesh() const { return *mesh_; }              // if it is whole
  const TriangleMesh* reference() const { return reference_; }
  const ExactMesh& exact() const { return *exact_; }  // likewise
  // The end of a point's distance and the nearest triangle, of the point with this index.
  ExactMesh::Nearest nearest(const Point& p, std::uint64_t index) const;
  MeshExtent extent() const;
  const Normalization& normalization() const { return normalization_; }
  bool brute_force() const { return brute_force_; }
  // Of the points that were certified.
  PiecewiseCertificate& certificate() { return *certificate_; }
  CertifiedError certified();  // once all are
  PiecewiseCertificate* certificate_of_reference() {
    return of_reference_ ? &*of_reference_ : nullptr;
  }

 private:
  void find_distances(const ScanPieces::Piece& piece, const PieceQuestion& question,
                      std::span<const double> uppers, PieceFindings& found) const;

  using Exact = std::unique_ptr<const ExactMesh>;
  static std::future<Exact> begun(const TriangleMesh* mesh);

  std::unique_ptr<const PartwiseDistances> parts_;  // in place of the mesh
  const TriangleMesh* mesh_ = nullptr;
  const TriangleMesh* reference_ = nullptr;
  Normalization normalization_;
  bool brute_force_ = false;
  std::future<Exact> exact_of_mesh_, exact_of_reference_;  // made beside the kernel's
  std::optional<PieceMeasurement> kernel_;
  Exact exact_, exact_reference_;
  std::optional<PiecewiseCertificate> certificate_;
  std::optional<PiecewiseCertificate> of_reference_;
};

// The meter of a mesh and, if it is whole, of a reference or none. A mesh in parts is measured now.
// All must outlive the meter. Throws Error as PieceMeter and PartwiseDistances do.
std::unique_ptr<PieceMeter> meter_of(const ScanPieces& scan, const MeasuredMesh& mesh,
                                     const TriangleMesh* reference, const PartwiseOptions& options);

}  // namespace emax
