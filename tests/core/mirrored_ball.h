#pragma once

#include <cmath>

#include "random_cloud.h"

namespace symsurf {

// A dented ball about the origin, about as wide as 2; mirrored by x = 0.
inline Points ball(RandomCloud& random, Index count) {
  Points points = random.sphere(count);
  for (Index i = 0; i < count; ++i) {
    const Vector3 u = points.row(i);
    points.row(i) *= 1 + 0.3 * std::sin(3 * u.y() + u.z()) + 0.3 * u.x() * u.x() * u.z();
  }
  points.topRows(count / 2) = points.bottomRows(count / 2);
  points.topRows(count / 2).col(0) *= -1;
  return points;
}

}  // namespace symsurf
