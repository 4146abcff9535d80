#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <vector>

#include "cloud/point_tree.h"

namespace symsurf {

/// Nearest points of a cloud to many queries.
class NearestPoints {
 public:
  /// The tree is that of the points.
  NearestPoints(PointsView points, const PointTree& tree, const Context& context)
      : points_(points), tree_(tree), context_(context) {}

  /// The nearest point to each query, NaN where none is within `reach`.
  std::vector<Vector3> nearest(const std::vector<Vector3>& queries, double reach) const;

  /// The nearest but one, copies of the nearest left out; of a single position, that one.
  std::vector<Vector3> second_nearest(const std::vector<Vector3>& queries) const;

 private:
  Vector3 second_nearest(const Vector3& query) const;

  PointsView points_;
  const PointTree& tree_;
  const Context context_;
};

}  // namespace symsurf
