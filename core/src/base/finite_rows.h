#pragma once

#include <symsurf/types.h>

namespace symsurf {

/// The points that are finite: what has no foot on a mirror is not.
inline Points finite_rows(Points points) {
  Index rows = 0;
  for (Index i = 0; i < points.rows(); ++i)
    if (points.row(i).allFinite()) points.row(rows++) = points.row(i).eval();
  points.conservativeResize(rows, 3);
  return points;
}

}  // namespace symsurf
