#pragma once

#include <symsurf/types.h>

#include <Eigen/Geometry>

namespace symsurf {

/// Two unit vectors orthogonal to a unit direction and to each other, the same for the same bits.
inline Eigen::Matrix<double, 3, 2> orthogonal_to(const Vector3& direction) {
  Index smallest;
  direction.cwiseAbs().minCoeff(&smallest);
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = direction.cross(Vector3::Unit(smallest)).normalized();
  across.col(1) = direction.cross(across.col(0));
  return across;
}

}  // namespace symsurf
