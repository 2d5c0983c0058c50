#include "tests/benchmarks/embree_peer.h"

#include <embree3/rtcore.h>
#include <xmmintrin.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "sw_model/base/error.h"
#include "sw_model/certify/matrix_free.h"

namespace emax::benchmarks {
namespace {

using Vector = Eigen::Vector3f;
using Corners = std::array<Vector, 3>;

constexpr std::size_t kSeedStride = 256, kRecent = 4;
constexpr unsigned kFlush = 0x8040;  // flush to zero, denormals are zero

class Flushing {
 public:
  Flushing() : before_(_mm_getcsr()) { _mm_setcsr(before_ | kFlush); }
  ~Flushing() { _mm_setcsr(before_); }
  Flushing(const Flushing&) = delete;
  Flushing& operator=(const Flushing&) = delete;

 private:
  unsigned before_;
};

struct Search {
  const Corners* triangles;
  Vector point;
  float best;      // squared distance of the nearest triangle so far
  unsigned index;  // that triangle
  float enough;    // squared distance at which the search may end
};

float squared_distance(const Corners& t, const Vector& p) {
  return ericson_squared_distance<float>(p, t[0], t[1], t[2]);
}

bool visit(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  if (search.best <= search.enough) return false;
  const float d = squared_distance(search.triangles[arguments->primID], search.point);
  if (!(d < search.best)) return false;
  search.best = d;
  search.index = arguments->primID;
  // With radius 0 only boxes that hold the point are left.
  arguments->query->radius = d <= search.enough ? 0 : std::sqrt(d);
  return true;
}

}  // namespace

struct EmbreePeer::Data {
  std::vector<Vector> cloud;
  std::vector<std::uint32_t> cloud_order, order;
  std::vector<float> vertices, squared;  // vertices end in a word that Embree may read
  std::vector<Triangle> triangles;
  std::vector<Corners> corners;
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = nullptr;

  ~Data() {
    if (scene != nullptr) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  // Looks at triangles up to this squared distance.
  void query(Search& search, float squared_radius) const {
    RTCPointQuery query = {search.point.x(), search.point.y(), search.point.z(), 0,
                           // Rounding must not lose the triangle that the bound comes from.
                           std::sqrt(squared_radius) * 1.000001F};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene, &query, &context, visit, &search);
  }

  Search unbounded() const {
    return {corners.data(), {}, std::numeric_limits<float>::infinity(), 0, -1};
  }

  void bound(Search& search, std::size_t point) const {
    search.point = cloud[point];
    search.best = squared_distance(corners[search.index], search.point);
    if (!(search.best >= 0)) search.best = std::numeric_limits<float>::infinity();
  }
};

EmbreePeer::EmbreePeer(std::span<const Point> cloud, std::span<const std::uint32_t> order,
                       MeshView mesh, const Normalization& normalization)
    : data_(std::make_unique<Data>()) {
  Data& d = *data_;
  for (const Point& p : cloud) d.cloud.push_back(normalization.apply(p).cast<float>());
  for (std::uint32_t i = 0; i < cloud.size(); ++i) d.cloud_order.push_back(i);
  d.order.assign(order.begin(), order.end());
  for (const Point& p : mesh.vertices) {
    const Vector v = normalization.apply(p).cast<float>();
    d.vertices.insert(d.vertices.end(), v.begin(), v.end());
  }
  d.vertices.push_back(0);
  d.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
  d.squared.resize(cloud.size());
}

EmbreePeer::~EmbreePeer() = default;

void EmbreePeer::build() {
  const Flushing flushing;
  Data& d = *data_;
  if (d.scene != nullptr) rtcReleaseScene(d.scene);
  d.scene = rtcNewScene(d.device);
  rtcSetSceneBuildQuality(d.scene, RTC_BUILD_QUALITY_MEDIUM);
  rtcSetSceneFlags(d.scene, RTC_SCENE_FLAG_COMPACT);
  const RTCGeometry geometry = rtcNewGeometry(d.device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             d.vertices.data(), 0, 3 * sizeof(float), d.vertices.size() / 3);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             d.triangles.data(), 0, sizeof(Triangle), d.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(d.scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(d.scene);
  const RTCError error = rtcGetDeviceError(d.device);
  if (error != RTC_ERROR_NONE) {
    throw Error("Embree refuses the scene with its error " + std::to_string(error) +
                "; leave its benchmarks out");
  }
  d.corners.resize(d.triangles.size());
  for (std::size_t i = 0; i < d.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      d.corners[i][k] = Eigen::Map<const Vector>(&d.vertices[std::size_t{3} * d.triangles[i][k]]);
    }
  }
}

float EmbreePeer::greatest_squared_distance(Mode mode) {
  const Flushing flushing;
  Data& d = *data_;
  float greatest = 0;
  Search search = d.unbounded();
  bool hint = false;
  for (const std::uint32_t i : mode == Mode::kCloudOrder ? d.cloud_order : d.order) {
    search.point = d.cloud[i];
    search.best = std::numeric_limits<float>::infinity();
    if (hint) d.bound(search, i);
    d.query(search, search.best);
    hint = mode == Mode::kHints;
    d.squared[i] = search.best;
    greatest = std::max(greatest, search.best);
  }
  return greatest;
}

float EmbreePeer::greatest_with_early_stop() {
  const Flushing flushing;
  const Data& d = *data_;
  float greatest = 0;
  Search search = d.unbounded();
  std::array<unsigned, kRecent> recent{};  // triangles that settled the last points
  std::size_t oldest = 0;
  for (const bool seeding : {true, false}) {
    for (std::size_t k = 0; k < d.order.size(); k += seeding ? kSeedStride : 1) {
      search.point = d.cloud[d.order[k]];
      search.enough = greatest;
      const auto settles = [&](unsigned triangle) {
        return squared_distance(d.corners[triangle], search.point) <= greatest;
      };
      if (std::any_of(recent.begin(), recent.end(), settles)) continue;
      // Nothing beyond the greatest so far is looked at until all within it has been.
      search.best = std::numeric_limits<float>::infinity();
      d.query(search, greatest);
      if (search.best > greatest) {
        d.query(search, search.best);
        greatest = std::max(greatest, search.best);
      }
      recent[oldest] = search.index;
      oldest = (oldest + 1) % kRecent;
    }
  }
  return greatest;
}

std::span<const float> EmbreePeer::squared_distances() const { return data_->squared; }

std::string EmbreePeer::version() { return RTC_VERSION_STRING; }

}  // namespace emax::benchmarks
