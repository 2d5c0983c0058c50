#include "host/decimate/certified_decimation.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "host/decimate/back_bound.h"
#include "host/decimate/far_points.h"
#include "host/decimate/local_distance.h"
#include "sw_model/error.h"

namespace emax {
namespace {

constexpr int kInsertions = 6;            // of points that the mesh misses, in a row
constexpr int kDecimatedInsertions = 2;   // after which the mesh is decimated on
constexpr int kRestarts = 4;              // with smaller bounds
constexpr double kFirstReduction = 1e-3;  // of the bounds; later ones are kGrowth times the last
constexpr double kGrowth = 8;
constexpr int kMostPieces = 64;  // that a triangle is halved into in search of its far points

// The farthest points found in triangles of `from` that are not proven to lie within the limit of
// `to`, beyond it.
std::vector<Point> points_beyond(const TriangleMesh& from, const TriangleMesh& to, double limit) {
  const BackBound bound(to, limit);
  std::vector<Point> beyond;
  std::vector<std::array<Point, 3>> pieces;
  for (std::size_t t = 0; t < from.triangles.size(); ++t) {
    const std::array<Point, 3> corners = from.view().corners(t);
    if (bound.holds(corners, bound.sight(corners[0]).triangle)) continue;
    double worst = 1;
    Point farthest;
    const auto look = [&](const Point& p) {
      const double share = bound.sight(p).share;
      if (share <= worst) return;
      worst = share;
      farthest = p;
    };
    for (const Point& corner : corners) look(corner);
    pieces.assign(1, corners);
    for (std::size_t i = 0; i < pieces.size() && pieces.size() < kMostPieces; ++i) {
      const std::array<Point, 3> piece = pieces[i];
      const std::uint32_t near = bound.sight((piece[0] + piece[1] + piece[2]) / 3).triangle;
      if (near != kNoIndex && std::ranges::all_of(piece, [&](const Point& corner) {
            return squared_distance(corner, bound.reference().corners(near)) <= limit * limit;
          })) {
        continue;
      }
      std::size_t longest = 0;
      for (std::size_t k = 1; k < 3; ++k) {
        if ((piece[(k + 1) % 3] - piece[k]).squaredNorm() >
            (piece[(longest + 1) % 3] - piece[longest]).squaredNorm()) {
          longest = k;
        }
      }
      const Point& a = piece[longest];
      const Point& b = piece[(longest + 1) % 3];
      const Point& c = piece[(longest + 2) % 3];
      const Point middle = 0.5 * (a + b);
      look(middle);
      pieces.push_back({a, middle, c});
      pieces.push_back({middle, b, c});
    }
    if (worst > 1) beyond.push_back(farthest);
  }
  return beyond;
}

class Attempts {
 public:
  Attempts(const TriangleMesh& reference, std::span<const Point> cloud,
           const CertifiedDecimationSettings& settings)
      : reference_(reference),
        exact_reference_(reference.view()),
        cloud_(cloud),
        settings_(settings),
        epsilon_(settings.decimation.epsilon),
        epsilon_back_(settings.decimation.epsilon_back > 0 ? settings.decimation.epsilon_back
                                                           : epsilon_),
        points_(cloud.begin(), cloud.end()) {}

  CertifiedDecimation run() {
    const double rounding = storage_displacement(reference_, settings_.format);
    double reduction = 2 * rounding / std::min(epsilon_, epsilon_back_);
    for (int restart = 0; restart <= kRestarts; ++restart) {
      if (attempt(decimated(reference_, reduction), reduction)) return std::move(result_);
      reduction = std::max(kFirstReduction, kGrowth * reduction);
      if (reduction > 0.5) break;
    }
    // An interrupted decimator has not said what it leaves out.
    for (std::uint32_t p = 0; p < cloud_.size(); ++p) {
      if (exact_reference_.distance(cloud_[p]).upper > epsilon_) left_out_.push_back(p);
    }
    if (!holds(reference_)) {
      if (rounding > 0) {
        throw Error("the mesh cannot be kept as this format rounds it; write .ply, .obj or .off");
      }
      throw std::logic_error("the reference is not within the bounds of itself");
    }
    return std::move(result_);
  }

