#include "host/block_search/triangle_tree.h"

#include <algorithm>
#include <utility>

#include "sw_model/base/error.h"
#include "sw_model/model/triangle_frame.h"

namespace emax {

TriangleTree::TriangleTree(MeshView mesh, const Normalization& normalization) {
  if (mesh.triangles.empty()) throw Error("the mesh has no triangles to measure a distance to");
  const auto in_file_order = make_records(mesh, normalization);
  std::vector<Leaf> leaves(mesh.triangles.size());
  for (std::uint32_t i = 0; i < leaves.size(); ++i) {
    for (const Point& corner : mesh.corners(i)) {
      leaves[i].box.extend(normalization.apply(corner));
    }
    leaves[i].centre = leaves[i].box.center();
    leaves[i].triangle = i;
  }
  nodes_.reserve(2 * leaves.size() - 1);
  build(leaves, 0, leaves.size());
  records_.reserve(leaves.size());
  for (const Leaf& leaf : leaves) records_.push_back(in_file_order[leaf.triangle]);
}

void TriangleTree::build(std::vector<Leaf>& leaves, std::size_t first, std::size_t last) {
  const std::size_t self = nodes_.size();
  Node& node = nodes_.emplace_back();
  node.first = static_cast<std::uint32_t>(first);
  node.last = static_cast<std::uint32_t>(last);
  Eigen::AlignedBox3d centres;
  for (std::size_t i = first; i < last; ++i) {
    node.box.extend(leaves[i].box);
    centres.extend(leaves[i].centre);
  }
  if (node.is_leaf()) return;
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::size_t middle = first + (last - first) / 2;
  const auto key = [axis](const Leaf& leaf) { return std::pair(leaf.centre[axis], leaf.triangle); };
  std::nth_element(leaves.begin() + static_cast<std::ptrdiff_t>(first),
                   leaves.begin() + static_cast<std::ptrdiff_t>(middle),
                   leaves.begin() + static_cast<std::ptrdiff_t>(last),
                   [&key](const Leaf& a, const Leaf& b) { return key(a) < key(b); });
  node.axis = static_cast<std::uint8_t>(axis);
  node.plane = leaves[middle].centre[axis];
  build(leaves, first, middle);
  nodes_[self].right = static_cast<std::uint32_t>(nodes_.size());
  build(leaves, middle, last);
}

const TriangleTree::Node& TriangleTree::hint(const Point& p, std::size_t triangles) const {
  const Node* node = &root();
  while (!node->is_leaf()) {
    const Node& next = p[node->axis] < node->plane ? left(*node) : right(*node);
    if (next.last - next.first < triangles) break;
    node = &next;
  }
  return *node;
}

}  // namespace emax
