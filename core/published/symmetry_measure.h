#pragma once

#include <symsurf/points.h>

#include <vector>

#include "cloud/voxel_grid.h"

namespace symsurf {

/// Wendland's function (1 - u)^5 (8 u^2 + 5 u + 1) of a distance in reaches; 0 from 1 on.
double wendland(double u);

/// Distance from which on it is 0: 2.6 / alpha, alpha = 15 / l_avg, l_avg the mean distance of the
/// points from their centroid.
double measure_reach(PointsView points);

/// A grid over a few hundred points: each voxel lists those within reach of some position in it.
class NearbyPoints {
 public:
  NearbyPoints(PointsView points, double reach);

  /// Null where there are none.
  const std::vector<Vector3>* operator()(const Vector3& x) const {
    const Index voxel = grid_.index_at(x);
    return voxel < 0 || lists_[voxel].empty() ? nullptr : &lists_[voxel];
  }

 private:
  VoxelGrid grid_;
  std::vector<std::vector<Vector3>> lists_;  // by voxel
};

/// The symmetry measure of Hruda et al. (2022): s(p) = sum_ij phi(|r(p, x_i) - x_j|), where r(p, x)
/// reflects x over the plane p = (a, b, c, d), (a, b, c) of any length but 0, and phi is Wendland's
/// function.
class SymmetryMeasure {
 public:
  explicit SymmetryMeasure(const Points& points)
      : points_(points), reach_(measure_reach(points)), nearby_(points, reach_) {}

  double operator()(const Eigen::Vector4d& p) const;
  double operator()(const Eigen::Vector4d& p, Eigen::Vector4d& gradient) const;

 private:
  Points points_;
  double reach_;
  NearbyPoints nearby_;
};

}  // namespace symsurf