 private:
  // Whether the mesh holds, points inserted where it misses the inside of the reference.
  bool attempt(TriangleMesh mesh, double reduction) {
    for (int insertion = 0; !holds(mesh); ++insertion) {
      ++result_.repairs;
      const bool misses_inside_only = result_.reference_to_mesh &&
                                      !result_.reference_to_mesh->within(epsilon_) &&
                                      holds_otherwise();
      const bool worthwhile = mesh.triangles.size() < reference_.triangles.size();
      if (!misses_inside_only || !worthwhile || insertion == kInsertions) return false;
      const std::vector<Point> missed = points_beyond(reference_, mesh, epsilon_);
      if (missed.empty()) return false;
      points_.insert(points_.end(), missed.begin(), missed.end());
      const BackBound back(reference_, epsilon_back_);
      mesh = insert_far_points(mesh, points_, epsilon_, nullptr, &back).mesh;
      if (insertion < kDecimatedInsertions) mesh = decimated(mesh, reduction);
    }
    return mesh.triangles.size() <= reference_.triangles.size();
  }

  TriangleMesh decimated(const TriangleMesh& start, double reduction) {
    DecimationSettings settings = settings_.decimation;
    settings.epsilon = epsilon_ * (1 - reduction);
    settings.epsilon_back = epsilon_back_ * (1 - reduction);
    DecimatedMesh decimated = BoundedDecimator(reference_, points_).run(start, settings);
    result_.interrupted = result_.interrupted || decimated.interrupted;
    left_out_.insert(left_out_.end(), decimated.left_out.begin(), decimated.left_out.end());
    return std::move(decimated.mesh);
  }

  // Judges the mesh as stored.
  bool holds(const TriangleMesh& mesh) {
    result_.mesh = as_stored(mesh, settings_.format);
    const MeshView view = result_.mesh.view();
    const ExactMesh exact(view);
    result_.validity = check_mesh(view);
    result_.points = certify(cloud_, view, beyond_for_good(exact));
    if (settings_.decimation.two_sided) {
      result_.mesh_to_reference = decided_distance(view, exact_reference_, epsilon_back_);
      if (settings_.whole_reference) {
        result_.reference_to_mesh = decided_distance(reference_.view(), exact, epsilon_);
      }
    }
    return holds_otherwise() &&
           (!result_.reference_to_mesh || result_.reference_to_mesh->within(epsilon_));
  }

  bool holds_otherwise() const {
    return result_.validity.valid() && result_.points.within(epsilon_) &&
           (!result_.mesh_to_reference || result_.mesh_to_reference->within(epsilon_back_));
  }

  // Of the points that no edit looked at, those that are too far in truth.
  std::vector<std::uint32_t> beyond_for_good(const ExactMesh& mesh) {
    std::ranges::sort(left_out_);
    const auto repeated = std::ranges::unique(left_out_);
    left_out_.erase(repeated.begin(), repeated.end());
    std::vector<std::uint32_t> beyond;
    for (const std::uint32_t p : left_out_) {
      if (p < cloud_.size() && mesh.distance(cloud_[p]).upper > epsilon_) beyond.push_back(p);
    }
    return beyond;
  }

  const TriangleMesh& reference_;
  const ExactMesh exact_reference_;
  std::span<const Point> cloud_;
  const CertifiedDecimationSettings& settings_;
  double epsilon_, epsilon_back_;
  std::vector<Point> points_;  // of the cloud, and those that a mesh missed inside the reference
  std::vector<std::uint32_t> left_out_;
  CertifiedDecimation result_;
};

}  // namespace

CertifiedDecimation decimate_certified(const TriangleMesh& reference, std::span<const Point> cloud,
                                       const CertifiedDecimationSettings& settings) {
  return Attempts(reference, cloud, settings).run();
}

}  // namespace emax
