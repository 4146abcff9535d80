#pragma once

#include <symsurf/method.h>

namespace symsurf {

/// Checks what every method relies on: at least minimum_points points and no more than can be
/// numbered, all finite, not all on one line; normals, where given, one a point, finite and not
/// zero. Throws InvalidInput.
Cloud checked_cloud(PointsView points, PointsView normals, Index minimum_points,
                    const Context& context);

bool are_finite(PointsView rows);

/// Throws InvalidInput naming the first of the rows that is not finite, as "point 3" where `what`
/// is "point".
/// `first`: the number of the first row.
void require_finite(PointsView rows, const char* what, Index first = 0);

/// Throws InvalidInput for no points, or naming the first that is not finite.
void require_points(PointsView points);

/// Throws InvalidInput for fewer points than needed.
void require_count(Index given, Index needed);

/// Throws InvalidInput unless there are no normals, or one a point, and those of finite points are
/// finite and not zero. `first`: the number of the first row.
void require_normals(PointsView points, PointsView normals, Index first = 0);

/// Whether one process can number so many points.
bool is_numerable(Index own);

/// Throws InvalidInput for more points than one process numbers.
void require_numerable(Index own);

/// Throws InvalidInput where all points are equal, lie on one line, or extend less than 1e-50 or
/// more than 1e50; `total`: how many they stand for.
void require_area(PointsView points, Index total);

}  // namespace symsurf
