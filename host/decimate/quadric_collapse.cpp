#include "host/decimate/quadric_collapse.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>

#include "host/decimate/editable_mesh.h"
#include "host/geometry/bounds.h"
#include "host/geometry/self_intersections.h"

namespace emax {
namespace {

constexpr double kLeastCosine = 0.7;     // between a triangle and what takes its place
constexpr double kLeastFlatness = 0.03;  // height over longest side
constexpr double kTowardMiddle = 1e-4;   // pull on a vertex where its planes do not hold it

// The sum of weighted squared distances from planes: x'Ax - 2b'x + c.
struct PlaneQuadric {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double c = 0;
  double weight = 0;

  void add(const Eigen::Vector3d& normal, const Point& on, double w) {
    const double offset = normal.dot(on);
    a += w * normal * normal.transpose();
    b += w * offset * normal;
    c += w * offset * offset;
    weight += w;
  }
  PlaneQuadric& operator+=(const PlaneQuadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
    weight += other.weight;
    return *this;
  }
  double at(const Point& x) const { return std::max(0.0, x.dot(a * x) - 2 * b.dot(x) + c); }
};

Eigen::Vector3d cross(const std::array<Point, 3>& c) { return (c[1] - c[0]).cross(c[2] - c[0]); }

double squared_longest_side(const std::array<Point, 3>& c) {
  return std::max(
      {(c[1] - c[0]).squaredNorm(), (c[2] - c[1]).squaredNorm(), (c[0] - c[2]).squaredNorm()});
}

struct Candidate {
  double error;
  std::uint32_t kept, gone;
  std::uint32_t kept_version, gone_version;
  Point at;

  // The least error first.
  bool operator<(const Candidate& other) const {
    return std::tie(other.error, other.kept, other.gone) < std::tie(error, kept, gone);
  }
};

class QuadricCollapse {
 public:
  QuadricCollapse(const TriangleMesh& mesh, double deviation, std::span<const char> fixed)
      : origin_(bounds_of(mesh.vertices).midpoint()),
        deviation_(deviation),
        fixed_(fixed),
        mesh_(shifted(mesh, origin_)),
        quadrics_(mesh.vertices.size()),
        versions_(mesh.vertices.size()),
        into_(mesh.vertices.size()) {
    std::iota(into_.begin(), into_.end(), 0u);
    add_quadrics();
  }

  CollapsedMesh run() {
    std::vector<Candidate> candidates;
    for_each_edge([&](std::uint32_t a, std::uint32_t b) {
      if (const auto candidate = candidate_of(a, b)) candidates.push_back(*candidate);
    });
    queue_ = std::priority_queue<Candidate>(std::less<Candidate>{}, std::move(candidates));
    while (!queue_.empty()) {
      const Candidate next = queue_.top();
      queue_.pop();
      const bool current =
          versions_[next.kept] == next.kept_version && versions_[next.gone] == next.gone_version;
      if (current && is_possible(next)) collapse(next);
    }
    CollapsedMesh result{mesh_.compact(), {}};
    for (Point& p : result.mesh.vertices) p += origin_;
    for (std::uint32_t v = 0; v < mesh_.vertex_slots(); ++v) {
      if (mesh_.used(v)) result.vertices.push_back(v);
    }
    return result;
  }

  // The vertex that a vertex was collapsed into.
  std::uint32_t survivor(std::uint32_t v) const {
    while (into_[v] != v) v = into_[v];
    return v;
  }

 private:
  static TriangleMesh shifted(TriangleMesh mesh, const Point& by) {
    for (Point& p : mesh.vertices) p -= by;
    return mesh;
  }

  bool is_fixed(std::uint32_t v) const { return fixed_[v] != 0; }

