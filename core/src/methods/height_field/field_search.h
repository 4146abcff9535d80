#pragma once

#include <symsurf/parameter.h>

#include "cloud/surface_points.h"

namespace symsurf {

/// A height field mirror while it is searched for, in the principal frame.
struct FieldEstimate {
  Vector3 direction = Vector3::Zero();
  Points nodes;        ///< of the surface; none: nothing was found
  double support = 0;  ///< share of the displaced points that fall on the cloud, 0 to 1
};

/// Finds the direction of mapping and the surface. A direction other than zero is taken as given
/// but for the last degree.
FieldEstimate find_height_field(const SurfacePoints& cloud, const Vector3& given_direction,
                                Values& statistics, const Context& context);

}  // namespace symsurf
