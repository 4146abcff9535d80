#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <vector>

namespace symsurf {

/// Points far from each other (Gonzalez 1985): the first is the farthest from the centroid, each
/// next one the farthest from those before it. All where there are no more than `count`.
std::vector<Index> farthest_points(PointsView points, Index count, const Context& context);

}  // namespace symsurf
