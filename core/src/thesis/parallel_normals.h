#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <cstdint>
#include <vector>

#include "separation.h"

namespace symsurf {

/// Finds, for points of X1, the point q of X2 whose normal makes the smallest angle with theirs
/// (equal angles: the lowest index). The few most parallel of the whole cloud are found once; the
/// first of these that lies in X2 is q, and only where none does the normals of X2 are searched.
class ParallelNormals {
 public:
  /// Unit normals, one a point; as_lines: their sign does not count.
  ParallelNormals(PointsView points, PointsView normals, bool as_lines, const Context& context);

  /// Mean squared distance of the partners b from q (3.5), input units squared.
  double projection_error(const Separation& separation) const;

 private:
  PointsView points_, normals_;
  const Context context_;
  bool as_lines_;
  std::vector<std::int32_t> order_;          // of the normals along the Z-order curve
  std::vector<std::int32_t> most_parallel_;  // of each point, in order_; -1: no more
};

}  // namespace symsurf
