#include "host/app/tiled_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <mutex>
#include <utility>

#include "host/app/interrupt.h"
#include "host/app/piece_runner.h"
#include "host/app/point_claims.h"
#include "host/app/proven_decimation.h"
#include "host/tiles/tiled_decimation.h"
#include "sw_model/base/deliberate_fault.h"
#include "sw_model/base/error.h"
#include "sw_model/base/sort_once.h"

namespace emax {
namespace {

// Of the points of a part of the cloud, and of the parts.
constexpr std::uint64_t kLeastOfPart = 1 << 16, kMostParts = 4096;
constexpr std::uint64_t kSample = 1 << 12;           // points that stand for all
constexpr int kLooks = 8;                            // for points that the mesh was moved away from
constexpr double kAround = 4, kFarthestAround = 64;  // times `far`; twice that with each look
constexpr std::uint64_t kBytesPerFarPoint = 128;

bool has(std::span<const std::uint32_t> ascending, std::uint32_t number) {
  return std::ranges::binary_search(ascending, number);
}

bool has(const std::vector<NumberedPoint>& ascending, std::uint32_t number) {
  const auto at = std::ranges::lower_bound(ascending, number, {}, &NumberedPoint::number);
  return at != ascending.end() && at->number == number;
}

std::vector<std::uint32_t> merged(std::span<const std::uint32_t> a,
                                  std::span<const std::uint32_t> b) {
  std::vector<std::uint32_t> both(a.begin(), a.end());
  both.insert(both.end(), b.begin(), b.end());
  sort_once(both);
  return both;
}

// Both ascend.
void add(const std::vector<NumberedPoint>& points, std::vector<NumberedPoint>& to) {
  std::vector<NumberedPoint> all;
  std::ranges::set_union(points, to, std::back_inserter(all), {}, &NumberedPoint::number,
                         &NumberedPoint::number);
  to = std::move(all);
}

// Runs of points whose numbers in the file follow each other.
void give_runs(const ScanPieces::Piece& piece, const CloudSource::Take& take) {
  for (std::size_t first = 0, end; first < piece.points.size(); first = end) {
    const std::uint64_t number = piece.numbers[first];
    end = first + 1;
    while (end < piece.points.size() && piece.numbers[end] == number + (end - first)) ++end;
    take(piece.points.subspan(first, end - first), number);
  }
}

// The points of a scan but for those that are excluded from the start.
class ProvenScan final : public ProvenCloud {
 public:
  ProvenScan(const ScanPieces& scan, std::span<const std::uint32_t> outliers, std::size_t threads)
      : scan_(scan), outliers_(outliers), threads_(threads) {}

  CertifiedError certify(const ExactMesh& mesh,
                         std::span<const std::uint32_t> excluded) const override {
    const std::vector<std::uint32_t> all = merged(outliers_, excluded);
    PiecewiseCertificate certificate(mesh);
    scan_.for_each(threads_, [&](const ScanPieces::Piece& piece) {
      certificate.add(piece.points, piece.numbers, piece.indices_of(all));
    });
    return certificate.finish();
  }

  std::vector<std::uint32_t> beyond(
      const ExactMesh& mesh, double epsilon,
      std::optional<std::span<const std::uint32_t>> points) const override {
    std::mutex mutex;
    std::vector<std::uint32_t> beyond;
    scan_.for_each(threads_, [&](const ScanPieces::Piece& piece) {
      std::vector<std::uint32_t> here;
      const auto look_at = [&](std::size_t i) {
        if (mesh.nearest(piece.points[i], epsilon).distance.upper > epsilon) {
          here.push_back(piece.numbers[i]);
        }
      };
      if (points) {
        std::ranges::for_each(piece.indices_of(*points), look_at);
      } else {
        for (std::size_t i = 0; i < piece.points.size(); ++i) {
          if (!has(outliers_, piece.numbers[i])) look_at(i);
        }
      }
      const std::lock_guard lock(mutex);
      beyond.insert(beyond.end(), here.begin(), here.end());
    });
    std::ranges::sort(beyond);
    return beyond;
  }

