#pragma once

#include <symsurf/points.h>

namespace symsurf {

/// Of the bounding box of at least one point, in input units.
inline double diagonal_of(PointsView points) {
  return (points.matrix().colwise().maxCoeff() - points.matrix().colwise().minCoeff()).norm();
}

}  // namespace symsurf
