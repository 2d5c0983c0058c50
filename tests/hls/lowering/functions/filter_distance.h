// The fixed-point filter's squared distance with a record's fields as arguments.
#pragma once

#include "hls/kernel/forms/guarded_edge.h"

template <class Scalar>
struct FilterRotation {
  emax::Vector3<Scalar> normal, in_plane, along;
};

template <class Scalar>
struct FilterEdge {
  emax::Vector2<Scalar> direction;
  Scalar length;
};

template <class Scalar>
struct FilterRecord {
  emax::Vector3<Scalar> v1;
  FilterRotation<Scalar> rotation;
  Scalar length12;
  FilterEdge<Scalar> edge13, edge23;
  emax::ConditionOf<Scalar> segment;
};

template <class Scalar>
emax::SumOfProducts<Scalar> filter_distance(const emax::Vector3<Scalar>& p,
                                            const FilterRecord<Scalar>& t) {
  const emax::TriangleRecord<Scalar> record = {t.v1,
                                               t.rotation.normal,
                                               t.rotation.in_plane,
                                               t.rotation.along,
                                               t.length12,
                                               {t.edge13.direction, t.edge13.length},
                                               {t.edge23.direction, t.edge23.length},
                                               0};
  return emax::squared_distance_guarded(record, t.segment, p);
}
