#include "host/files/pose.h"

#include <Eigen/LU>
#include <limits>

namespace emax {

double Pose::defect() const {
  if (!rotation.allFinite() || !shift.allFinite() || rotation.determinant() <= 0) {
    return std::numeric_limits<double>::infinity();
  }
  const Eigen::Matrix3d product = rotation * rotation.transpose();
  return (product - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

Eigen::Matrix3d rotation_of(const std::array<double, 4>& quaternion) {
  const auto [w, x, y, z] = quaternion;
  Eigen::Matrix3d r;
  r << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),   //
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
  return r;
}

}  // namespace emax