  // Each edge once.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (const std::uint32_t slot : mesh_.alive_slots()) {
      const Triangle& t = mesh_.triangle(slot);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        const bool on_border = mesh_.slots_at_edge(a, b)[1] == kNoIndex;
        if (a < b || on_border) visit(std::min(a, b), std::max(a, b));
      }
    }
  }

  // Of the triangles' planes, and across borders of planes through them, so that these stay.
  void add_quadrics() {
    double length = 0;
    std::size_t edges = 0;
    for (const std::uint32_t slot : mesh_.alive_slots()) {
      const std::array<Point, 3> c = mesh_.corners(slot);
      const double area = cross(c).norm();
      if (!(area > 0)) continue;
      const Eigen::Vector3d normal = cross(c) / area;
      const Triangle& t = mesh_.triangle(slot);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        quadrics_[a].add(normal, c[i], area);
        const Eigen::Vector3d along = c[(i + 1) % 3] - c[i];
        length += along.norm();
        ++edges;
        if (mesh_.slots_at_edge(a, b)[1] != kNoIndex) continue;
        const Eigen::Vector3d across = along.cross(normal).normalized();
        for (const std::uint32_t v : {a, b}) quadrics_[v].add(across, c[i], along.squaredNorm());
      }
    }
    longest_ = kLongestEdge * length / static_cast<double>(std::max<std::size_t>(edges, 1));
  }

  // Nothing if the edge has to stay.
  std::optional<Candidate> candidate_of(std::uint32_t a, std::uint32_t b) const {
    if (is_fixed(b) || (mesh_.on_boundary(b) && !is_fixed(a) && !mesh_.on_boundary(a))) {
      std::swap(a, b);
    }
    if (is_fixed(b)) return std::nullopt;
    PlaneQuadric joint = quadrics_[a];
    joint += quadrics_[b];
    const bool stays = is_fixed(a) || (mesh_.on_boundary(a) && !mesh_.on_boundary(b));
    const Point at = stays ? mesh_.position(a) : best(joint, a, b);
    const double error = joint.at(at);
    if (!(error <= deviation_ * deviation_ * joint.weight)) return std::nullopt;
    return Candidate{error, a, b, versions_[a], versions_[b], at};
  }

  Point best(const PlaneQuadric& joint, std::uint32_t a, std::uint32_t b) const {
    const Point middle = 0.5 * (mesh_.position(a) + mesh_.position(b));
    const double pull = kTowardMiddle * joint.weight;
    const Eigen::Matrix3d held = joint.a + pull * Eigen::Matrix3d::Identity();
    const Point at = held.inverse() * (joint.b + pull * middle);
    return at.allFinite() ? at : middle;
  }

  bool is_possible(const Candidate& c) const {
    const bool moves = mesh_.position(c.kept) != c.at;
    return mesh_.collapsible(c.kept, c.gone) && (!moves || keeps_shape(c.kept, c)) &&
           keeps_shape(c.gone, c);
  }

  // Of the triangles at one end, those without the other.
  bool keeps_shape(std::uint32_t end, const Candidate& c) const {
    const std::uint32_t other = end == c.kept ? c.gone : c.kept;
    bool keeps = true;
    mesh_.for_each_slot_at(end, [&](std::uint32_t slot) {
      if (!keeps || has(mesh_.triangle(slot), other)) return;
      const std::array<Point, 3> before = mesh_.corners(slot);
      std::array<Point, 3> after = before;
      for (std::size_t i = 0; i < 3; ++i) {
        if (mesh_.triangle(slot)[i] == end) after[i] = c.at;
      }
      keeps = is_like(before, after);
    });
    return keeps;
  }

  // A sliver may stay one.
  bool is_like(const std::array<Point, 3>& before, const std::array<Point, 3>& after) const {
    const Eigen::Vector3d old = cross(before), now = cross(after);
    const double longest = squared_longest_side(after);
    const double flatness = std::min(kLeastFlatness, old.norm() / squared_longest_side(before));
    return longest <= longest_ * longest_ && now.norm() >= flatness * longest &&
           now.dot(old) >= kLeastCosine * now.norm() * old.norm();
  }

  void collapse(const Candidate& c) {
    std::vector<std::uint32_t> slots;
    mesh_.slots_at(c.gone, slots);
    for (const std::uint32_t slot : slots) {
      Triangle t = mesh_.triangle(slot);
      mesh_.clear(slot);
      if (has(t, c.kept)) continue;
      std::ranges::replace(t, c.gone, c.kept);
      mesh_.set(slot, t);
    }
    mesh_.move(c.kept, c.at);
    into_[c.gone] = c.kept;
    quadrics_[c.kept] += quadrics_[c.gone];
    ++versions_[c.kept];
    ++versions_[c.gone];
    mesh_.neighbours(c.kept, ring_);
    for (const std::uint32_t v : ring_) {
      if (const auto candidate = candidate_of(c.kept, v)) queue_.push(*candidate);
    }
  }

  const Point origin_;  // squares of far coordinates would round
  const double deviation_;
  const std::span<const char> fixed_;
  EditableMesh mesh_;
  std::vector<PlaneQuadric> quadrics_;   // of the vertices
  std::vector<std::uint32_t> versions_;  // likewise; how often each was changed
  std::vector<std::uint32_t> into_;      // likewise; itself if it was not collapsed
  std::priority_queue<Candidate> queue_;
  std::vector<std::uint32_t> ring_;
  double longest_ = 0;
};

}  // namespace

CollapsedMesh collapse_by_quadrics(const TriangleMesh& mesh, double deviation,
                                   std::span<const char> fixed) {
  if (mesh.triangles.empty()) return {};
  std::vector<char> stay(fixed.begin(), fixed.end());
  stay.resize(mesh.vertices.size());
  while (true) {
    QuadricCollapse collapse(mesh, deviation, stay);
    CollapsedMesh result = collapse.run();
    const SelfIntersections meeting = self_intersections(result.mesh.view());
    std::vector<char> meets(mesh.vertices.size());
    for (const std::uint32_t t : meeting.triangles) {
      for (const std::uint32_t v : result.mesh.triangles[t]) meets[result.vertices[v]] = 1;
    }
    bool more = false;
    for (std::uint32_t v = 0; v < stay.size(); ++v) {
      if (stay[v] != 0 || meets[collapse.survivor(v)] == 0) continue;
      stay[v] = 1;
      more = true;
    }
    if (!more) return result;
  }
}

}  // namespace emax
