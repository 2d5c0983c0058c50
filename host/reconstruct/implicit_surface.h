#pragma once

#include <Eigen/Core>
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

struct ImplicitMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Triangle> triangles;
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
// Manifold and oriented along the normals. O(n (reach / cell)^3) time; memory for the nodes of the
// grid within reach and band of the points, 52 bytes each.
inline constexpr float kBorder = 0.27f, kCoverage = 0.25f;
ImplicitMesh implicit_surface(std::span<const OrientedPoint> points, float cell);

}  // namespace emax