 private:
  const ScanPieces& scan_;
  std::span<const std::uint32_t> outliers_;
  std::size_t threads_;
};

}  // namespace

TiledScan::TiledScan(const ScanPieces& scan, const TriangleMesh& given, TiledScanSettings settings)
    : scan_(scan), given_(given), settings_(std::move(settings)) {
  const ExactMesh mesh(given.view());
  std::mutex mutex;
  scan_.for_each(settings_.threads, [&](const ScanPieces::Piece& piece) {
    const FarFromMesh found = far_in(piece, mesh);
    const std::lock_guard lock(mutex);
    far_.beyond.insert(far_.beyond.end(), found.beyond.begin(), found.beyond.end());
    far_.points.insert(far_.points.end(), found.points.begin(), found.points.end());
    require_room(far_.points.size());
  });
  std::ranges::sort(far_.beyond);
  std::ranges::sort(far_.points, {}, &NumberedPoint::number);
  exclude_farthest(settings_.excludable);
}

void TiledScan::exclude_farthest(std::size_t count) {
  outliers_.clear();
  for (const auto& [distance, number] :
       std::span(far_.beyond).first(std::min(count, far_.beyond.size()))) {
    outliers_.push_back(number);
  }
  std::ranges::sort(outliers_);
}

TiledScan::FarFromMesh TiledScan::far_in(const ScanPieces::Piece& piece,
                                         const ExactMesh& mesh) const {
  FarFromMesh found;
  std::uint32_t seed = ~0u;
  for (std::size_t i = 0; i < piece.points.size(); ++i) {
    if (i % 4096 == 0 && settings_.interrupted && settings_.interrupted()) throw Interrupted{};
    const ExactMesh::Nearest nearest = mesh.nearest(piece.points[i], settings_.far, seed);
    seed = nearest.triangle;
    const double distance = nearest.distance.upper;
    if (distance <= settings_.far) continue;
    found.points.push_back({piece.points[i], piece.numbers[i]});
    if (distance > settings_.epsilon) found.beyond.emplace_back(-distance, piece.numbers[i]);
  }
  return found;
}

void TiledScan::require_room(std::size_t far) const {
  if (far * kBytesPerFarPoint <= settings_.memory) return;
  throw Error(
      fmt::format("{}: --memory does not hold the points that are farther than {:.6g} from the "
                  "mesh; give a mesh nearer to the scan, a larger --max-error or more memory",
                  scan_.scan().path.string(), settings_.far));
}

std::vector<NumberedPoint> TiledScan::chosen(const Choice& choice) const {
  std::vector<NumberedPoint> chosen;
  std::mutex mutex;
  scan_.for_each(settings_.threads, [&](const ScanPieces::Piece& piece) {
    std::vector<NumberedPoint> here;
    for (std::size_t i = 0; i < piece.points.size(); ++i) {
      const std::uint32_t number = piece.numbers[i];
      if (i % 4096 == 0 && settings_.interrupted && settings_.interrupted()) throw Interrupted{};
      if (has(outliers_, number) || !choice(piece.points[i], number)) continue;
      here.push_back({piece.points[i], number});
    }
    const std::lock_guard lock(mutex);
    chosen.insert(chosen.end(), here.begin(), here.end());
    if (chosen.size() > kSample) require_room(chosen.size() - kSample);
  });
  std::ranges::sort(chosen, {}, &NumberedPoint::number);
  return chosen;
}

// A sample of all points, which shows whether the scan belongs to the mesh.
std::vector<NumberedPoint> TiledScan::sample() const {
  const auto every = static_cast<std::uint32_t>(1 + scan_.points() / kSample);
  return chosen([&](const Point&, std::uint32_t number) { return number % every == 0; });
}

std::vector<NumberedPoint> TiledScan::far_points() const {
  std::vector<NumberedPoint> far;
  for (const NumberedPoint& point : far_.points) {
    if (!has(outliers_, static_cast<std::uint32_t>(point.number))) far.push_back(point);
  }
  return far;
}

GivenReference TiledScan::make_reference(const ReferenceWishes& wishes) {
  std::vector<NumberedPoint> kept = sample();
  for (int tries = 0;; ++tries) {
    const std::vector<NumberedPoint> far = far_points();
    add(far, kept);
    if (tries == 0) add_around(far, kAround * settings_.far, kept);
    Joined joined = join(wishes, kept);
    const std::optional<std::size_t> fewer =
        fewer_excluded(outliers_.size(), joined.missed, settings_.excludable, tries);
    if (!fewer) return joined.reference;
    exclude_farthest(*fewer);
  }
}

// Joining a point bends the mesh, which may move it away from others: those are looked for, and
// hold it back when all begins anew.
TiledScan::Joined TiledScan::join(const ReferenceWishes& wishes,
                                  std::vector<NumberedPoint>& kept) const {
  double reach = kAround * settings_.far;
  for (int look = 0;; ++look) {
    std::vector<Point> positions;
    positions.reserve(kept.size());
    for (const NumberedPoint& point : kept) positions.push_back(point.position);
    Joined made = {
        emax::make_reference(given_, positions, settings_.far, wishes, settings_.interrupted), 0};
    if (settings_.interrupted && settings_.interrupted()) throw Interrupted{};
    const ExactMesh reference(made.reference.surface.mesh.view());
    const auto is_far = [&](const Point& p) {
      return reference.nearest(p, settings_.far).distance.upper > settings_.far;
    };
    made.missed = static_cast<std::size_t>(std::ranges::count_if(positions, is_far));
    if (made.reference.is_as_given() || EMAX_FAULT(kTrustsJoined)) return made;
    const std::vector<NumberedPoint> lost = chosen(
        [&](const Point& p, std::uint32_t number) { return !has(kept, number) && is_far(p); });
    if (lost.empty()) return made;
    if (look == kLooks) {
      made.missed += lost.size();
      return made;
    }
    reach = std::min(2 * reach, kFarthestAround * settings_.far);
    add_around(lost, reach, kept);
  }
}

// Those around will be lost next.
void TiledScan::add_around(const std::vector<NumberedPoint>& lost, double reach,
                           std::vector<NumberedPoint>& kept) const {
  const BoxTree around(static_cast<std::uint32_t>(lost.size()), [&](std::uint32_t i) {
    return inflated({lost[i].position, lost[i].position}, reach);
  });
  const std::vector<NumberedPoint> more = chosen([&](const Point& p, std::uint32_t number) {
    bool is_near = false;
    around.for_each({p, p}, [&is_near](std::uint32_t) { is_near = true; });
    return is_near && !has(kept, number);
  });
  add(more, kept);
}

CertifiedDecimation TiledScan::decimate(const TriangleMesh& reference,
                                        const CertifiedDecimationSettings& settings) const {
  if (scan_.is_in_memory()) {
    const PointCloud& cloud = scan_.scan().cloud;
    return decimate(reference, settings, PointsInMemory(cloud.points, outliers_, cloud.file_index));
  }
  const CloudSource source = {
      scan_.normalization(), [this](const CloudSource::Take& take) {
        scan_.for_each(settings_.threads,
                       [&](const ScanPieces::Piece& piece) { give_runs(piece, take); });
      }};
  const CloudPartition partition =
      CloudPartition::is_in(settings_.folder)
          ? CloudPartition(settings_.folder)
          : CloudPartition(source, std::max(kLeastOfPart, scan_.points() / kMostParts),
                           settings_.folder);
  return decimate(reference, settings, PointsInFiles(partition, outliers_, settings_.threads));
}

CertifiedDecimation TiledScan::decimate(const TriangleMesh& reference,
                                        const CertifiedDecimationSettings& settings,
                                        const TilePoints& points) const {
  CertifiedDecimationSettings own = settings;
  if (settings.early) {
    own.early = [&](const CertifiedDecimation& made) { settings.early(in_indices(made)); };
  }
  const TiledDecimator tiled(reference, points, settings_.triangles_of_a_tile, *settings_.runner);
  return in_indices(
      decimate_certified(reference, ProvenScan(scan_, outliers_, settings_.threads), own,
                         [&](const DecimationSettings& bounded) { return tiled.run(bounded); }));
}

CertifiedDecimation TiledScan::in_indices(CertifiedDecimation made) const {
  made.points = in_indices(std::move(made.points));
  return made;
}

CertifiedError TiledScan::in_indices(CertifiedError error) const {
  if (!scan_.is_in_memory()) return error;
  const auto index = [this](std::uint32_t number) {
    return in_cloud(std::array{number}, scan_.scan().cloud).front();
  };
  error.excluded = in_cloud(error.excluded, scan_.scan().cloud);
  error.worst_point = index(static_cast<std::uint32_t>(error.worst_point));
  return error;
}

ProvenMesh TiledScan::prove(const CertifiedDecimation& made, const TriangleMesh* reference) const {
  std::vector<std::uint32_t> excluded = made.points.excluded;
  if (scan_.is_in_memory()) {
    for (std::uint32_t& point : excluded) point = scan_.scan().cloud.index_in_file(point);
  }
  LocalPieces here;
  PointClaims claims =
      recompute(scan_, MeasuredMesh(made.mesh), reference, excluded, here, {}, settings_.memory);
  ProvenMesh proven;
  proven.validity = made.validity;
  proven.topology = topology_of(made.mesh.view());
  proven.points = in_indices(std::move(claims.error));
  proven.kernel = claims.kernel;
  if (reference != nullptr) proven.points_to_reference = claims.of_reference->e_max_upper;
  return proven;
}

}  // namespace emax
