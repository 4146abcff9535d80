#pragma once

#include <symsurf/points_view.h>

#include "../box_tree.h"
#include "separation.h"

namespace symsurf {

/// Finds, for points of X1, the point q of X2 whose normal makes the smallest angle with theirs
/// (equal angles: the lowest index): nearest neighbours on the unit sphere.
class ParallelNormals {
 public:
  /// Unit normals, one a point; as_lines: their sign does not count.
  ParallelNormals(PointsView points, PointsView normals, bool as_lines);

  /// Mean squared distance of the partners b from q (3.5), input units squared.
  double projection_error(const Separation& separation) const;

 private:
  PointsView points_, normals_;
  bool as_lines_;
  std::vector<std::int32_t> order_;  // of the normals along the Z-order curve
};

}  // namespace symsurf
