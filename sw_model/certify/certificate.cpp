#include "sw_model/certify/certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "sw_model/base/error.h"
#include "sw_model/base/flush_mode.h"
#include "sw_model/base/morton.h"
#include "sw_model/base/parallel.h"

namespace emax {
namespace {

std::vector<bool> marked(std::size_t points, std::span<const std::uint32_t> excluded) {
  std::vector<bool> is_excluded(points, false);
  for (const std::uint32_t index : excluded) {
    if (index >= points || is_excluded[index]) {
      throw std::invalid_argument("excluded point " + std::to_string(index) +
                                  " does not exist or comes twice");
    }
    is_excluded[index] = true;
  }
  return is_excluded;
}

void require_finite(std::span<const Point> cloud, const PointNumbers& numbers) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!(cloud[i].array().abs() < 1e150).all()) {  // also for NaN
      throw Error("point " + std::to_string(numbers[i]) +
                  " is not finite or beyond 1e150: nothing can be certified of it");
    }
  }
}

// The kept points along a Morton curve. Any order gives the same certificate.
std::vector<std::uint32_t> along_a_curve(std::span<const Point> cloud,
                                         const std::vector<bool>& is_excluded) {
  Point low = cloud.front(), high = low;
  for (const Point& p : cloud) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  constexpr double kLastCell = kMortonCells - 1;  // the greatest coordinate has a cell of its own
  const double width = (high - low).maxCoeff();
  const double scale = width > 0 ? kLastCell / width : 0;
  std::vector<MortonKey> keys;
  keys.reserve(cloud.size());
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (is_excluded[i]) continue;
    const auto cell = [&](Eigen::Index k) {
      return static_cast<std::uint32_t>(std::clamp((cloud[i][k] - low[k]) * scale, 0.0, kLastCell));
    };
    keys.push_back({morton_code(cell(0), cell(1), cell(2)), i});
  }
  std::vector<MortonKey> sorted(keys.size());
  sort_by_code(keys, sorted);
  std::vector<std::uint32_t> order;
  order.reserve(sorted.size());
  for (const MortonKey& key : sorted) order.push_back(key.item);
  return order;
}

// The greatest distance so far, and of the points that have it the one of the lowest index.
struct Worst {
  double upper = -1;
  std::size_t point = std::numeric_limits<std::size_t>::max();
  Point at = Point::Zero();

  void raise(const Worst& other) {
    if (other.upper < upper || (other.upper == upper && other.point > point)) return;
    *this = other;
  }
  // A point with any triangle within this cannot be the worst.
  double enough(std::size_t index) const {
    return index > point ? upper : std::nextafter(upper, -std::numeric_limits<double>::infinity());
  }
};

constexpr std::size_t kPiece = 4096;  // points

}  // namespace

struct PiecewiseCertificate::State {
  explicit State(const ExactMesh* m) : mesh(m) {}

  const ExactMesh* mesh;  // nullptr where the distances are known
  std::mutex mutex;
  Worst worst;
  std::size_t points = 0;
  std::vector<std::pair<std::uint32_t, double>> excluded;

  void search(std::span<const Point> cloud, const PointNumbers& numbers,
              std::span<const std::uint32_t> order) {
    Worst mine;
    {
      const std::lock_guard lock(mutex);
      mine = worst;
    }
    std::optional<std::uint32_t> near;
    for (const std::uint32_t i : order) {
      const double enough = mine.enough(numbers[i]);
      if (near && mesh->is_within(cloud[i], *near, enough)) continue;
      const ExactMesh::Nearest nearest = mesh->nearest(cloud[i], enough, near.value_or(~0u));
      near = nearest.triangle;
      if (nearest.distance.upper > enough) {
        mine.raise({nearest.distance.upper, numbers[i], cloud[i]});
      }
    }
    const std::lock_guard lock(mutex);
    worst.raise(mine);
  }
};

PiecewiseCertificate::PiecewiseCertificate(const ExactMesh& mesh)
    : state_(std::make_unique<State>(&mesh)) {}
PiecewiseCertificate::PiecewiseCertificate() : state_(std::make_unique<State>(nullptr)) {}
PiecewiseCertificate::~PiecewiseCertificate() = default;

