// Where a ray meets a triangle: T. Möller and B. Trumbore, "Fast, Minimum Storage Ray/Triangle
// Intersection", Journal of Graphics Tools 2(1), 1997, without culling.
#pragma once

#include "hls/kernel/scalar.h"

template <class Scalar>
struct Ray {
  emax::Vector3<Scalar> origin, direction;
};

template <class Scalar>
struct Corners {
  emax::Vector3<Scalar> a, b, c;
};

// The point is origin + t direction = (1 - u - v) a + u b + v c. Where `hit` is false, t, u and v
// are those of the plane, or of no meaning if the ray is parallel to it.
template <class Scalar>
struct Hit {
  Scalar t, u, v;
  emax::ConditionOf<Scalar> hit;
};

template <class Scalar>
Scalar inner_product(const emax::Vector3<Scalar>& a, const emax::Vector3<Scalar>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Scalar>
emax::Vector3<Scalar> cross_product(const emax::Vector3<Scalar>& a,
                                    const emax::Vector3<Scalar>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Scalar>
emax::Vector3<Scalar> vector_between(const emax::Vector3<Scalar>& from,
                                     const emax::Vector3<Scalar>& to) {
  return {to.x - from.x, to.y - from.y, to.z - from.z};
}

template <class Scalar>
Hit<Scalar> ray_triangle(const Ray<Scalar>& ray, const Corners<Scalar>& corners) {
  using emax::both;
  const Scalar zero(0.0f), one(1.0f);
  const emax::Vector3<Scalar> edge_b = vector_between(corners.a, corners.b);
  const emax::Vector3<Scalar> edge_c = vector_between(corners.a, corners.c);
  const emax::Vector3<Scalar> p = cross_product(ray.direction, edge_c);
  const Scalar determinant = inner_product(edge_b, p);
  const Scalar inverse = one / determinant;
  const emax::Vector3<Scalar> to_origin = vector_between(corners.a, ray.origin);
  const Scalar u = inner_product(to_origin, p) * inverse;
  const emax::Vector3<Scalar> q = cross_product(to_origin, edge_b);
  const Scalar v = inner_product(ray.direction, q) * inverse;
  const Scalar t = inner_product(edge_c, q) * inverse;
  const auto inside = both(both(u >= zero, v >= zero), u + v <= one);
  return {t, u, v, both(both(determinant != zero, inside), t >= zero)};
}
