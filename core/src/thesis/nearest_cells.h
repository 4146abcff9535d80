#pragma once

#include <symsurf/points_view.h>

#include <cstdint>
#include <vector>

namespace symsurf {

/// Distances to the nearest of a few hundred points in a look-up: a grid whose cells list the
/// points that are nearest to some place inside, as far as `reach`.
class NearestCells {
 public:
  NearestCells(PointsView points, double reach);

  /// Squared distance of x from the nearest point; infinite where that may be beyond reach.
  double squared(const Vector3& x) const;

 private:
  PointsView points_;
  Vector3 low_;
  double cell_;
  Eigen::Array3i size_;
  std::vector<std::int32_t> start_, listed_;
};

}  // namespace symsurf
