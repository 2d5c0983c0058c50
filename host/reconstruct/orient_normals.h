#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace emax {

// Turns unit normals so that neighbours agree: along a minimum spanning tree of the neighbour graph
// with weights 1 - |n_i . n_j| (Hoppe et al. 1992, the paper's [1]). In each connected part the
// tree starts at the extreme point whose normal lies best along its axis, pointing outward. Equal
// weights go to the lower indices, so the result is a function of the input alone. `neighbours`
// holds k indices per point. Returns the connected part of each point, numbered from 0 in the order
// of their first points. O(n k log(n k)).
std::vector<std::uint32_t> orient_normals(std::span<const Eigen::Vector3f> positions,
                                          std::span<const std::uint32_t> neighbours, std::size_t k,
                                          std::span<Eigen::Vector3f> normals);

}  // namespace emax
