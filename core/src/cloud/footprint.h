#pragma once

#include <symsurf/detect.h>

#include <vector>

#include "cloud/cloud.h"

namespace symsurf {

/// The lowest and the highest point of all processes along x, y and z: six, or none of no points.
/// Collective.
std::vector<Vector3> extreme_points(PointsView own, const Partition& partition);

/// What mirrors and axes are drawn over: every k-th point of the cloud, and the extreme ones.
/// Collective.
Points footprint_of(const Cloud& cloud);

/// Sets what the result's mirrors are drawn over. Collective.
void set_footprint(Result& result, const Cloud& cloud);

/// Sets a footprint that is there already.
void set_footprint(Result& result, Points footprint);

}  // namespace symsurf
