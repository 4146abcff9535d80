#pragma once

#include <symsurf/method.h>

namespace symsurf {

/// Checks what every method relies on: at least minimum_points points, all finite, not all on one
/// line; normals, where given, one a point, finite and not zero. Throws InvalidInput.
Cloud checked_cloud(PointsView points, PointsView normals, Index minimum_points,
                    const Context& context);

/// Throws InvalidInput naming the first of the rows that is not finite, as "point 3" where `what`
/// is "point".
void require_finite(PointsView rows, const char* what);

}  // namespace symsurf
