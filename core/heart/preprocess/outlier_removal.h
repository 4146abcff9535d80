#pragma once

#include <vector>

#include "preprocess/row_stages.h"

namespace symsurf {

/// Removal of the few points far off the rest, which would set the scale of everything else.
/// What a scanner saw in the air, or pixels without depth that were written as the origin. At least
/// minimum_points stay. Where there are many copies of points, each counts once.
class OutlierRemoval : public RowRemoval {
 public:
  explicit OutlierRemoval(Index minimum_points)
      : RowRemoval("outliers"), minimum_points_(minimum_points) {}

  bool apply(Cloud& cloud, const Context& context) override;

 private:
  std::vector<Index> outliers_of(PointsView points, const Cloud& cloud,
                                 const Context& context) const;

  /// Whether faces between these points are a notable part of the surface: they are no outliers
  /// then.
  static bool hold_surface(const std::vector<Index>& own, const Cloud& cloud);

  Index minimum_points_;
};

}  // namespace symsurf
