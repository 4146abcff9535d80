#pragma once

#include <symsurf/context.h>
#include <symsurf/mirror.h>

namespace symsurf {

/// Where a mirror reflects light of point sources to an eye: ordered by source, then by path
/// length.
struct ReflectionPoints {
  Points positions;                                 ///< m x 3, on the mirror
  Eigen::Matrix<Index, Eigen::Dynamic, 1> sources;  ///< of each the row of its source
  Eigen::VectorXd path_lengths;                     ///< |s - x| + |x - e|, input units
  /// At the eye, across the ray, of a source of unit intensity: per input unit squared. Infinite
  /// where the reflected light has its focus at the eye.
  Eigen::VectorXd irradiance;
};

/// All points x of the mirror at which light is reflected from a source s to the eye e: by Fermat's
/// principle those where the path length |s - x| + |x - e| is stationary on the mirror, s and e on
/// the same side of the tangent plane (Mitchell and Hanrahan 1992). Both sides of the mirror
/// reflect; that another part of it stands in the way is not looked at.
///
/// Planes, spheres and cylinders in closed form (Alhazen's problem: the real roots of a quartic),
/// quadrics by a search in one dimension (after Miguel et al.), other mirrors by Newton's steps
/// from a grid over their footprint, or over the nodes or patches of one made by hand. Where whole
/// curves reflect, as with both ends on a sphere's diameter, points in one plane through the ends
/// stand for them; where whole surfaces do, as with both ends in its centre, there are none. A
/// source or an eye on the mirror is reflected nowhere that it lies itself.
///
/// With the Hessian H of the path length in the tangent plane, d1 and d2 the lengths of its two
/// parts and t the angle of incidence, the irradiance is cos^2 t / (d1^2 d2^2 |det H|), which is
/// 1 / d1^2 times the ratio of the Gaussian curvatures that the reflected wavefront has at the eye
/// and at x (Mitchell and Hanrahan 1992). On a plane it is 1 / (d1 + d2)^2.
///
/// Throws InvalidInput for a source or an eye that is not finite, and for a surface mirror made by
/// hand, which has no footprint; Cancelled.
ReflectionPoints reflection_points(const Mirror& mirror, PointsView sources, const Vector3& eye,
                                   const Context& context = {});

}  // namespace symsurf
