#pragma once

#include <symsurf/points_view.h>
#include <symsurf/types.h>

#include <array>

namespace symsurf {

/// A line about which a shape may be turned.
struct SymmetryAxis {
  Vector3 point;      ///< on the axis, input units: the centre of the group
  Vector3 direction;  ///< unit
  Index order = 0;    ///< a turn by 360 degrees / order maps the shape onto itself; 0: any turn

  /// Both ends of the piece to draw: along the points and a tenth of their extent beyond.
  /// Throws InvalidInput without points.
  std::array<Vector3, 2> segment(PointsView points) const;
};

}  // namespace symsurf
