#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sw_model/base/mesh_view.h"

namespace emax {

// A point of a scan with the unit normal of the surface there, outward.
struct OrientedPoint {
  Eigen::Vector3f position, normal;
  float reach;  // radius within which it has a say
  float band;   // distance from its plane, likewise
  float area;   // of the surface, that it stands for
};

// Nodes of marching cubes: origin + cell * (x, y, z) with 0 <= x, y, z < kNodes.
struct Lattice {
  static constexpr int kNodes = 1 << 20;

  Eigen::Vector3d origin;
  float cell;

  // With room for every node where one of the points has a say. `low`: the least of their
  // coordinates. Throws Error where an axis would need more than kNodes.
  Lattice(const Eigen::Vector3f& low, const Eigen::Vector3f& high, float reach, float side);
};

// The cubes whose lowest corner is a node from `first` to before `last`.
struct CubeRange {
  Eigen::Vector3i first = Eigen::Vector3i::Zero(),
                  last = Eigen::Vector3i::Constant(Lattice::kNodes - 1);
};

// The two edges of the lattice between which a vertex lies where the surface ends; the same one
// twice where it lies on one.
using VertexName = std::array<std::uint64_t, 2>;
// The end of an edge that has the lower coordinates.
Eigen::Vector3i lowest_node(std::uint64_t edge);

struct ImplicitMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  std::vector<VertexName> names;  // of the vertices
};

// The surface where the weighted mean of the signed distances to the points' tangent planes is zero
// (implicit moving least squares: Kolluri 2005; Shen, O'Brien and Shewchuk 2004), averaged with the
// distance to the mean plane, whose error on a curved surface is the opposite one; contoured by
// marching cubes of side `cell`. The weight of a point at x is its area; it falls with its
// distance, and with that of its plane, to 0 at its reach and its band, and with the difference of
// its normal from the mean one there, so that edges stay sharp (after Oeztireli, Guennebaud and
// Gross 2009).
//
// The surface ends where the points do: where the weighted mean of the points around x lies, across
// the mean normal, farther from x than kBorder times their mean reach (at the border of a
// half-plane of points it is 0.235 times that), or where the weights are below kCoverage of those
// inside a plane of points. So there is no surface across a hole that is wider than about a reach.
//
// Manifold and oriented along the normals. Only the part within the cubes: ranges that share a
// face give vertices of the same names and bits there, if each is given, in the same order, all
// points that have a say at its nodes. O(n (reach / cell)^3) time; memory for the nodes of the
// lattice within reach and band of the points, 68 bytes each.
inline constexpr float kBorder = 0.27f, kCoverage = 0.25f;
ImplicitMesh implicit_surface(std::span<const OrientedPoint> points, const Lattice& lattice,
                              const CubeRange& cubes = {});

}  // namespace emax
