#pragma once

#include <symsurf/method.h>

#include <optional>
#include <vector>

#include "point_grid.h"
#include "point_tree.h"

namespace symsurf {

/// Nearest points of the cloud, whichever process holds them. Collective: all processes ask the
/// same.
class NearestPoints {
 public:
  /// `own`: the tree of this process's points.
  NearestPoints(const Cloud& cloud, const PointTree& own, const Context& context);

  /// The nearest point to each query, NaN where none is within `reach`.
  std::vector<Vector3> nearest(const std::vector<Vector3>& queries, double reach) const;

  /// The nearest but one; of a single point, that one.
  std::vector<Vector3> second_nearest(const std::vector<Vector3>& queries) const;

 private:
  struct Found {
    Vector3 point;
    double squared;
  };

  Found found(const Neighbour& neighbour) const;

  const Cloud& cloud_;
  const PointTree& own_;
  std::optional<PointGrid> grid_;  // of the same points, where it is faster
  const Context context_;
};

}  // namespace symsurf
