#pragma once

#include <symsurf/types.h>

#include "spatial/point_tree.h"

namespace symsurf {

/// The line through a point along a unit direction, as the thesis's Algorithms
/// 1 to 3 measure from it; `diagonal` is that of the cloud.
struct Line {
  Vector3 start, direction;
  double diagonal;

  double squared_distance(const Vector3& x) const {
    const Vector3 w = x - start, u = direction;
    const double along = w.x() * u.x() + w.y() * u.y() + w.z() * u.z();
    const Vector3 r = w - along * u;
    return r.x() * r.x() + r.y() * r.y() + r.z() * r.z();
  }

  /// The square of how far a tree has to look for what beats `best` or ties
  /// with it. A projection rounds distances by some 1e-15 diagonals, which this
  /// allows for many times over.
  double reach(const Neighbour& best) const {
    return best.squared_distance * (1 + 1e-12) + 1e-16 * diagonal * diagonal;
  }
};

}  // namespace symsurf
