#pragma once

#include <symsurf/mirrors.h>

#include <vector>

namespace symsurf::perpendicular {

/// A point carried over the mirror as it was known then, and where it ought to have landed.
struct Carried {
  Vector3 foot;     ///< of the point on the mirror
  Vector3 normal;   ///< of the mirror at the foot
  double distance;  ///< of the point from the foot, signed by the normal
  Vector3 miss;     ///< partner - image
  Vector3 partner_normal;
  double turned = 0;  ///< sine of the angle between the partner's normal and the image's
  double weight = 1;
};

/// How well an image fits its partner, 0 to 1: across the partner's surface, along it (where exact
/// partners differ from mere neighbours), and by the angle between the normals.
double closeness(const Carried& carried, double spacing);

/// How a quadratic patch weighs what it is fitted to.
struct FitWeights {
  double radius;        ///< data farther than this from the centre weigh nothing
  double along = 0.08;  ///< weight of a miss along the partner's surface, against one across it
  double robust_scale;  ///< at the least; a miss above 4.7 of these is an outlier (Tukey 1960)
  int passes = 2;
};

/// The quadratic patch that mends the misses best (Hermite moving least squares: a shift of the
/// mirror by q moves the image by 2 q n + 2 d grad q, so each miss is an equation for height and
/// slope). False where the data do not determine one.
bool fit_patch(const Vector3& centre, const Vector3& normal, const std::vector<Carried>& data,
               const FitWeights& weights, Patch& patch);

/// A frame whose third row is the normal.
Matrix3 frame_of(const Vector3& normal);

/// The foot of x on one patch and the normal there; false where it leaves the patch's reach.
bool patch_foot(const Patch& patch, const Vector3& x, Vector3& foot, Vector3& normal);

}  // namespace symsurf::perpendicular
