#include "host/reconstruct/implicit_surface.h"

#include <fmt/format.h>
#include <pcl/point_types.h>
#include <pcl/surface/marching_cubes.h>  // its tables

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "sw_model/base/error.h"

namespace emax {
namespace {

using Cell = Eigen::Vector3i;

constexpr int kBlock = 4;        // nodes along a block's side
constexpr float kAway = 0.02f;   // of a cell, the least distance of a node from the surface
constexpr float kApart = 0.05f;  // of a border's value, likewise
constexpr int kPasses = 2;
constexpr float kAlikeNormals = 0.5f;  // difference of unit normals at which a point counts e^-1/2
constexpr float kPlane = 0.6283f;  // weights of a plane of points around one of them, in reach^2

// The corners of a cube and the edges between them, as PCL's tables number them.
constexpr int kCorners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1},
                                {0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};
constexpr int kEdges[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                               {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

// Sums over the points that have a say at a node; lengths in cells.
struct Node {
  float weight = 0, reach = 0, coverage = 0;
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();  // of the node from the points
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  // Of the last pass, with weights that follow the normal of the pass before.
  float robust_weight = 0, distance = 0;
  Eigen::Vector3f robust_normal = Eigen::Vector3f::Zero(), mean = Eigen::Vector3f::Zero();
};

std::uint64_t key_of(const Cell& c) {
  return (static_cast<std::uint64_t>(c.x()) * Lattice::kNodes + static_cast<std::uint64_t>(c.y())) *
             Lattice::kNodes +
         static_cast<std::uint64_t>(c.z());
}

// Nodes of a grid of which few are used.
class SparseGrid {
 public:
  Node& at(const Cell& c) {
    const std::uint64_t key = key_of(c / kBlock);
    if (key != last_key_) {
      last_key_ = key;
      const auto [found, fresh] =
          index_.try_emplace(key, static_cast<std::uint32_t>(index_.size()));
      if (fresh) {
        corners_.push_back(c / kBlock * kBlock);
        nodes_.resize(nodes_.size() + kBlock * kBlock * kBlock);
      }
      last_ = found->second;
    }
    return nodes_[last_ * std::size_t{kBlock * kBlock * kBlock} + within(c)];
  }
  // Its number, nothing where no point has a say.
  std::optional<std::size_t> find(const Cell& c) const {
    const auto block = index_.find(key_of(c / kBlock));
    if (block == index_.end()) return std::nullopt;
    const std::size_t node = block->second * std::size_t{kBlock * kBlock * kBlock} + within(c);
    return nodes_[node].robust_weight > 0 ? std::optional(node) : std::nullopt;
  }
  const Node& node(std::size_t i) const { return nodes_[i]; }
  std::span<Node> nodes() { return nodes_; }
  std::span<const Cell> blocks() const { return corners_; }

 private:
  static std::size_t within(const Cell& c) {
    const int place = (c.x() % kBlock * kBlock + c.y() % kBlock) * kBlock + c.z() % kBlock;
    return static_cast<std::size_t>(place);
  }
  std::unordered_map<std::uint64_t, std::uint32_t> index_;
  std::vector<Cell> corners_;  // of the blocks
  std::vector<Node> nodes_;
  std::uint64_t last_key_ = ~std::uint64_t{0};
  std::uint32_t last_ = 0;
};

class Contour {
 public:
  Contour(std::span<const OrientedPoint> points, const Lattice& lattice, const CubeRange& cubes)
      : lattice_(lattice), cubes_(cubes) {
    for (const OrientedPoint& p : points)
      spread(p, [](Node& node, const OrientedPoint& point, const Influence& i) {
        node.weight += i.weight;
        node.reach += i.weight * i.reach;
        node.coverage += i.weight / (kPlane * point.reach * point.reach);
        node.offset += i.weight * i.offset;
        node.normal += i.weight * point.normal;
      });
    for (Node& node : grid_.nodes()) node.robust_normal = node.normal;
    for (int pass = 0; pass < kPasses; ++pass) {
      for (Node& node : grid_.nodes()) {
        node.mean = node.robust_normal.normalized();
        node.robust_weight = node.distance = 0;
        node.robust_normal.setZero();
      }
      for (const OrientedPoint& p : points)
        spread(p, [](Node& node, const OrientedPoint& point, const Influence& i) {
          const float weight = i.weight * std::exp((point.normal - node.mean).squaredNorm() /
                                                   (-2 * kAlikeNormals * kAlikeNormals));
          node.robust_weight += weight;
          // On a curved surface the one is as much too small as the other is too great.
          node.distance += weight * (i.distance + i.offset.dot(node.mean)) / 2;
          node.robust_normal += weight * point.normal;
        });
    }
  }

  ImplicitMesh run() {
    for (const Cell& block : grid_.blocks()) {
      for (int i = 0; i < kBlock * kBlock * kBlock; ++i) {
        const Cell cube = block + Cell(i / (kBlock * kBlock), i / kBlock % kBlock, i % kBlock);
        if ((cube.array() >= cubes_.first.array()).all() &&
            (cube.array() < cubes_.last.array()).all()) {
          march(cube);
        }
      }
    }
    return clip();
  }

 private:
  struct Corner {
    std::size_t node;
    float value;  // signed distance
  };

  struct Influence {
    float weight, distance, reach;  // distance: signed, from the point's plane
    Eigen::Vector3f offset;
  };

  // Calls add(node, point, influence) for the nodes where the point has a say.
  template <class Add>
  void spread(const OrientedPoint& p, const Add& add) {
    const float cell = lattice_.cell;
    const Eigen::Vector3d exact =
        (p.position.cast<double>() - lattice_.origin) / static_cast<double>(cell);
    const Cell base = exact.array().floor().cast<int>();
    const Eigen::Vector3f at = (exact - base.cast<double>()).cast<float>();  // from the base
    const float reach = p.reach / cell, squared_reach = reach * reach, band = p.band / cell;
    const Cell first =
        (base + Cell((at.array() - reach).ceil().cast<int>())).cwiseMax(cubes_.first);
    const Cell last = (base + Cell((at.array() + reach).floor().cast<int>())).cwiseMin(cubes_.last);
    for (int x = first.x(); x <= last.x(); ++x) {
      for (int y = first.y(); y <= last.y(); ++y) {
        for (int z = first.z(); z <= last.z(); ++z) {
          const Eigen::Vector3f offset = (Cell(x, y, z) - base).cast<float>() - at;
          const float distance = offset.dot(p.normal) / band;
          const float near = 1 - offset.squaredNorm() / squared_reach;
          const float flat = 1 - distance * distance;
          if (near <= 0 || flat <= 0) continue;
          const float weight = p.area * (near * near) * (near * near) * (flat * flat);
          add(grid_.at({x, y, z}), p, {weight, distance * band, reach, offset});
        }
      }
    }
  }

  void march(const Cell& cell) {
    std::array<Corner, 8> corners;
    unsigned below = 0;
    for (unsigned k = 0; k < 8; ++k) {
      const auto found = grid_.find(cell + Cell(kCorners[k][0], kCorners[k][1], kCorners[k][2]));
      if (!found) return;
      const Node& node = grid_.node(*found);
      float value = node.distance / node.robust_weight;
      if (std::abs(value) < kAway) value = value < 0 ? -kAway : kAway;
      corners[k] = {*found, value};
      if (value < 0) below |= 1u << k;
    }
    for (const int* edge = pcl::triTable[below]; *edge >= 0; edge += 3) {
      Triangle t;
      for (std::size_t k = 0; k < 3; ++k) t[k] = vertex(cell, corners, edge[k]);
      mesh_.triangles.push_back(t);
    }
  }

  std::uint32_t vertex(const Cell& cell, const std::array<Corner, 8>& corners, int edge) {
    int a = kEdges[edge][0], b = kEdges[edge][1];
    const auto place = [&](int k) -> Cell {
      return cell + Cell(kCorners[k][0], kCorners[k][1], kCorners[k][2]);
    };
    if ((place(b) - place(a)).sum() < 0) std::swap(a, b);
    const Corner &from = corners[static_cast<std::size_t>(a)],
                 &to = corners[static_cast<std::size_t>(b)];
    const Cell step = place(b) - place(a);
    const std::uint64_t name =
        key_of(place(a)) * 3 + static_cast<std::uint64_t>(step.dot(Cell(0, 1, 2)));
    const auto [found, fresh] =
        at_edge_.try_emplace(name, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (fresh) {
      const float share = from.value / (from.value - to.value);
      mesh_.vertices.push_back(place(a).cast<double>() +
                               static_cast<double>(share) * step.cast<double>());
      mesh_.names.push_back({name, name});
      const Node &m = grid_.node(from.node), &n = grid_.node(to.node);
      const Eigen::Vector3f offset =
          (1 - share) * m.offset / m.weight + share * n.offset / n.weight;
      const Eigen::Vector3f normal =
          ((1 - share) * m.normal / m.weight + share * n.normal / n.weight).normalized();
      const float across = (offset - offset.dot(normal) * normal).norm();
      const float reach = (1 - share) * m.reach / m.weight + share * n.reach / n.weight;
      const float coverage = (1 - share) * m.coverage + share * n.coverage;
      const float value = std::min(1 - across / (kBorder * reach), coverage / kCoverage - 1);
      inside_.push_back(std::abs(value) < kApart ? std::copysign(kApart, value) : value);
    }
    return found->second;
  }

  // What of each triangle is inside the border, in the cloud's coordinates.
  ImplicitMesh clip() {
    ImplicitMesh clipped;
    std::unordered_map<std::uint64_t, std::uint32_t> at_edge;
    std::vector<std::uint32_t> kept(mesh_.vertices.size(), ~0u);
    const auto add = [&](const Eigen::Vector3d& p, const VertexName& name) {
      clipped.vertices.push_back(lattice_.origin + static_cast<double>(lattice_.cell) * p);
      clipped.names.push_back(name);
      return static_cast<std::uint32_t>(clipped.vertices.size() - 1);
    };
    const auto keep = [&](std::uint32_t v) {
      if (kept[v] == ~0u) kept[v] = add(mesh_.vertices[v], mesh_.names[v]);
      return kept[v];
    };
    const auto cross = [&](std::uint32_t a, std::uint32_t b) {
      const auto name = [&](std::uint32_t v) { return mesh_.names[v][0]; };
      if (name(a) > name(b)) std::swap(a, b);
      const auto [found, fresh] = at_edge.try_emplace(std::uint64_t{a} << 32 | b, 0u);
      if (fresh) {
        const double share = static_cast<double>(inside_[a] / (inside_[a] - inside_[b]));
        found->second =
            add((1 - share) * mesh_.vertices[a] + share * mesh_.vertices[b], {name(a), name(b)});
      }
      return found->second;
    };
    for (const Triangle& t : mesh_.triangles) {
      std::vector<std::uint32_t> polygon;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        if (inside_[a] > 0) polygon.push_back(keep(a));
        if ((inside_[a] > 0) != (inside_[b] > 0)) polygon.push_back(cross(a, b));
      }
      for (std::size_t k = 2; k < polygon.size(); ++k) {
        clipped.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
      }
    }
    return clipped;
  }

  const Lattice& lattice_;
  const CubeRange& cubes_;
  SparseGrid grid_;
  ImplicitMesh mesh_;          // in cells from the lattice's origin, not clipped
  std::vector<float> inside_;  // of its vertices: positive inside the border
  std::unordered_map<std::uint64_t, std::uint32_t> at_edge_;
};

}  // namespace

Lattice::Lattice(const Eigen::Vector3f& low, const Eigen::Vector3f& high, float reach, float side)
    : origin((low.array() - (reach + 2 * side)).cast<double>()), cell(side) {
  const float margin = reach + 2 * cell;
  const double nodes = (static_cast<double>((high - low).maxCoeff()) + 2 * margin) / cell + 2;
  if (nodes > kNodes) {
    throw Error(fmt::format(
        "marching cubes would need {:.3g} nodes along an axis, more than {}; take greater cubes",
        nodes, kNodes));
  }
}

Eigen::Vector3i lowest_node(std::uint64_t edge) {
  const std::uint64_t node = edge / 3;
  const auto coordinate = [](std::uint64_t n) { return static_cast<int>(n % Lattice::kNodes); };
  return {coordinate(node / Lattice::kNodes / Lattice::kNodes), coordinate(node / Lattice::kNodes),
          coordinate(node)};
}

ImplicitMesh implicit_surface(std::span<const OrientedPoint> points, const Lattice& lattice,
                              const CubeRange& cubes) {
  return Contour(points, lattice, cubes).run();
}

}  // namespace emax
