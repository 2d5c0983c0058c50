// The kernel's squared distance with a record's fields as arguments: visible-edge form.
#pragma once

#include "hls/kernel/point_triangle.h"

template <class Scalar>
struct Rotation {
  emax::Vector3<Scalar> normal, in_plane, along;
};

template <class Scalar>
struct Edge {
  emax::Vector2<Scalar> direction;
  Scalar length;
};

template <class Scalar>
struct Record {
  emax::Vector3<Scalar> v1;
  Rotation<Scalar> rotation;
  Scalar length12;
  Edge<Scalar> edge13, edge23;
  emax::ConditionOf<Scalar> segment;
};

template <class Scalar>
Scalar fixed_distance(const emax::Vector3<Scalar>& p, const Record<Scalar>& t) {
  const emax::TriangleRecord<Scalar> record = {t.v1,
                                               t.rotation.normal,
                                               t.rotation.in_plane,
                                               t.rotation.along,
                                               t.length12,
                                               {t.edge13.direction, t.edge13.length},
                                               {t.edge23.direction, t.edge23.length},
                                               0};
  return emax::squared_distance(record, t.segment, p);
}
