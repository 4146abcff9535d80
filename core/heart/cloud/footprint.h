#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/points.h>

#include <vector>

#include "cloud/cloud.h"

namespace symsurf {

/// Of the bounding box of at least one point, in input units.
inline double diagonal_of(PointsView points) {
  return (points.matrix().colwise().maxCoeff() - points.matrix().colwise().minCoeff()).norm();
}

/// Points far from each other (Gonzalez 1985): the first is the farthest from the centroid, each
/// next one the farthest from those before it. All where there are no more than `count`.
std::vector<Index> farthest_points(PointsView points, Index count, const Context& context);

/// The lowest and the highest point along x, y and z: six, or none of no points.
std::vector<Vector3> extreme_points(PointsView points);

/// What mirrors and axes are drawn over: every k-th point of the cloud, and the extreme ones.
Points footprint_of(const Cloud& cloud);

/// Sets what the result's mirrors are drawn over.
void set_footprint(Result& result, const Cloud& cloud);

/// Sets a footprint that is there already.
void set_footprint(Result& result, Points footprint);

}  // namespace symsurf
