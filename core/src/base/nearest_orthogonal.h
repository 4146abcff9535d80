#pragma once

#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <utility>
#include <vector>

namespace symsurf {

/// The orthogonal map Q with the greatest trace(Q' products), a rotation for a parity of 1, with a
/// reflection for -1. Of products sum y x' it takes points x nearest to points y (Umeyama 1991).
Matrix3 nearest_orthogonal(const Matrix3& products, double parity);

/// The motion, or reflection, that takes the first points of pairs nearest to the second ones.
Eigen::Isometry3d nearest_isometry(const std::vector<std::pair<Vector3, Vector3>>& pairs,
                                   double parity);

/// x -> linear (x - from) + onto.
Eigen::Isometry3d map_taking(const Matrix3& linear, const Vector3& from, const Vector3& onto);

}  // namespace symsurf
