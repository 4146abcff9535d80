#pragma once

#include <symsurf/sphere.h>
#include <symsurf/surface_mirror.h>

namespace symsurf {

/// Errors of surface points along z in the surface's own frame, in its unit.
struct SurfaceErrors {
  double rmse = 0;   ///< (5.1)
  double e_max = 0;  ///< (5.3)
  double e_avg = 0;  ///< mean absolute error; (5.2) is printed without the absolute value
  double bias = 0;   ///< mean signed error: (5.2) as printed
  Index counted = 0;
  Index skipped = 0;  ///< points where the surface is undefined
};

/// Throws InvalidInput where no point can be counted.
SurfaceErrors surface_errors(PointsView surface_points, const Surface& surface);
SurfaceErrors surface_errors(PointsView surface_points, const SurfaceMirror& surface);

/// Over the diagonal of the object's bounding box.
struct SphereErrors {
  double e_c = 0;  ///< distance of the centres (5.4)
  double e_r = 0;  ///< difference of the radii (5.5)
};

/// Throws InvalidInput for no object or one without extent.
SphereErrors sphere_errors(const Sphere& found, const Sphere& truth, PointsView object);

/// Root mean square of the distances of the surface points from the closest points of the true
/// mirror, over the diagonal of the object's box; needs no frame. Points that have no foot on the
/// mirror are left out. Throws InvalidInput where no point counts.
double surface_distance(PointsView surface_points, const Mirror& truth, PointsView object);

/// Which share of the object's footprint on the true mirror the surface points cover, 0 to 1: of
/// the feet of the object's points, those with a surface point nearer than `tolerance` times the
/// object's diagonal; by default (0) three times the spacing of the feet. Surface points that are
/// not finite cover nothing. Throws InvalidInput for no object or one without feet,
/// InvalidParameter for a tolerance below 0.
double coverage(PointsView surface_points, const Mirror& truth, PointsView object,
                double tolerance = 0);

}  // namespace symsurf
