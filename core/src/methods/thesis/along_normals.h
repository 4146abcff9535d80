#pragma once

#include <symsurf/context.h>
#include <symsurf/result.h>

#include "spatial/point_tree.h"

namespace symsurf {

/// Step 2 to 6 of the thesis's Algorithm 3: for each point x the other point nearest to the line
/// through x along its unit normal (equal distances: the lowest index). One pair a point, mutual
/// ones twice; residuals are distances from the lines.
/// The tree is that of the points.
Result pairs_along_normals(PointsView points, const PointTree& tree, PointsView normals,
                           const Context& context);

}  // namespace symsurf
