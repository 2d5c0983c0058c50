#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

namespace emax {

// Turns unit normals so that neighbours agree: along a minimum spanning tree of the neighbour graph
// with weights 1 - |n_i . n_j| (Hoppe et al. 1992, the paper's [1]). In each connected part the
// tree starts at the extreme point whose normal lies best along its axis, pointing outward. Equal
// weights go to the lower indices, so the result is a function of the input alone. `neighbours`
// holds k indices per point. O(n k log(n k)).
void orient_normals(std::span<const Eigen::Vector3f> positions,
                    std::span<const std::uint32_t> neighbours, std::size_t k,
                    std::span<Eigen::Vector3f> normals);

}  // namespace emax
