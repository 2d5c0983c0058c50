#include "tests/support/scan_generator/scanner.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "sw_model/base/parallel.h"

namespace emax::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLowest = -65 * kPi / 180, kHighest = kPi / 2;  // elevations
constexpr std::uint64_t kBatch = 64;                             // columns

// A word that depends on all of these (SplitMix64).
std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = a * 0x9e3779b97f4a7c15 + b + 0x9e3779b97f4a7c15;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
  z = (z ^ z >> 27) * 0x94d049bb133111eb;
  return z ^ z >> 31;
}

// The random numbers of one ray.
class RayRandom {
 public:
  RayRandom(std::uint64_t seed, std::uint64_t station, std::uint64_t column, std::uint64_t row)
      : state_(mixed(mixed(mixed(seed, station), column), row)) {}

  double uniform() {  // in (0, 1)
    state_ = mixed(state_, ++count_);
    return (static_cast<double>(state_ >> 11) + 0.5) * 0x1p-53;
  }
  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * kPi * uniform());
  }

 private:
  std::uint64_t state_, count_ = 0;
};

}  // namespace

struct Scanner::Device {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  explicit Device(const TriangleMesh& mesh) : device(rtcNewDevice(nullptr)) {
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    for (const Point& v : mesh.vertices) {
      for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(v[k]);
    }
    auto* triangles = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), mesh.triangles.size()));
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t corner : t) *triangles++ = corner;
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }
  ~Device() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
};

Scanner::Scanner(const Scene& scene, const ScannerOptions& options)
    : scene_(scene),
      options_(options),
      device_(std::make_unique<Device>(scene.mesh)),
      step_(step_for_points()) {}

Scanner::~Scanner() = default;

// Embree tells which triangle is met; where, its plane in binary64.
Scanner::Hit Scanner::cast(const Point& from, const Point& direction) const {
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(from[0]);
  query.ray.org_y = static_cast<float>(from[1]);
  query.ray.org_z = static_cast<float>(from[2]);
  query.ray.dir_x = static_cast<float>(direction[0]);
  query.ray.dir_y = static_cast<float>(direction[1]);
  query.ray.dir_z = static_cast<float>(direction[2]);
  query.ray.tfar = static_cast<float>(options_.range);
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(device_->scene, &context, &query);
  constexpr Hit kNone = {std::numeric_limits<double>::infinity(), 0};
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return kNone;
  const auto corners = scene_.mesh.view().corners(query.hit.primID);
  const Point normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const double facing = std::abs(normal.dot(direction));
  if (!(facing > 1e-6)) return kNone;
  return {normal.dot(corners[0] - from) / normal.dot(direction), facing};
}

std::vector<Point> Scanner::column(std::size_t station, std::uint64_t column, double step) const {
  constexpr double kJump = 0.03;  // metres between the two sides of an edge
  const Point& from = scene_.stations[station];
  const double azimuth = static_cast<double>(column) * step;
  const Point ahead = {std::cos(azimuth), std::sin(azimuth), 0};
  const auto rows = static_cast<std::uint64_t>((kHighest - kLowest) / step);
  std::vector<Point> points;
  for (std::uint64_t row = 0; row < rows; ++row) {
    const double elevation = kLowest + static_cast<double>(row) * step;
    const Point direction = std::cos(elevation) * ahead + Point(0, 0, std::sin(elevation));
    const Hit hit = cast(from, direction);
    if (!std::isfinite(hit.range)) continue;
    RayRandom random(options_.seed, station, column, row);
    if (random.uniform() < options_.dropouts / std::max(hit.facing, 0.01)) continue;
    double range = hit.range;
    // The other side of an edge that the beam reaches over, in a direction of its own.
    const double turn = 2 * kPi * random.uniform();
    const Point aside = std::cos(turn) * direction.unitOrthogonal() +
                        std::sin(turn) * direction.cross(direction.unitOrthogonal());
    const Hit other =
        options_.beam > 0 ? cast(from, (direction + options_.beam * aside).normalized()) : hit;
    const double slope = 3 * range * options_.beam / hit.facing;
    if (std::isfinite(other.range) && std::abs(other.range - range) > kJump + slope) {
      range += random.uniform() * (other.range - range);
    } else {
      const double sigma =
          options_.noise * (0.5 + range / 20) / std::sqrt(std::max(hit.facing, 0.1));
      range += sigma * random.normal();
    }
    points.push_back(from + range * direction);
  }
  return points;
}

double Scanner::step_for_points() const {
  // The share of the rays that come back, from a few of them.
  constexpr double kCoarse = kPi / 200;
  std::uint64_t found = 0;
  for (std::size_t station = 0; station < scene_.stations.size(); ++station) {
    for (std::uint64_t c = 0; c < static_cast<std::uint64_t>(2 * kPi / kCoarse); ++c) {
      found += column(station, c, kCoarse).size();
    }
  }
  return kCoarse *
         std::sqrt(static_cast<double>(std::max<std::uint64_t>(found, 1)) / options_.points);
}

std::uint64_t Scanner::scan(const std::function<void(std::span<const Point>)>& take) const {
  std::uint64_t count = 0;
  const auto columns = static_cast<std::uint64_t>(2 * kPi / step_);
  for (std::size_t station = 0; station < scene_.stations.size(); ++station) {
    for (std::uint64_t first = 0; first < columns; first += kBatch) {
      std::vector<std::vector<Point>> batch(std::min(kBatch, columns - first));
      in_pieces(options_.threads, batch.size(), 1, [&](std::size_t, std::size_t c, std::size_t) {
        batch[c] = column(station, first + c, step_);
      });
      for (const std::vector<Point>& points : batch) {
        count += points.size();
        take(points);
      }
    }
  }
  return count;
}

}  // namespace emax::test
