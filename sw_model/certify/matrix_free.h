#pragma once

#include <Eigen/Core>

namespace emax {

// Squared distance from a point to a triangle straight from the corners, without a frame made
// beforehand. The benchmarks compare the paper's transformation (section 4) with these functions,
// and tests compare distances with them. The certificate takes guesses from them, which it then
// proves. For float and double; O(1).

// Ericson, "Real-Time Collision Detection" (2005), 5.1.5, ClosestPtPointTriangle, as the vector
// from the nearest point of the triangle to p. For a degenerate triangle the result can be NaN.
template <class Scalar>
Eigen::Matrix<Scalar, 3, 1> ericson_offset(const Eigen::Matrix<Scalar, 3, 1>& p,
                                           const Eigen::Matrix<Scalar, 3, 1>& a,
                                           const Eigen::Matrix<Scalar, 3, 1>& b,
                                           const Eigen::Matrix<Scalar, 3, 1>& c);

template <class Scalar>
Scalar ericson_squared_distance(const Eigen::Matrix<Scalar, 3, 1>& p,
                                const Eigen::Matrix<Scalar, 3, 1>& a,
                                const Eigen::Matrix<Scalar, 3, 1>& b,
                                const Eigen::Matrix<Scalar, 3, 1>& c);

// Eberly, "Distance Between Point and Triangle in 3D" (Geometric Tools, 1999): the minimum of
// Q(s, t) = |a + s (b - a) + t (c - a) - p|^2 over seven regions. For a degenerate triangle the
// result can be NaN.
template <class Scalar>
Scalar eberly_squared_distance(const Eigen::Matrix<Scalar, 3, 1>& p,
                               const Eigen::Matrix<Scalar, 3, 1>& a,
                               const Eigen::Matrix<Scalar, 3, 1>& b,
                               const Eigen::Matrix<Scalar, 3, 1>& c);

}  // namespace emax
