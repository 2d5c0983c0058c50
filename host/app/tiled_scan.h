#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "host/app/certified_result.h"
#include "host/app/given_reference.h"
#include "host/app/scan_pieces.h"
#include "host/decimate/certified_decimation.h"
#include "host/tiles/tile.h"
#include "host/tiles/tile_points.h"

namespace emax {

struct TiledScanSettings {
  double epsilon = 0;
  double far = 0;  // points farther than this from the given mesh are joined to it
  std::size_t excludable = 0;
  std::size_t triangles_of_a_tile = 0;
  std::size_t threads = 1;
  std::uint64_t memory = 0;      // bytes for the points that are joined, or looked at for that
  std::filesystem::path folder;  // for the points, where they are not in memory; it exists
  TileRunner* runner = nullptr;
  std::function<bool()> interrupted;
};

// A scan whose surface is decimated in tiles and whose points may be more than the memory holds.
// Where they are changes no byte of a result. Memory, where they are not in it: a bit a point, 128
// bytes for each that is farther from the given mesh than `far` or was looked at beside one, and
// that of pieces and tiles.
class TiledScan {
 public:
  // Measures every point against the mesh. The scan and the mesh must outlive this. Throws Error if
  // too many points are far from the mesh, and Interrupted.
  TiledScan(const ScanPieces& scan, const TriangleMesh& given, TiledScanSettings settings);

  // The given mesh as a reference, with the far points joined. Throws as emax::make_reference().
  GivenReference make_reference(const ReferenceWishes& wishes);

  // Decimates the reference under the bounds of `settings`, and certifies every point of the scan.
  // Points that are excluded are given by their indices in the cloud, or by their numbers in the
  // file where the points are not in memory.
  CertifiedDecimation decimate(const TriangleMesh& reference,
                               const CertifiedDecimationSettings& settings) const;

  // What is proven of a result but for its bounds in both directions. `reference`: that of a
  // two-sided bound, whose distance from the points is found, too.
  ProvenMesh prove(const CertifiedDecimation& made, const TriangleMesh* reference) const;

 private:
  // What is found of the points that are far from the given mesh.
  struct FarFromMesh {
    std::vector<std::pair<double, std::uint32_t>> beyond;  // epsilon: -distance, number in the file
    std::vector<NumberedPoint> points;                     // beyond `far`
  };
  struct Joined {
    GivenReference reference;
    std::size_t missed;  // kept points that are farther than `far` from it
  };
  using Choice = std::function<bool(const Point&, std::uint32_t)>;

  FarFromMesh far_in(const ScanPieces::Piece& piece, const ExactMesh& mesh) const;
  void require_room(std::size_t far) const;
  void exclude_farthest(std::size_t count);
  // Adds to `kept` the points that it had to look at.
  Joined join(const ReferenceWishes& wishes, std::vector<NumberedPoint>& kept) const;
  void add_around(const std::vector<NumberedPoint>& lost, double reach,
                  std::vector<NumberedPoint>& kept) const;
  // The points that are not excluded and for which the choice holds, in the order of their numbers.
  std::vector<NumberedPoint> chosen(const Choice& choice) const;
  std::vector<NumberedPoint> sample() const;
  std::vector<NumberedPoint> far_points() const;
  CertifiedDecimation decimate(const TriangleMesh& reference,
                               const CertifiedDecimationSettings& settings,
                               const TilePoints& points) const;
  CertifiedDecimation in_indices(CertifiedDecimation made) const;
  CertifiedError in_indices(CertifiedError error) const;

  const ScanPieces& scan_;
  const TriangleMesh& given_;
  TiledScanSettings settings_;
  FarFromMesh far_;                      // ascending
  std::vector<std::uint32_t> outliers_;  // numbers in the file, ascending
};

}  // namespace emax
