#include <symsurf/symmetry_axis.h>

#include <algorithm>
#include <limits>

#include "cloud/cloud.h"

namespace symsurf {

std::array<Vector3, 2> SymmetryAxis::segment(PointsView points) const {
  constexpr double beyond = 0.1;  // of the extent along the axis, at each end
  require_points(points);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (Index i = 0; i < points.size(); ++i) {
    const double along = direction.dot(points[i] - point);
    low = std::min(low, along);
    high = std::max(high, along);
  }
  const double margin = beyond * (high - low);
  return {point + (low - margin) * direction, point + (high + margin) * direction};
}

}  // namespace symsurf
