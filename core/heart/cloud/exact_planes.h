#pragma once

#include <vector>

#include "cloud/cloud.h"
#include "cloud/nearest_points.h"
#include "cloud/principal_frame.h"
#include "cloud/surfels.h"

namespace symsurf {

/// The planes that map a cloud onto itself to rounding, all of them, in the principal frame.
///
/// Such a plane goes through the centroid and swaps points that lie equally far from it (Wolter,
/// Woo and Volz 1985). Of two points a and b and the few as far out as they are, it is the bisector
/// of a and another, or of b and another, or holds a and b. None where the points that lie as far
/// out are too many to try, as on a sphere.
std::vector<UnitPlane> exact_planes(const Cloud& cloud, const NearestPoints& points,
                                    const Surfels& samples);

/// The same of points in this process, copies counted once, in input units.
std::vector<Plane> exact_planes(PointsView points, const Context& context);

}  // namespace symsurf
