// The measurement update of a Kalman filter for position and velocity where the position is
// measured: R. E. Kalman, "A New Approach to Linear Filtering and Prediction Problems", Journal of
// Basic Engineering 82(1), 1960.
#pragma once

#include "hls/kernel/scalar.h"

// A state with its covariance, which is symmetric.
template <class Scalar>
struct State {
  Scalar position, velocity;
  Scalar var_position, covariance, var_velocity;
};

template <class Scalar>
State<Scalar> kalman_update(const State<Scalar>& predicted, const Scalar& measured,
                            const Scalar& variance) {
  const Scalar innovation = measured - predicted.position;
  const Scalar inverse = Scalar(1.0f) / (predicted.var_position + variance);
  const Scalar gain_position = predicted.var_position * inverse;
  const Scalar gain_velocity = predicted.covariance * inverse;
  const Scalar position = predicted.position + gain_position * innovation;
  const Scalar velocity = predicted.velocity + gain_velocity * innovation;
  const Scalar rest = Scalar(1.0f) - gain_position;
  return {position, velocity, rest * predicted.var_position, rest * predicted.covariance,
          predicted.var_velocity - gain_velocity * predicted.covariance};
}
