#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>
#include <symsurf/result.h>

#include <vector>

namespace symsurf {

// Of the points of all processes, where several share them out; the calls are then collective.

/// The lowest and the highest point along x, y and z: six, or none of no points.
std::vector<Vector3> extreme_points(PointsView own, const Context& context);

/// Enough points to outline the object: every k-th point, and the extreme ones, so that nothing
/// sticks out.
Points outline(PointsView own, const Context& context);

/// Draws the result's mirrors over the object.
void set_footprint(Result& result, Points outline);

}  // namespace symsurf
