#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "hls/kernel/triangle_record.h"
#include "sw_model/model/normalization.h"

namespace emax {

// The form of a mesh that the search reads: records, an AABB-tree with one triangle per leaf, and
// the kd-tree that is built together with it (paper, section 4.1). A node is split at the median of
// its triangles' box centres. The planes of these splits are the kd-tree, so the group of triangles
// that a point falls into is one node of the AABB-tree, where a search may begin. O(n log n) to
// build, 80 bytes a record and 144 for its two nodes.
class TriangleTree {
 public:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t first, last;  // range of records
    std::uint32_t right;        // the left child follows its parent
    std::uint8_t axis;
    double plane;

    bool is_leaf() const { return last - first == 1; }
  };

  // Throws Error for no triangles and as make_records does.
  TriangleTree(MeshView mesh, const Normalization& normalization);

  // In the order of the leaves; a record's tag holds the triangle's index in the mesh.
  std::span<const TriangleRecord<float>> records() const { return records_; }
  std::span<const Node> nodes() const { return nodes_; }
  const Node& root() const { return nodes_.front(); }
  const Node& left(const Node& node) const { return *(&node + 1); }
  const Node& right(const Node& node) const { return nodes_[node.right]; }

  // The hint: the smallest node on the point's path in the kd-tree with at least `triangles`
  // triangles.
  const Node& hint(const Point& p, std::size_t triangles) const;

 private:
  struct Leaf {
    Eigen::AlignedBox3d box;
    Point centre;
    std::uint32_t triangle;
  };
  void build(std::vector<Leaf>& leaves, std::size_t first, std::size_t last);

  std::vector<TriangleRecord<float>> records_;
  std::vector<Node> nodes_;
};

}  // namespace emax