void PiecewiseCertificate::add(std::span<const Point> piece, const PointNumbers& numbers,
                               std::span<const std::uint32_t> excluded, std::size_t threads) {
  require_no_flush("the certificate");
  const std::vector<bool> is_excluded = marked(piece.size(), excluded);
  if (piece.empty()) return;
  require_finite(piece, numbers);
  const std::vector<std::uint32_t> order = along_a_curve(piece, is_excluded);
  in_pieces(threads, order.size(), kPiece, [&](std::size_t, std::size_t begin, std::size_t end) {
    state_->search(piece, numbers, std::span(order).subspan(begin, end - begin));
  });
  std::vector<std::pair<std::uint32_t, double>> left_out;
  for (const std::uint32_t i : excluded) {
    left_out.emplace_back(numbers[i], state_->mesh->distance(piece[i]).upper);
  }
  const std::lock_guard lock(state_->mutex);
  state_->points += piece.size() - excluded.size();
  state_->excluded.insert(state_->excluded.end(), left_out.begin(), left_out.end());
}

void PiecewiseCertificate::add_known(std::span<const Point> piece, const PointNumbers& numbers,
                                     std::span<const double> uppers,
                                     std::span<const std::uint32_t> excluded) {
  const std::vector<bool> is_excluded = marked(piece.size(), excluded);
  require_finite(piece, numbers);
  CertificatePart found;
  Worst worst;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    if (is_excluded[i]) {
      found.excluded.emplace_back(numbers[i], uppers[i]);
    } else {
      worst.raise({uppers[i], numbers[i], piece[i]});
    }
  }
  found.upper = worst.upper;
  found.worst_point = worst.point;
  found.at = worst.at;
  found.points = piece.size() - found.excluded.size();
  add(found);
}

CertificatePart PiecewiseCertificate::part() const {
  const std::lock_guard lock(state_->mutex);
  const Worst& worst = state_->worst;
  return {worst.upper, worst.point, worst.at, state_->points, state_->excluded};
}

void PiecewiseCertificate::add(const CertificatePart& part) {
  const std::lock_guard lock(state_->mutex);
  if (part.upper >= 0) {
    state_->worst.raise({part.upper, static_cast<std::size_t>(part.worst_point), part.at});
  }
  state_->points += static_cast<std::size_t>(part.points);
  state_->excluded.insert(state_->excluded.end(), part.excluded.begin(), part.excluded.end());
}

CertifiedError PiecewiseCertificate::finish() {
  // Computed once more without a seed: the lower end depends on the triangles that a search met.
  return finish([this](const Point& p, double) { return state_->mesh->distance(p).lower; });
}

CertifiedError PiecewiseCertificate::finish(
    const std::function<double(const Point&, double)>& lower_end) {
  require_no_flush("the certificate");
  if (state_->points == 0) {
    throw Error("no point is left to certify: give a cloud, exclude less");
  }
  CertifiedError result;
  result.points = state_->points;
  result.worst_point = state_->worst.point;
  result.e_max_upper = state_->worst.upper;
  result.e_max_lower = lower_end(state_->worst.at, result.e_max_upper);
  result.e_max_upper_all = result.e_max_upper;
  std::ranges::sort(state_->excluded);
  for (const auto& [index, upper] : state_->excluded) {
    result.excluded.push_back(index);
    result.excluded_distances.push_back(upper);
    result.e_max_upper_all = std::max(result.e_max_upper_all, upper);
  }
  return result;
}

CertifiedError certify(std::span<const Point> cloud, const ExactMesh& mesh,
                       std::span<const std::uint32_t> excluded, std::size_t threads) {
  PiecewiseCertificate certificate(mesh);
  certificate.add(cloud, {}, excluded, threads);
  CertifiedError result = certificate.finish();
  // In the order in which they were given.
  const std::vector<double> ascending = std::move(result.excluded_distances);
  result.excluded_distances.clear();
  for (const std::uint32_t index : excluded) {
    const auto at = std::ranges::lower_bound(result.excluded, index) - result.excluded.begin();
    result.excluded_distances.push_back(ascending[static_cast<std::size_t>(at)]);
  }
  result.excluded.assign(excluded.begin(), excluded.end());
  return result;
}

CertifiedError certify(std::span<const Point> cloud, MeshView mesh,
                       std::span<const std::uint32_t> excluded, std::size_t threads) {
  require_no_flush("the certificate");
  require_finite(cloud, {});
  return certify(cloud, ExactMesh(mesh), excluded, threads);
}

}  // namespace emax
